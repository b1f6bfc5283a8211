//! Output columns: coordinates, angular velocities, points, joint wrenches, drives, multipliers, energies.
//! In: link motion with true accelerations, multipliers, drive forces. Out: channels with expressions.
//! Never knows files. Names and units follow the command line's contract for sampled output.

use linkwear_runtime::{Channel, MODE, NEXT, SAMPLE, Text, VALUE};

use super::deriver::{Deriver, Instant};
use super::joint_forces::JointForces;
use super::names::{number_among, units};
use super::own_states::unit;
use crate::derive::attachment::{NodePose, NodeShape};
use crate::derive::frame::Frame;
use crate::derive::geometry::Geometry;
use crate::derive::joint_markers::joint_links;
use crate::derive::link_mass::LinkMass;
use crate::derive::orientation::{conjugate, link_displacement, quaternion_product};
use crate::derive::responses::Responses;
use crate::expr::{Expr, Scope, Vec3};
use crate::flexible::ModalData;
use crate::id::{BodyId, JointId, PointId};
use crate::model::{Carrier, Coordinate, Flexible};

/// The columns so far, and what they are made from.
pub(super) struct Channels<'a, 'g> {
    /// Multipliers, drive forces, and which rows are kept.
    pub(super) deriver: &'a Deriver<'g>,
    /// Motion with the true accelerations.
    pub(super) instant: &'a Instant<'g>,
    /// Names, units.
    pub channels: Vec<Channel>,
    /// Values.
    pub values: Vec<Expr<'g>>,
}

const XYZ: [&str; 3] = ["x", "y", "z"];

impl<'a, 'g> Channels<'a, 'g> {
    /// Derives all columns; `energy` is kinetic and potential [J].
    pub(super) fn new(
        deriver: &'a Deriver<'g>,
        instant: &'a Instant<'g>,
        masses: &[LinkMass<'g>],
        energy: [Expr<'g>; 2],
    ) -> Self {
        let mut list = Self { deriver, instant, channels: Vec::new(), values: Vec::new() };
        let mechanism = deriver.geometry.mechanism;
        for index in 0..mechanism.joints.len() {
            list.joint_coordinates(JointId::new(index));
        }
        list.bodies();
        for (index, point) in mechanism.points.iter().enumerate() {
            deriver.geometry.g.begin_section(format!("point {}", point.name));
            let id = PointId::new(index);
            let position = instant.state.point(id);
            list.vector(&point.name, "", "m", position);
            let velocity = instant.state.point_velocity(id);
            list.vector(&point.name, "v", "m/s", velocity);
        }
        list.wrenches(masses);
        list.elements();
        for (driver, force) in deriver.drivers.iter().zip(&deriver.drive) {
            let data = mechanism.joint(driver.joint);
            let coordinates = data.model.coordinates();
            let unit = force_unit(coordinates[driver.joint_coordinate] == Coordinate::Angle);
            let suffix = number_among(coordinates.len(), driver.joint_coordinate);
            list.push(format!("{}.drive{suffix}", data.name), unit, *force);
        }
        let parameters = mechanism.parameters.iter().zip(&deriver.geometry.inputs.parameters);
        for (input, value) in parameters.filter(|(parameter, _)| parameter.input) {
            list.push(format!("{}.u", input.name), input.dimension.unit_counting(input.turning), *value);
        }
        list.own_states();
        list.sensors(masses);
        list.multipliers();
        list.push("energy.kinetic".to_owned(), "J", energy[0]);
        list.push("energy.potential".to_owned(), "J", energy[1]);
        list
    }

    pub(super) fn push(&mut self, name: String, unit: impl Into<Text>, value: Expr<'g>) {
        self.channels.push(Channel { name: name.into(), unit: unit.into(), wraps: false });
        self.values.push(value);
    }

    fn vector(&mut self, name: &str, prefix: &str, unit: &'static str, value: Vec3<'g>) {
        for (axis, component) in XYZ.iter().zip(value) {
            self.push(format!("{name}.{prefix}{axis}"), unit, component);
        }
    }

    fn joint_coordinates(&mut self, joint: JointId) {
        let (state, geometry) = (&self.instant.state, self.deriver.geometry);
        let g = geometry.g;
        let data = geometry.mechanism.joint(joint);
        let name = &data.name;
        g.begin_section(format!("coordinates of {name}"));
        let all = state.coordinates(g, joint);
        for coordinate in 0..all.position.len() {
            let suffix = number_among(all.position.len(), coordinate);
            let [unit, per_second, per_second2] = units(data.model.coordinates()[coordinate]);
            self.push(format!("{name}.q{suffix}"), unit, all.position[coordinate]);
            if let Some(position) = self.channels.last_mut() {
                position.wraps = all.wraps[coordinate];
            }
            self.push(format!("{name}.v{suffix}"), per_second, all.speed[coordinate]);
            self.push(format!("{name}.a{suffix}"), per_second2, all.acceleration[coordinate]);
        }
        if data.model.turns_freely() && !data.model.holds_place() {
            let turned = |link| link_displacement(g, geometry.linkage, &state.q, link);
            let [parent, child] = joint_links(&geometry, joint).map(turned);
            let relative = quaternion_product(conjugate(parent), child);
            // Where q1 is a coordinate, Euler parameters have a letter of their own.
            let letter = if all.position.len() > 1 { "e" } else { "q" };
            for (index, component) in relative.into_iter().enumerate() {
                self.push(format!("{name}.{letter}{index}"), "1", component);
            }
        }
        if data.model.is_free() {
            let motion = state.relative_motion(joint);
            let rotation = state.motion.poses.world_of(g, motion.beside()).rotation;
            self.vector(name, "", "m", rotation * motion.distance);
            self.vector(name, "v", "m/s", rotation * motion.slide);
        }
        if data.clearance.is_some() && (data.model.is_ball() || data.model.is_cross()) {
            self.offset_in_socket(joint);
        }
    }

    /// Offset of a ball along axes that go with its socket and are those of W at the reference pose. A run has it along axes that suit the
    /// equations; where these are the same ones the columns of the contact tell it.
    fn offset_in_socket(&mut self, joint: JointId) {
        let (state, geometry) = (&self.instant.state, self.deriver.geometry);
        let (g, linkage) = (geometry.g, geometry.linkage);
        let data = geometry.mechanism.joint(joint);
        let motion = state.relative_motion(joint);
        let axes = match linkage.link_of_joint[joint.index()] {
            None => linkage.frame(motion.parent.link).times(&motion.parent.frame),
            Some(_) => linkage.moved_link(joint, data.model.offsets().start).frame,
        };
        if axes == Frame::IDENTITY && !linkage.reversed[joint.index()] {
            return;
        }
        let offset = state.motion.poses.world_of(g, motion.beside()).rotation * motion.distance;
        for (place, axis) in XYZ.iter().enumerate() {
            let along = state.taken_along(data.parent, g.vector(Frame::IDENTITY.axis(place)));
            self.push(format!("{}.{axis}", data.name), "m", along.dot(offset));
        }
    }

    fn bodies(&mut self) {
        let (geometry, state) = (self.deriver.geometry, &self.instant.state);
        for (index, body) in geometry.mechanism.bodies.iter().enumerate() {
            geometry.g.begin_section(format!("angular velocity of {}", body.name));
            self.vector(&body.name, "w", "rad/s", state.spin(BodyId::new(index)));
            if let Some(flexible) = &body.flexible {
                self.modes(&body.name, flexible, geometry.linkage.link_of_body[index]);
            }
        }
    }

    /// Where every body is: a rotation (row major) and a shift that together take its places at the reference pose to those
    /// now; of a flexible body those of its floating frame.
    pub(super) fn poses(&mut self) {
        let geometry = self.deriver.geometry;
        for (index, body) in geometry.mechanism.bodies.iter().enumerate() {
            geometry.g.begin_section(format!("pose of {}", body.name));
            let at = geometry.linkage.link_of_body[index];
            let (link, pose) = (&geometry.linkage.links[at], self.instant.state.motion.poses.world[at]);
            let rotation = pose.rotation * geometry.g.matrix(link.frame.0).transpose();
            let origin = geometry.described(link.origin, Carrier::Body(link.body));
            let shift = pose.offset - rotation * origin;
            for (number, entry) in rotation.0.into_iter().flatten().enumerate() {
                self.push(format!("{}.pose{number}", body.name), "1", entry);
            }
            for (number, entry) in shift.into_iter().enumerate() {
                self.push(format!("{}.pose{}", body.name, number + 9), "m", entry);
            }
        }
    }

    /// Modal coordinates, displacement and bending stress at the stations, energy of the modes.
    fn modes(&mut self, name: &str, flexible: &Flexible, at: usize) {
        let g = self.deriver.geometry.g;
        g.begin_section(format!("deformation of {name}"));
        let state = &self.instant.state.motion.modes[at];
        for (k, eta) in state.q.iter().enumerate() {
            self.push(format!("{name}{MODE}{}", k + 1), flexible.data.modal_unit(), *eta);
        }
        for station in &flexible.stations {
            let shape = NodeShape::new(&flexible.data.nodes[station.node], false);
            let rest = g.vector(shape.position);
            let place = NodePose::new(g, &shape, &state.q).place;
            let suffix = if station.name.is_empty() { String::new() } else { format!("_{}", station.name) };
            for (axis, component) in XYZ.iter().zip(place - rest) {
                // A linear beam does not move along itself.
                if *axis != "x" || !component.is_zero() {
                    self.push(format!("{name}.u{axis}{suffix}"), "m", component);
                }
            }
            if let Some(stress) = &station.stress {
                for (side, axis) in ["y", "z"].iter().enumerate() {
                    let value = g.weighted(stress.iter().map(|per| per[side]), &state.q);
                    self.push(format!("{name}.stress_{axis}{suffix}"), "Pa", value);
                }
            }
        }
        if !state.q.is_empty() {
            let energy = modal_energy(g, &flexible.data, &state.q, &state.v);
            self.push(format!("{name}.modal_energy"), "J", energy);
        }
    }

    /// Multipliers of the kept rows.
    fn multipliers(&mut self) {
        let (deriver, instant) = (self.deriver, self.instant);
        let mut all = deriver.keep.iter().zip(&deriver.lambda);
        for cut in &instant.cuts {
            let name = &deriver.geometry.mechanism.joint(cut.cut.joint).name;
            let kept = cut.rows.iter().zip(&mut all).filter(|(_, (keep, _))| **keep);
            for (index, (row, (_, multiplier))) in kept.enumerate() {
                self.push(format!("{name}.lambda{}", index + 1), force_unit(row.angular), *multiplier);
            }
        }
    }

    fn wrenches(&mut self, masses: &[LinkMass<'g>]) {
        let (deriver, instant) = (self.deriver, self.instant);
        let mut forces = JointForces::new(deriver, instant);
        for (coupling, by) in forces.couplings() {
            for column in &coupling.columns {
                self.push(format!("{}.{}", coupling.name, column.name), column.unit, by.number(column.value));
            }
            forces.add(coupling, &by);
        }
        let transmitted = forces.transmitted(masses);
        for (index, joint) in deriver.geometry.mechanism.joints.iter().enumerate() {
            let [moment, force] = forces.wrench(JointId::new(index), &transmitted);
            self.vector(&joint.name, "F", "N", force);
            self.vector(&joint.name, "M", "N m", moment);
            if let Some(moment) = forces.drive_moment(JointId::new(index), &transmitted) {
                self.vector(&joint.name, "drive_M", "N m", moment);
            }
        }
    }

    /// Sensors, and what controllers do at their samples, from the accelerations, multipliers and drive forces that are handed in.
    fn sensors(&mut self, masses: &[LinkMass<'g>]) {
        let (deriver, instant) = (self.deriver, self.instant);
        let Geometry { g, mechanism, .. } = deriver.geometry;
        // Where positions alone are asked for, states are none.
        let samplers = if deriver.own.is_empty() { &[][..] } else { &mechanism.samplers };
        if mechanism.sensors.is_empty() && samplers.is_empty() {
            return;
        }
        let responses = Responses::default();
        let sensors = mechanism.sensors.iter().map(|sensor| ("sensor", &sensor.name, &sensor.value));
        // Of states that are held between samples: what they are from the next one on.
        let held = mechanism
            .states
            .iter()
            .take(deriver.own.len())
            .filter_map(|state| Some(("sample of", &state.name, state.next.as_ref()?)));
        let lowered = sensors.chain(held).map(|(what, name, formula)| {
            g.begin_section(format!("{what} {name}"));
            instant.state.lower_asking(g, formula, &responses)
        });
        let lowered: Vec<Expr<'g>> = lowered.collect();
        let asked = responses.asked();
        let values = deriver.responses_by_symbols(masses, &asked, instant);
        let by: Vec<_> = asked.iter().map(|(_, symbol)| *symbol).zip(values).collect();
        let mut values = g.with(&lowered, &by).into_iter();
        for (sensor, value) in mechanism.sensors.iter().zip(&mut values) {
            let unit = sensor.value.dimension.unit_counting(sensor.turning);
            self.push(format!("{}.value", sensor.name), unit, value);
        }
        for (number, sampler) in samplers.iter().enumerate() {
            self.push(format!("{SAMPLE}{}", number + 1), "s", g.number(sampler.sample_time));
            for (state, next) in mechanism.states[sampler.states.clone()].iter().zip(&mut values) {
                self.push(format!("{}{NEXT}", state.name), unit(state.initial.dimension, 0), next);
            }
        }
    }

    /// States of the file's own.
    fn own_states(&mut self) {
        let deriver = self.deriver;
        for (state, own) in deriver.geometry.mechanism.states.iter().zip(&deriver.own) {
            let dimension = state.initial.dimension;
            self.push(format!("{}{VALUE}", state.name), unit(dimension, 0), own.value);
            if state.next.is_none() {
                self.push(format!("{}.rate", state.name), unit(dimension, -1), own.rate);
            }
        }
    }
}

fn force_unit(angular: bool) -> &'static str {
    if angular { "N m" } else { "N" }
}

/// Strain energy and kinetic energy of the deformation relative to the floating frame [J].
fn modal_energy<'g>(g: &'g Scope, data: &ModalData, q: &[Expr<'g>], v: &[Expr<'g>]) -> Expr<'g> {
    let parts = [(&data.stiffness, q), (&data.mass_matrix, v)];
    let terms = parts.into_iter().flat_map(|(matrix, x)| {
        matrix.iter().zip(x).map(move |(row, one)| *one * g.weighted(row.iter().copied(), x))
    });
    0.5 * g.sum(terms)
}
