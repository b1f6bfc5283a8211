//! Coordinates of a joint recomputed from its relative motion, for joints that are no chain of the tree.
//! In: [`RelativeMotion`]. Out: positions, speeds, accelerations, and the wrench per unit of each coordinate's force.

use crate::expr::{Expr, Scope, Vec3};
use crate::model::{Axis, Direction, JointModel, Primitive};

use super::frame::{Frame, cross, dot, scale, sub};
use super::geometry::Geometry;
use super::relative_motion::RelativeMotion;

/// Coordinates of a joint with their first and second derivatives, recomputed from the motion across it.
pub struct JointCoordinates<'g> {
    /// One per freedom (empty for spherical, fixed and free joints).
    pub position: Vec<Expr<'g>>,
    pub speed: Vec<Expr<'g>>,
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
    joint: &JointModel,
    motion: &RelativeMotion<'g>,
) -> JointCoordinates<'g> {
    let z = motion.parent_axis(2);
    let mut list = JointCoordinates {
        position: Vec::new(),
        speed: Vec::new(),
        acceleration: Vec::new(),
        wraps: Vec::new(),
        duals: Vec::new(),
    };
    if let [_, Direction::X] = joint.turns()[..] {
        let axes = UniversalAxes::new(geometry, motion, joint.axes[0], joint.axes[1]);
        universal(g, &mut list, motion, &axes);
        return list;
    }
    for primitive in joint.kind.primitives {
        match primitive {
            Primitive::Turn(_) | Primitive::Thread => turn(g, &mut list, motion, z),
            Primitive::Slide(direction) => {
                slide(g, &mut list, motion, motion.parent_axis(direction.frame_axis()));
            }
            Primitive::Ball | Primitive::Shift | Primitive::Pose => {}
        }
    }
    list
}

/// Angle about an axis z fixed in the parent: q = atan2 from the relative rotation.
fn turn<'g>(g: &'g Scope, list: &mut JointCoordinates<'g>, motion: &RelativeMotion<'g>, z: Vec3<'g>) {
    let rotation = motion.rotation();
    list.position.push(rotation[1][0].atan2(rotation[0][0]));
    list.wraps.push(true);
    list.speed.push(z.dot(motion.omega));
    // d/dt (z . omega) with z turning with the parent.
    list.acceleration.push(z.dot(motion.alpha - motion.parent_omega.cross(motion.omega)));
    list.duals.push((z, g.zero_vector()));
}

/// Distance along a direction u fixed in the parent.
fn slide<'g>(g: &'g Scope, list: &mut JointCoordinates<'g>, motion: &RelativeMotion<'g>, u: Vec3<'g>) {
    list.position.push(u.dot(motion.distance));
    list.wraps.push(false);
    list.speed.push(u.dot(motion.slide));
    let coriolis = 2.0 * motion.parent_omega.cross(motion.slide);
    list.acceleration.push(u.dot(motion.acceleration - coriolis));
    list.duals.push((g.zero_vector(), u));
}

/// Numbers that describe a universal joint: second axis in the child's frame, and the angle between the axes.
struct UniversalAxes {
    second_in_child: [f64; 3],
    /// In the joint axes of the child (e_z on the first axis, e_x towards the second): the second axis.
    second: [f64; 3],
}

impl UniversalAxes {
    fn new(geometry: &Geometry<'_>, motion: &RelativeMotion<'_>, first: Axis, second: Axis) -> Self {
        let frame = geometry.linkage.frame(motion.child.link);
        let joint = Frame::with_z_and_x(first.child, second.child);
        Self { second_in_child: frame.local(second.child), second: joint.local(second.child) }
    }
}

/// `omega = v1 a + v2 b` with a fixed in the parent, b in the child; the dual basis gives each speed.
fn universal<'g>(
    g: &'g Scope,
    list: &mut JointCoordinates<'g>,
    motion: &RelativeMotion<'g>,
    axes: &UniversalAxes,
) {
    let a = motion.parent_axis(2);
    let b = motion.from_child * g.vector(axes.second_in_child);
    let [bx, _, cosine] = axes.second;
    let rotation = motion.rotation();
    // b in the parent's joint axes turns about e_z by q1.
    let seen = rotation * g.vector(axes.second);
    list.position.push(seen[1].atan2(seen[0]));
    // a in the child's joint axes turns about b by -q2; e_y is at right angles to both at q2 = 0.
    let seen = rotation[2];
    let across_b = scale(1.0 / bx, sub([0.0, 0.0, 1.0], scale(cosine, axes.second)));
    let normal = cross(axes.second, across_b);
    debug_assert!((dot(normal, normal) - 1.0).abs() < 1e-9);
    let (along_normal, along) = (g.vector(normal).dot(seen), g.vector(across_b).dot(seen));
    list.position.push((-along_normal).atan2(along));
    list.wraps.extend([true, true]);
    let (scale_factor, cosine) = (g.number(1.0 / (1.0 - cosine * cosine)), g.number(cosine));
    let dual = |own: Vec3<'g>, other: Vec3<'g>| scale_factor * (own - cosine * other);
    let duals = [dual(a, b), dual(b, a)];
    let speeds = duals.map(|dual| dual.dot(motion.omega));
    // alpha = a1 a + v1 omega_p x a + a2 b + v2 omega_c x b
    let (a_dot, b_dot) = (motion.parent_omega.cross(a), motion.child_omega.cross(b));
    let (first, second) = (speeds[0] * a_dot, speeds[1] * b_dot);
    let rate = motion.alpha - (first + second);
    for (dual, speed) in duals.into_iter().zip(speeds) {
        list.speed.push(speed);
        list.acceleration.push(dual.dot(rate));
        list.duals.push((dual, g.zero_vector()));
    }
}
