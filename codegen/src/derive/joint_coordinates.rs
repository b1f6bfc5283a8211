//! Coordinates of a joint recomputed from the motion across it, for joints that are no chain of the tree.
//! In: [`Across`]. Out: positions, speeds, accelerations, and the wrench per unit of each coordinate's force.

use crate::expr::{Expr, Scope, Vec3};
use crate::model::{Axis, Direction, Primitive};

use super::across::{Across, JointAxes, Sides, joint_axes};
use super::frame::{Frame, cross, dot, scale, sub};
use super::geometry::Geometry;

/// Coordinates of a joint with their first and second derivatives, recomputed from the motion across it.
pub struct JointCoordinates<'g> {
    /// `q`, one per freedom (empty for spherical, fixed and free joints).
    pub position: Vec<Expr<'g>>,
    /// `v`.
    pub speed: Vec<Expr<'g>>,
    /// `a`.
    pub acceleration: Vec<Expr<'g>>,
    /// Which positions are angles from atan2.
    pub wraps: Vec<bool>,
    /// Wrench on the child, at its joint point, per unit of each coordinate's force.
    pub duals: Vec<(Vec3<'g>, Vec3<'g>)>,
}

/// Recomputes the coordinates of a joint that is not a chain of the tree.
pub fn joint_coordinates<'g>(
    g: &'g Scope,
    geometry: &Geometry<'g>,
    across: &Across<'g>,
    sides: Sides,
) -> JointCoordinates<'g> {
    let joint = &geometry.mechanism.joint(sides.joint).model;
    let axes = joint_axes(geometry, sides);
    let z = across.parent_axis(g, &axes, 2);
    let mut list = JointCoordinates {
        position: Vec::new(),
        speed: Vec::new(),
        acceleration: Vec::new(),
        wraps: Vec::new(),
        duals: Vec::new(),
    };
    if let [_, Direction::X] = joint.turns()[..] {
        let own = UniversalAxes::new(geometry, sides, joint.axes[0], joint.axes[1]);
        universal(g, &mut list, across, &axes, &own);
        return list;
    }
    for primitive in joint.kind.primitives {
        match primitive {
            Primitive::Turn(_) | Primitive::Thread => turn(g, &mut list, across, &axes, z),
            Primitive::Slide(direction) => {
                let direction = across.parent_axis(g, &axes, direction.frame_axis());
                slide(g, &mut list, across, direction);
            }
            Primitive::Ball | Primitive::Shift | Primitive::Pose => {}
        }
    }
    list
}

/// Angle about an axis fixed in the parent: q = atan2 from the relative rotation.
fn turn<'g>(
    g: &'g Scope,
    list: &mut JointCoordinates<'g>,
    across: &Across<'g>,
    axes: &JointAxes,
    z: Vec3<'g>,
) {
    let rotation = across.rotation(g, axes);
    list.position.push(g.atan2(rotation[1][0], rotation[0][0]));
    list.wraps.push(true);
    list.speed.push(g.dot3(z, across.omega));
    // d/dt (z . omega) with z turning with the parent.
    let turned = g.cross3(across.parent_omega, across.omega);
    let rate = g.sub3(across.alpha, turned);
    list.acceleration.push(g.dot3(z, rate));
    list.duals.push((z, g.zero_vector()));
}

/// Distance along a direction fixed in the parent.
fn slide<'g>(g: &'g Scope, list: &mut JointCoordinates<'g>, across: &Across<'g>, direction: Vec3<'g>) {
    list.position.push(g.dot3(direction, across.distance));
    list.wraps.push(false);
    list.speed.push(g.dot3(direction, across.slide));
    let turned = g.cross3(across.parent_omega, across.slide);
    let two = g.constant(2.0);
    let coriolis = g.scale3(two, turned);
    let rate = g.sub3(across.acceleration, coriolis);
    list.acceleration.push(g.dot3(direction, rate));
    list.duals.push((g.zero_vector(), direction));
}

/// Numbers that describe a universal joint: second axis in the child's frame, and the angle between the axes.
struct UniversalAxes {
    second_in_child: [f64; 3],
    /// In the joint axes of the child (e_z on the first axis, e_x towards the second): the second axis.
    second: [f64; 3],
}

impl UniversalAxes {
    fn new(geometry: &Geometry<'_>, sides: Sides, first: Axis, second: Axis) -> Self {
        let frame = sides.child.map_or(Frame::IDENTITY, |at| geometry.linkage.links[at].frame);
        let joint = Frame::with_z_and_x(first.child, second.child);
        Self { second_in_child: frame.local(second.child), second: joint.local(second.child) }
    }
}

/// `omega = v1 a + v2 b` with a fixed in the parent, b in the child; the dual basis gives each speed.
fn universal<'g>(
    g: &'g Scope,
    list: &mut JointCoordinates<'g>,
    across: &Across<'g>,
    axes: &JointAxes,
    own: &UniversalAxes,
) {
    let a = across.parent_axis(g, axes, 2);
    let b_child = g.vector(own.second_in_child);
    let b = g.mul_vec3(across.from_child, b_child);
    let [bx, _, cosine] = own.second;
    let rotation = across.rotation(g, axes);
    // b in the parent's joint axes turns about e_z by q1.
    let b_joint = g.vector(own.second);
    let seen = g.mul_vec3(rotation, b_joint);
    list.position.push(g.atan2(seen[1], seen[0]));
    // a in the child's joint axes turns about b by -q2; e_y is at right angles to both at q2 = 0.
    let seen = rotation[2];
    let across_b = scale(1.0 / bx, sub([0.0, 0.0, 1.0], scale(cosine, own.second)));
    let normal = cross(own.second, across_b);
    debug_assert!((dot(normal, normal) - 1.0).abs() < 1e-9);
    let (normal, across_b) = (g.vector(normal), g.vector(across_b));
    let (along_normal, along) = (g.dot3(normal, seen), g.dot3(across_b, seen));
    let minus = g.neg(along_normal);
    list.position.push(g.atan2(minus, along));
    list.wraps.extend([true, true]);
    let scale_factor = g.constant(1.0 / (1.0 - cosine * cosine));
    let cos = g.constant(cosine);
    let dual = |g: &'g Scope, own: Vec3<'g>, other: Vec3<'g>| {
        let part = g.scale3(cos, other);
        let rest = g.sub3(own, part);
        g.scale3(scale_factor, rest)
    };
    let duals = [dual(g, a, b), dual(g, b, a)];
    let speeds = duals.map(|dual| g.dot3(dual, across.omega));
    // alpha = a1 a + v1 omega_p x a + a2 b + v2 omega_c x b
    let (turned_a, turned_b) = (g.cross3(across.parent_omega, a), g.cross3(across.child_omega, b));
    let (part_a, part_b) = (g.scale3(speeds[0], turned_a), g.scale3(speeds[1], turned_b));
    let sum = g.add3(part_a, part_b);
    let rate = g.sub3(across.alpha, sum);
    for (dual, speed) in duals.into_iter().zip(speeds) {
        list.speed.push(speed);
        list.acceleration.push(g.dot3(dual, rate));
        list.duals.push((dual, g.zero_vector()));
    }
}
