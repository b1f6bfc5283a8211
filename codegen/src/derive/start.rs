//! Start values of the free coordinates and speeds, as the file gives them.
//! In: [`crate::model::Start`]s. Out: expressions over parameters and t. Never assembles the loops.

use crate::expr::{Expr, Scope, Vec3};
use crate::id::JointId;
use crate::model::{Formula, Mechanism, Start};

use super::geometry::Geometry;
use super::kinematics::{Poses, carried_twist, twists};
use super::linkage::Freedom;
use super::observe::{Quaternion, link_displacement, quaternion_product};

/// Start coordinates and speeds of all, driven ones included, and which of them the file demands.
pub struct StartValues<'g> {
    /// Coordinates.
    pub q: Vec<Expr<'g>>,
    /// Speeds.
    pub v: Vec<Expr<'g>>,
    /// Whether each coordinate is demanded exactly.
    pub held_q: Vec<bool>,
    /// Whether each speed is demanded exactly.
    pub held_v: Vec<bool>,
}

/// Start values; `driven_q` and `driven_v` give driven coordinates and speeds by their index among all.
pub fn start_values<'g>(
    g: &'g Scope,
    geometry: &Geometry<'g>,
    driven: &[(usize, usize, [Expr<'g>; 2])],
) -> StartValues<'g> {
    let linkage = geometry.linkage;
    let zero = g.zero();
    let mut values = StartValues {
        q: vec![zero; linkage.coordinates()],
        v: vec![zero; linkage.speeds()],
        held_q: vec![false; linkage.coordinates()],
        held_v: vec![false; linkage.speeds()],
    };
    for at in 0..linkage.links.len() {
        values.position(g, geometry, at);
    }
    for (coordinate, speed, [position, rate]) in driven {
        values.q[*coordinate] = *position;
        values.v[*speed] = *rate;
    }
    // Orientations of ball links depend on the angles inboard of them, driven ones included.
    for at in 0..linkage.links.len() {
        values.orientation(g, geometry, at);
    }
    for at in 0..linkage.links.len() {
        values.scalar_speed(geometry, at);
    }
    values.absolute_speeds(g, geometry);
    values
}

fn find(mechanism: &Mechanism, joint: JointId, coordinate: usize) -> Option<&Start> {
    mechanism.starts.iter().find(|start| start.joint == joint && start.coordinate == coordinate)
}

fn number<'g>(g: &'g Scope, geometry: &Geometry<'g>, formula: Option<&Formula>) -> Expr<'g> {
    match formula {
        Some(formula) => geometry.inputs.lower(formula),
        None => g.zero(),
    }
}

impl<'g> StartValues<'g> {
    fn position(&mut self, g: &'g Scope, geometry: &Geometry<'g>, at: usize) {
        let link = &geometry.linkage.links[at];
        if let Freedom::Flexible { .. } = link.freedom {
            return self.modes(g, geometry, at);
        }
        if link.freedom.coordinates() != 1 {
            return;
        }
        if let Some(start) = find(geometry.mechanism, link.joint, link.joint_coordinate) {
            self.q[link.first_coordinate] = number(g, geometry, start.position.as_ref());
            self.held_q[link.first_coordinate] = start.held && start.position.is_some();
        }
    }

    /// Modes start undeformed and at rest unless the file says otherwise, and assembly leaves them so.
    fn modes(&mut self, g: &'g Scope, geometry: &Geometry<'g>, at: usize) {
        let link = &geometry.linkage.links[at];
        let Some(flexible) = &geometry.mechanism.body(link.body).flexible else { return };
        for (k, (coordinate, speed)) in link.coordinates().zip(link.speeds()).enumerate() {
            let [position, rate] = flexible.start[k];
            self.q[coordinate] = g.constant(position);
            self.v[speed] = g.constant(rate);
            (self.held_q[coordinate], self.held_v[speed]) = (true, true);
        }
    }

    fn orientation(&mut self, g: &'g Scope, geometry: &Geometry<'g>, at: usize) {
        let link = &geometry.linkage.links[at];
        if !matches!(link.freedom, Freedom::Ball | Freedom::Free) {
            return;
        }
        let starts = [0, 1, 2].map(|i| find(geometry.mechanism, link.joint, link.joint_coordinate + i));
        let vector = Vec3(starts.map(|start| number(g, geometry, start.and_then(|s| s.position.as_ref()))));
        // The file gives the child's rotation relative to the parent; seen from a reversed joint it is undone.
        let vector = if geometry.linkage.reversed[link.joint.index()] { g.neg3(vector) } else { vector };
        let relative = quaternion_of_vector(g, vector);
        let parent = link_displacement(g, geometry.linkage, &self.q, link.parent);
        let frame = link.frame.quaternion().map(|x| g.constant(x));
        let turned = quaternion_product(relative, frame);
        let quaternion = quaternion_product(parent, turned);
        let held = starts.iter().flatten().any(|start| start.held && start.position.is_some());
        for (i, component) in quaternion.into_iter().enumerate() {
            self.q[link.first_coordinate + i] = component;
            self.held_q[link.first_coordinate + i] = held;
        }
        if link.freedom == Freedom::Free {
            let origin = geometry
                .described(geometry.mechanism.joint(link.joint).at, crate::model::Carrier::Body(link.body));
            for (i, origin) in origin.into_iter().enumerate() {
                let start = find(geometry.mechanism, link.joint, link.joint_coordinate + 3 + i);
                let moved = number(g, geometry, start.and_then(|s| s.position.as_ref()));
                self.q[link.first_coordinate + 4 + i] = g.add(origin, moved);
                self.held_q[link.first_coordinate + 4 + i] =
                    start.is_some_and(|s| s.held && s.position.is_some());
            }
        }
    }

    fn scalar_speed(&mut self, geometry: &Geometry<'g>, at: usize) {
        let link = &geometry.linkage.links[at];
        if link.freedom.speeds() != 1 || link.node.is_some() {
            return;
        }
        if let Some(start) = find(geometry.mechanism, link.joint, link.joint_coordinate)
            && let Some(speed) = &start.speed
        {
            self.v[link.first_speed] = geometry.inputs.lower(speed);
            self.held_v[link.first_speed] = start.held;
        }
    }

    /// Speeds of ball and free links are absolute: what the parent carries plus what the file demands.
    fn absolute_speeds(&mut self, g: &'g Scope, geometry: &Geometry<'g>) {
        let linkage = geometry.linkage;
        let mounts: Vec<Vec3<'g>> = (0..linkage.links.len()).map(|at| geometry.mount(g, at)).collect();
        let poses = Poses::new(g, linkage, &mounts, &self.q);
        for (at, link) in linkage.links.iter().enumerate() {
            if !matches!(link.freedom, Freedom::Ball | Freedom::Free) {
                continue;
            }
            let numbers = link.joint_coordinate..link.joint_coordinate + link.freedom.speeds();
            let starts: Vec<Option<&Start>> =
                numbers.map(|number| find(geometry.mechanism, link.joint, number)).collect();
            let wished: Vec<Expr<'g>> = starts
                .iter()
                .map(|start| number(g, geometry, start.and_then(|s| s.speed.as_ref())))
                .collect();
            let sign = linkage.reversed[link.joint.index()];
            let relative = Vec3::first_of(&wished);
            let relative = if sign { g.neg3(relative) } else { relative };
            let all = twists(g, linkage, &poses, &self.v);
            let carried = carried_twist(g, link.parent.map(|p| all[p]), &poses.relative[at]);
            // Wished components are along axes that move with the parent and are parallel to W at the reference pose.
            let parent_frame = link.parent.map_or(super::frame::Frame::IDENTITY, |p| linkage.links[p].frame);
            let in_parent = geometry.turn(g, &parent_frame, relative);
            let own = g.transpose_mul_vec3(poses.relative[at].rotation, in_parent);
            let omega = g.add3(carried.omega, own);
            for i in 0..3 {
                self.v[link.first_speed + i] = omega[i];
                self.held_v[link.first_speed + i] = starts[i].is_some_and(|s| s.held && s.speed.is_some());
            }
            if link.freedom == Freedom::Free {
                let velocity = Vec3::first_of(&wished[3..]);
                let own = g.transpose_mul_vec3(poses.world[at].rotation, velocity);
                for i in 0..3 {
                    self.v[link.first_speed + 3 + i] = own[i];
                    self.held_v[link.first_speed + 3 + i] =
                        starts[3 + i].is_some_and(|s| s.held && s.speed.is_some());
                }
            }
        }
    }
}

/// Quaternion of a rotation vector: angle times axis [rad].
fn quaternion_of_vector<'g>(g: &'g Scope, vector: Vec3<'g>) -> Quaternion<'g> {
    let square = g.dot3(vector, vector);
    if g.is_zero(square) {
        let (one, zero) = (g.one(), g.zero());
        return [one, zero, zero, zero];
    }
    let angle = g.sqrt(square);
    let half = g.constant(0.5);
    let half_angle = g.mul(half, angle);
    let (sine, cosine) = (g.sin(half_angle), g.cos(half_angle));
    let factor = g.div(sine, angle);
    let Vec3([x, y, z]) = g.scale3(factor, vector);
    [cosine, x, y, z]
}
