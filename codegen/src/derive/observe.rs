//! Output columns: coordinates, angular velocities, points, joint wrenches, drives, multipliers, energies.
//! In: link motion with true accelerations, multipliers, drive forces. Out: channels with expressions.
//! Never knows files. Names and units follow the command line's contract for sampled output.

use linkwear_runtime::Channel;

use crate::expr::{Expr, Scope, Vec3};
use crate::flexible::ModalData;
use crate::id::{JointId, PointId};
use crate::model::{Coordinate, Flexible};

use super::attachment::{NodePose, NodeShape};
use super::closure::CutRows;
use super::dynamics::joint_wrenches;
use super::joint_markers::joint_links;
use super::joint_state::JointStates;
use super::link_mass::LinkMass;
use super::linkage::Freedom;
use super::loads::Loads;
use super::orientation::{conjugate, link_displacement, quaternion_product};
use super::wrench::Wrench;

/// All channels with their expressions.
pub struct Channels<'g> {
    /// Descriptions.
    pub channels: Vec<Channel>,
    /// Values.
    pub values: Vec<Expr<'g>>,
}

/// What the columns are made from.
pub struct Observed<'a, 'g> {
    /// Joint and point state.
    pub state: &'a JointStates<'g>,
    /// Mass properties of the links.
    pub masses: &'a [LinkMass<'g>],
    /// Applied loads.
    pub loads: &'a Loads<'g>,
    /// Cuts with all their rows.
    pub cuts: &'a [CutRows<'g>],
    /// Multiplier of every row, zero for dropped ones; flat over all cuts.
    pub multipliers: &'a [Expr<'g>],
    /// Whether each row is kept; flat over all cuts.
    pub keep: &'a [bool],
    /// Drive force of every driver: (joint, coordinate, force).
    pub drives: &'a [(JointId, usize, Expr<'g>)],
    /// Kinetic and potential energy [J].
    pub energy: [Expr<'g>; 2],
}

const XYZ: [&str; 3] = ["x", "y", "z"];

impl<'g> Channels<'g> {
    fn push(&mut self, name: String, unit: &'static str, wraps: bool, value: Expr<'g>) {
        self.channels.push(Channel { name: name.into(), unit: unit.into(), wraps });
        self.values.push(value);
    }

    fn vector(&mut self, name: &str, prefix: &str, unit: &'static str, value: Vec3<'g>) {
        for (axis, component) in XYZ.iter().zip(value) {
            self.push(format!("{name}.{prefix}{axis}"), unit, false, component);
        }
    }
}

/// Derives all columns.
pub fn channels<'g>(g: &'g Scope, observed: &Observed<'_, 'g>) -> Channels<'g> {
    let mut list = Channels { channels: Vec::new(), values: Vec::new() };
    let mechanism = observed.state.geometry.mechanism;
    for index in 0..mechanism.joints.len() {
        joint_coordinates(g, observed, &mut list, JointId::new(index));
    }
    bodies(g, observed, &mut list);
    for (index, point) in mechanism.points.iter().enumerate() {
        g.begin_section(format!("point {}", point.name));
        let id = PointId::new(index);
        let position = observed.state.point(id);
        list.vector(&point.name, "", "m", position);
        let velocity = observed.state.point_velocity(id);
        list.vector(&point.name, "v", "m/s", velocity);
    }
    wrenches(g, observed, &mut list);
    for (joint, coordinate, force) in observed.drives {
        let data = mechanism.joint(*joint);
        let coordinates = data.model.coordinates();
        let unit = if coordinates[*coordinate] == Coordinate::Angle { "N m" } else { "N" };
        let suffix = if coordinates.len() > 1 { (coordinate + 1).to_string() } else { String::new() };
        list.push(format!("{}.drive{suffix}", data.name), unit, false, *force);
    }
    multipliers(observed, &mut list);
    list.push("energy.kinetic".to_owned(), "J", false, observed.energy[0]);
    list.push("energy.potential".to_owned(), "J", false, observed.energy[1]);
    list
}

fn joint_coordinates<'g>(g: &'g Scope, observed: &Observed<'_, 'g>, list: &mut Channels<'g>, joint: JointId) {
    let data = observed.state.geometry.mechanism.joint(joint);
    let name = &data.name;
    g.begin_section(format!("coordinates of {name}"));
    let all = observed.state.coordinates(g, joint);
    for coordinate in 0..all.position.len() {
        let suffix = if all.position.len() > 1 { (coordinate + 1).to_string() } else { String::new() };
        let units = if data.model.coordinates()[coordinate] == Coordinate::Angle {
            ["rad", "rad/s", "rad/s^2"]
        } else {
            ["m", "m/s", "m/s^2"]
        };
        list.push(format!("{name}.q{suffix}"), units[0], all.wraps[coordinate], all.position[coordinate]);
        list.push(format!("{name}.v{suffix}"), units[1], false, all.speed[coordinate]);
        list.push(format!("{name}.a{suffix}"), units[2], false, all.acceleration[coordinate]);
    }
    if data.model.turns_freely() {
        let turned = |link| link_displacement(g, observed.state.geometry.linkage, &observed.state.q, link);
        let [parent, child] = joint_links(&observed.state.geometry, joint).map(turned);
        let relative = quaternion_product(conjugate(parent), child);
        for (index, component) in relative.into_iter().enumerate() {
            list.push(format!("{name}.q{index}"), "1", false, component);
        }
    }
    if data.model.is_free() {
        let motion = observed.state.relative_motion(g, joint);
        let rotation = observed.state.motion.poses.world_of(g, motion.beside()).rotation;
        let place = rotation * motion.distance;
        list.vector(name, "", "m", place);
        let velocity = rotation * motion.slide;
        list.vector(name, "v", "m/s", velocity);
    }
}

fn bodies<'g>(g: &'g Scope, observed: &Observed<'_, 'g>, list: &mut Channels<'g>) {
    let geometry = observed.state.geometry;
    for (index, body) in geometry.mechanism.bodies.iter().enumerate() {
        g.begin_section(format!("angular velocity of {}", body.name));
        let at = geometry.linkage.link_of_body[index];
        let rotation = observed.state.motion.poses.world[at].rotation;
        let omega = rotation * observed.state.motion.twists[at].omega;
        list.vector(&body.name, "w", "rad/s", omega);
        if let Some(flexible) = &body.flexible {
            modes(g, observed, list, &body.name, flexible, at);
        }
    }
}

/// Modal coordinates, displacement and bending stress at the stations, energy of the modes.
fn modes<'g>(
    g: &'g Scope,
    observed: &Observed<'_, 'g>,
    list: &mut Channels<'g>,
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
        let moved = place - rest;
        let suffix = if station.name.is_empty() { String::new() } else { format!("_{}", station.name) };
        for (axis, component) in XYZ.iter().zip(moved) {
            // A linear beam does not move along itself.
            if *axis != "x" || !component.is_zero() {
                list.push(format!("{name}.u{axis}{suffix}"), "m", false, component);
            }
        }
        if let Some(stress) = &station.stress {
            for (side, axis) in ["y", "z"].iter().enumerate() {
                let value = g.weighted(stress.iter().map(|per| per[side]), &state.q);
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
fn modal_energy<'g>(g: &'g Scope, data: &ModalData, q: &[Expr<'g>], v: &[Expr<'g>]) -> Expr<'g> {
    let parts = [(&data.stiffness, q), (&data.mass_matrix, v)];
    let terms = parts.into_iter().flat_map(|(matrix, x)| {
        matrix.iter().zip(x).map(move |(row, one)| *one * g.weighted(row.iter().copied(), x))
    });
    0.5 * g.sum(terms)
}

fn multipliers<'g>(observed: &Observed<'_, 'g>, list: &mut Channels<'g>) {
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

/// Sum of a cut's constraint wrenches on the child at its joint point, in the common frame: moment, force.
fn constraint_wrench<'g>(g: &'g Scope, cut: &CutRows<'g>, multipliers: &[Expr<'g>]) -> [Vec3<'g>; 2] {
    let mut sum = [g.zero_vector(), g.zero_vector()];
    for (row, multiplier) in cut.rows.iter().zip(multipliers) {
        let parts = [row.moment, row.force].map(|part| *multiplier * part);
        sum = [sum[0] + parts[0], sum[1] + parts[1]];
    }
    sum
}

fn wrenches<'g>(g: &'g Scope, observed: &Observed<'_, 'g>, list: &mut Channels<'g>) {
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
        let [parent, child] = cut.motion.link_wrenches(moment, force);
        for (link, wrench) in [(cut.motion.child.link, child), (cut.motion.parent.link, parent)] {
            if let Some(at) = link {
                external[at] += wrench;
            }
        }
    }
    g.begin_section("joint wrenches, from the leaves of the tree to its root");
    let transmitted = joint_wrenches(g, linkage, &state.motion, observed.masses, &external);
    for (index, joint) in state.geometry.mechanism.joints.iter().enumerate() {
        let id = JointId::new(index);
        g.begin_section(format!("wrench at {}", joint.name));
        let [moment, force] = match linkage.link_of_joint[index] {
            Some(at) => tree_wrench(observed, id, at, transmitted[at]),
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
fn tree_wrench<'g>(
    observed: &Observed<'_, 'g>,
    joint: JointId,
    at: usize,
    total: Wrench<'g>,
) -> [Vec3<'g>; 2] {
    let state = observed.state;
    let linkage = state.geometry.linkage;
    let pose = state.motion.poses.world[at];
    let mut moment = pose.rotation * total.moment;
    let mut force = pose.rotation * total.force;
    let reversed = linkage.reversed[joint.index()];
    let data = state.geometry.mechanism.joint(joint);
    if reversed && data.model.slides() {
        // The joint's child is inboard: all is about its own joint point, and there the drive acts too.
        let link = linkage.link_at(data.child, data.at, true);
        let place = state.motion.poses.position(link, state.geometry.local(link, data.at));
        moment += (pose.offset - place).cross(force);
    }
    for (driven, coordinate, drive) in observed.drives.iter().filter(|(driven, ..)| *driven == joint) {
        let Some(link) = linkage.link_of_coordinate(*driven, *coordinate) else { continue };
        let rotation = state.motion.poses.world[link].rotation;
        let along = |axis: [f64; 3]| *drive * (rotation * state.geometry.g.vector(axis));
        match linkage.links[link].freedom {
            Freedom::Translation { axis } => force -= along(axis),
            _ => moment -= along([0.0, 0.0, 1.0]),
        }
    }
    // The child of a reversed joint feels the opposite.
    if reversed { [-moment, -force] } else { [moment, force] }
}

fn cut_wrench<'g>(
    g: &'g Scope,
    observed: &Observed<'_, 'g>,
    cut: &CutRows<'g>,
    constraint: [Vec3<'g>; 2],
) -> [Vec3<'g>; 2] {
    let [mut moment, mut force] = constraint;
    for (joint, own_moment, own_force) in &observed.loads.in_cuts {
        if *joint == cut.cut.joint {
            moment += *own_moment;
            force += *own_force;
        }
    }
    let rotation = observed.state.motion.poses.world_of(g, cut.motion.beside()).rotation;
    [moment, force].map(|part| rotation * part)
}
