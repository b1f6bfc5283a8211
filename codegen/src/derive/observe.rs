//! Output columns: coordinates, angular velocities, points, joint wrenches, drives, multipliers, energies.
//! In: link motion with true accelerations, multipliers, drive forces. Out: channels with expressions.
//! Never knows files. Names and units follow the command line's contract for sampled output.

use linkwear_runtime::Channel;

use crate::expr::{ExprId, Scope, Vec3};
use crate::flexible::ModalData;
use crate::id::{JointId, PointId};
use crate::model::{Flexible, JointKind};

use super::closure::CutRows;
use super::dynamics::joint_wrenches;
use super::forces::Loads;
use super::inertia::LinkMass;
use super::joint_state::{JointStates, is_angle};
use super::linkage::{Freedom, Linkage};
use super::node::{NodePose, NodeShape};
use super::wrench::Wrench;

/// All channels with their expressions.
pub struct Channels {
    /// Descriptions.
    pub channels: Vec<Channel>,
    /// Values.
    pub values: Vec<ExprId>,
}

/// What the columns are made from.
pub struct Observed<'a> {
    /// Joint and point state.
    pub state: &'a JointStates<'a>,
    /// Mass properties of the links.
    pub masses: &'a [LinkMass],
    /// Applied loads.
    pub loads: &'a Loads,
    /// Cuts with all their rows.
    pub cuts: &'a [CutRows],
    /// Multiplier of every row, zero for dropped ones; flat over all cuts.
    pub multipliers: &'a [ExprId],
    /// Whether each row is kept; flat over all cuts.
    pub keep: &'a [bool],
    /// Drive force of every driver: (joint, coordinate, force).
    pub drives: &'a [(JointId, usize, ExprId)],
    /// Kinetic and potential energy [J].
    pub energy: [ExprId; 2],
}

const XYZ: [&str; 3] = ["x", "y", "z"];

impl Channels {
    fn push(&mut self, name: String, unit: &'static str, wraps: bool, value: ExprId) {
        self.channels.push(Channel { name: name.into(), unit: unit.into(), wraps });
        self.values.push(value);
    }

    fn vector(&mut self, name: &str, prefix: &str, unit: &'static str, value: Vec3) {
        for (axis, component) in XYZ.iter().zip(value) {
            self.push(format!("{name}.{prefix}{axis}"), unit, false, component);
        }
    }
}

/// Derives all columns.
pub fn channels(g: &Scope, observed: &Observed<'_>) -> Channels {
    let mut list = Channels { channels: Vec::new(), values: Vec::new() };
    let mechanism = observed.state.geometry.mechanism;
    for index in 0..mechanism.joints.len() {
        joint_coordinates(g, observed, &mut list, JointId::new(index));
    }
    bodies(g, observed, &mut list);
    for (index, point) in mechanism.points.iter().enumerate() {
        g.begin_section(format!("point {}", point.name));
        let id = PointId::new(index);
        let position = observed.state.point(g, id);
        list.vector(&point.name, "", "m", position);
        let velocity = observed.state.point_velocity(g, id);
        list.vector(&point.name, "v", "m/s", velocity);
    }
    wrenches(g, observed, &mut list);
    for (joint, coordinate, force) in observed.drives {
        let data = mechanism.joint(*joint);
        let unit = if is_angle(&data.kind, *coordinate) { "N m" } else { "N" };
        let several = super::joint_state::coordinate_count(&data.kind) > 1;
        let suffix = if several { (coordinate + 1).to_string() } else { String::new() };
        list.push(format!("{}.drive{suffix}", data.name), unit, false, *force);
    }
    multipliers(observed, &mut list);
    list.push("energy.kinetic".to_owned(), "J", false, observed.energy[0]);
    list.push("energy.potential".to_owned(), "J", false, observed.energy[1]);
    list
}

fn joint_coordinates(g: &Scope, observed: &Observed<'_>, list: &mut Channels, joint: JointId) {
    let data = observed.state.geometry.mechanism.joint(joint);
    let name = &data.name;
    g.begin_section(format!("coordinates of {name}"));
    let all = observed.state.coordinates(g, joint);
    for coordinate in 0..all.position.len() {
        let suffix = if all.position.len() > 1 { (coordinate + 1).to_string() } else { String::new() };
        let units = if is_angle(&data.kind, coordinate) {
            ["rad", "rad/s", "rad/s^2"]
        } else {
            ["m", "m/s", "m/s^2"]
        };
        list.push(format!("{name}.q{suffix}"), units[0], all.wraps[coordinate], all.position[coordinate]);
        list.push(format!("{name}.v{suffix}"), units[1], false, all.speed[coordinate]);
        list.push(format!("{name}.a{suffix}"), units[2], false, all.acceleration[coordinate]);
    }
    if matches!(data.kind, JointKind::Spherical | JointKind::Socket | JointKind::Free) {
        let sides = super::across::sides_of(observed.state.geometry, joint);
        let parent = displacement(g, observed, sides.parent);
        let child = displacement(g, observed, sides.child);
        let inverse = conjugate(g, parent);
        let relative = quaternion_product(g, inverse, child);
        for (index, component) in relative.into_iter().enumerate() {
            list.push(format!("{name}.q{index}"), "1", false, component);
        }
    }
    if data.kind == JointKind::Free {
        let across = observed.state.across(g, joint);
        let sides = super::across::sides_of(observed.state.geometry, joint);
        let rotation = observed.state.motion.poses.world_of(g, sides.beside()).rotation;
        let place = g.mul_vec3(rotation, across.distance);
        list.vector(name, "", "m", place);
        let velocity = g.mul_vec3(rotation, across.slide);
        list.vector(name, "v", "m/s", velocity);
    }
}

fn bodies(g: &Scope, observed: &Observed<'_>, list: &mut Channels) {
    let geometry = observed.state.geometry;
    for (index, body) in geometry.mechanism.bodies.iter().enumerate() {
        g.begin_section(format!("angular velocity of {}", body.name));
        let at = geometry.linkage.link_of_body[index];
        let rotation = observed.state.motion.poses.world[at].rotation;
        let omega = g.mul_vec3(rotation, observed.state.motion.twists[at].omega);
        list.vector(&body.name, "w", "rad/s", omega);
        if let Some(flexible) = &body.flexible {
            modes(g, observed, list, &body.name, flexible, at);
        }
    }
}

/// Modal coordinates, displacement and bending stress at the stations, energy of the modes.
fn modes(
    g: &Scope,
    observed: &Observed<'_>,
    list: &mut Channels,
    name: &str,
    flexible: &Flexible,
    at: usize,
) {
    g.begin_section(format!("deformation of {name}"));
    let state = &observed.state.motion.modes[at];
    for (k, eta) in state.q.iter().enumerate() {
        list.push(format!("{name}.eta{}", k + 1), flexible.data.modal_unit(), false, *eta);
    }
    for station in &flexible.stations {
        let shape = NodeShape::new(&flexible.data.nodes[station.node], false);
        let rest = g.vector(shape.position);
        let place = NodePose::new(g, &shape, &state.q).place;
        let moved = g.sub3(place, rest);
        let suffix = if station.name.is_empty() { String::new() } else { format!("_{}", station.name) };
        for (axis, component) in XYZ.iter().zip(moved) {
            // A linear beam does not move along itself.
            if *axis != "x" || !g.is_zero(component) {
                list.push(format!("{name}.u{axis}{suffix}"), "m", false, component);
            }
        }
        if let Some(stress) = &station.stress {
            for (side, axis) in ["y", "z"].iter().enumerate() {
                let terms: Vec<(ExprId, ExprId)> =
                    stress.iter().zip(&state.q).map(|(per, eta)| (g.constant(per[side]), *eta)).collect();
                let value = g.dot(&terms);
                list.push(format!("{name}.stress_{axis}{suffix}"), "Pa", false, value);
            }
        }
    }
    if !state.q.is_empty() {
        let energy = modal_energy(g, &flexible.data, &state.q, &state.v);
        list.push(format!("{name}.modal_energy"), "J", false, energy);
    }
}

/// Strain energy and kinetic energy of the deformation relative to the floating frame [J].
fn modal_energy(g: &Scope, data: &ModalData, q: &[ExprId], v: &[ExprId]) -> ExprId {
    let mut sum = g.zero();
    for (matrix, x) in [(&data.stiffness, q), (&data.mass_matrix, v)] {
        for (row, own) in matrix.iter().zip(x) {
            let terms: Vec<(ExprId, ExprId)> =
                row.iter().zip(x).map(|(entry, other)| (g.constant(*entry), *other)).collect();
            let part = g.dot(&terms);
            let part = g.mul(*own, part);
            sum = g.add(sum, part);
        }
    }
    let half = g.constant(0.5);
    g.mul(half, sum)
}

fn multipliers(observed: &Observed<'_>, list: &mut Channels) {
    let mut index = 0;
    for cut in observed.cuts {
        let name = &observed.state.geometry.mechanism.joint(cut.cut.joint).name;
        let mut number = 0;
        for row in &cut.rows {
            if observed.keep[index] {
                number += 1;
                let unit = if row.angular { "N m" } else { "N" };
                list.push(format!("{name}.lambda{number}"), unit, false, observed.multipliers[index]);
            }
            index += 1;
        }
    }
}

/// Sum of a cut's constraint wrenches on the child at its joint point, in the common frame.
fn constraint_wrench(g: &Scope, cut: &CutRows, multipliers: &[ExprId]) -> [Vec3; 2] {
    let mut sum = [g.zero_vector(), g.zero_vector()];
    for (row, multiplier) in cut.rows.iter().zip(multipliers) {
        let parts = [row.moment, row.force].map(|part| g.scale3(*multiplier, part));
        sum = [g.add3(sum[0], parts[0]), g.add3(sum[1], parts[1])];
    }
    sum
}

fn wrenches(g: &Scope, observed: &Observed<'_>, list: &mut Channels) {
    let state = observed.state;
    let linkage = state.geometry.linkage;
    g.begin_section("constraint forces of the loops");
    let mut external = observed.loads.external.clone();
    let mut first = 0;
    let mut at_cuts = Vec::new();
    for cut in observed.cuts {
        let own = &observed.multipliers[first..first + cut.rows.len()];
        first += cut.rows.len();
        let [moment, force] = constraint_wrench(g, cut, own);
        at_cuts.push([moment, force]);
        let [child, parent] = cut.link_wrenches(g, moment, force);
        for (link, wrench) in [(cut.sides.child, child), (cut.sides.parent, parent)] {
            if let Some(at) = link {
                external[at] = external[at].plus(g, wrench);
            }
        }
    }
    g.begin_section("joint wrenches, from the leaves of the tree to its root");
    let transmitted = joint_wrenches(g, linkage, state.motion, observed.masses, &external);
    for (index, joint) in state.geometry.mechanism.joints.iter().enumerate() {
        let id = JointId::new(index);
        g.begin_section(format!("wrench at {}", joint.name));
        let [moment, force] = match linkage.link_of_joint[index] {
            Some(at) => tree_wrench(g, observed, id, at, transmitted[at]),
            None => {
                let position = observed.cuts.iter().position(|cut| cut.cut.joint == id);
                let position = position.expect("a joint is in the tree or a cut");
                cut_wrench(g, observed, &observed.cuts[position], at_cuts[position])
            }
        };
        list.vector(&joint.name, "F", "N", force);
        list.vector(&joint.name, "M", "N m", moment);
    }
}

/// Wrench by parent on child in W at the child's joint point, without the drives.
fn tree_wrench(g: &Scope, observed: &Observed<'_>, joint: JointId, at: usize, total: Wrench) -> [Vec3; 2] {
    let state = observed.state;
    let linkage = state.geometry.linkage;
    let pose = state.motion.poses.world[at];
    let mut moment = g.mul_vec3(pose.rotation, total.moment);
    let mut force = g.mul_vec3(pose.rotation, total.force);
    let reversed = linkage.reversed[joint.index()];
    let data = state.geometry.mechanism.joint(joint);
    if reversed && slides(&data.kind) {
        // The joint's child is inboard: all is about its own joint point, and there the drive acts too.
        let link = linkage.link_at(data.child, data.at, true);
        let local = state.geometry.local(g, link, data.at);
        let place = state.motion.poses.position(g, link, local);
        let arm = g.sub3(pose.offset, place);
        let lever = g.cross3(arm, force);
        moment = g.add3(moment, lever);
    }
    for (driven, coordinate, drive) in observed.drives.iter().filter(|(driven, ..)| *driven == joint) {
        let Some(link) = linkage.link_of_coordinate(*driven, *coordinate) else { continue };
        let rotation = state.motion.poses.world[link].rotation;
        let (axis, is_force) = match linkage.links[link].freedom {
            Freedom::Translation { axis } => (axis, true),
            _ => ([0.0, 0.0, 1.0], false),
        };
        let axis = g.vector(axis);
        let axis = g.mul_vec3(rotation, axis);
        let own = g.scale3(*drive, axis);
        if is_force {
            force = g.sub3(force, own);
        } else {
            moment = g.sub3(moment, own);
        }
    }
    // The child of a reversed joint feels the opposite.
    if reversed { [g.neg3(moment), g.neg3(force)] } else { [moment, force] }
}

fn slides(kind: &JointKind) -> bool {
    matches!(
        kind,
        JointKind::Prismatic(_)
            | JointKind::Cylindrical(_)
            | JointKind::Screw(..)
            | JointKind::Planar { .. }
            | JointKind::Journal { .. }
            | JointKind::Socket
    )
}

fn cut_wrench(g: &Scope, observed: &Observed<'_>, cut: &CutRows, constraint: [Vec3; 2]) -> [Vec3; 2] {
    let [mut moment, mut force] = constraint;
    for (joint, own_moment, own_force) in &observed.loads.in_cuts {
        if *joint == cut.cut.joint {
            moment = g.add3(moment, *own_moment);
            force = g.add3(force, *own_force);
        }
    }
    let rotation = observed.state.motion.poses.world_of(g, cut.sides.beside()).rotation;
    [moment, force].map(|part| g.mul_vec3(rotation, part))
}

/// A unit quaternion, scalar first.
pub type Quaternion = [ExprId; 4];

/// Product of quaternions: first `b`, then `a`.
pub fn quaternion_product(g: &Scope, a: Quaternion, b: Quaternion) -> Quaternion {
    let minus = |g: &Scope, x: ExprId| g.neg(x);
    let m = [minus(g, a[1]), minus(g, a[2]), minus(g, a[3])];
    [
        g.dot(&[(a[0], b[0]), (m[0], b[1]), (m[1], b[2]), (m[2], b[3])]),
        g.dot(&[(a[0], b[1]), (a[1], b[0]), (a[2], b[3]), (m[2], b[2])]),
        g.dot(&[(a[0], b[2]), (m[0], b[3]), (a[2], b[0]), (a[3], b[1])]),
        g.dot(&[(a[0], b[3]), (a[1], b[2]), (m[1], b[1]), (a[3], b[0])]),
    ]
}

/// Inverse of a unit quaternion.
pub fn conjugate(g: &Scope, a: Quaternion) -> Quaternion {
    [a[0], g.neg(a[1]), g.neg(a[2]), g.neg(a[3])]
}

/// Rotation of a link's body from its reference pose, as a quaternion in W.
fn displacement(g: &Scope, observed: &Observed<'_>, link: Option<usize>) -> Quaternion {
    let linkage = observed.state.geometry.linkage;
    link_displacement(g, linkage, observed.state.q, link)
}

/// Rotation of a link's body from its reference pose for given coordinates.
pub fn link_displacement(g: &Scope, linkage: &Linkage, q: &[ExprId], link: Option<usize>) -> Quaternion {
    let Some(at) = link else {
        let (one, zero) = (g.one(), g.zero());
        return [one, zero, zero, zero];
    };
    let orientation = orientation(g, linkage, q, link);
    let frame = linkage.links[at].frame.quaternion().map(|x| g.constant(x));
    let inverse = conjugate(g, frame);
    quaternion_product(g, orientation, inverse)
}

/// Orientation of a link's frame in W as a quaternion.
fn orientation(g: &Scope, linkage: &Linkage, q: &[ExprId], link: Option<usize>) -> Quaternion {
    let Some(at) = link else {
        let (one, zero) = (g.one(), g.zero());
        return [one, zero, zero, zero];
    };
    let own = &linkage.links[at];
    let first = own.first_coordinate;
    if matches!(own.freedom, Freedom::Ball | Freedom::Free) {
        return [q[first], q[first + 1], q[first + 2], q[first + 3]];
    }
    let outer = orientation(g, linkage, q, own.parent);
    let mount = own.mount.quaternion().map(|x| g.constant(x));
    let mounted = quaternion_product(g, outer, mount);
    if let Some(shape) = &own.node {
        let section = NodePose::new(g, shape, &q[own.coordinates()]).quaternion(g);
        return match own.freedom {
            Freedom::Node => quaternion_product(g, mounted, section),
            _ => {
                let back = conjugate(g, section);
                quaternion_product(g, mounted, back)
            }
        };
    }
    let Freedom::Rotation { offset, .. } = own.freedom else { return mounted };
    let (half, offset) = (g.constant(0.5), g.constant(offset));
    let angle = g.add(q[first], offset);
    let angle = g.mul(half, angle);
    let (sine, cosine, zero) = (g.sin(angle), g.cos(angle), g.zero());
    quaternion_product(g, mounted, [cosine, zero, zero, sine])
}
