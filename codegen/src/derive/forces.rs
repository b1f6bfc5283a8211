//! Applied forces: joint damping, springs and actuators, force elements; their energy and power.
//! In: link motion. Out: [`Loads`]. Never knows constraints. Gravity enters with the accelerations.

use crate::expr::{Expr, Scope, Vec3};
use crate::id::{JointId, PointId};
use crate::model::{Carrier, ForceKind, Passive};

use super::contacts::{ContactWrench, contact_forces};
use super::joint_state::JointStates;
use super::linkage::{Freedom, LinkIndex};
use super::loads::Loads;
use super::wrench::Wrench;

/// Collects all loads.
pub fn loads<'g>(g: &'g Scope, state: &JointStates<'g>, contacts: &[ContactWrench<'g>]) -> Loads<'g> {
    let linkage = state.geometry.linkage;
    let mut loads = Loads::none(g, linkage);
    for at in 0..linkage.links.len() {
        loads.elasticity(g, state, at);
    }
    for contact in contacts {
        g.begin_section(format!("contact in {}", state.geometry.mechanism.joint(contact.joint).name));
        contact_forces(g, &mut loads, state, contact);
    }
    for index in 0..state.geometry.mechanism.joints.len() {
        let joint = JointId::new(index);
        let data = state.geometry.mechanism.joint(joint);
        if !data.passive.is_empty() {
            g.begin_section(format!("forces in {}", data.name));
        }
        for passive in &data.passive {
            loads.joint_force(g, state, joint, passive);
        }
    }
    for force in &state.geometry.mechanism.forces {
        g.begin_section(format!("force {}", force.name));
        loads.element(g, state, &force.kind);
    }
    loads
}

impl<'g> Loads<'g> {
    /// Stiffness and damping of a flexible body: `-K_ff q_f - D_ff q_f'`, [CS (6)].
    fn elasticity(&mut self, g: &'g Scope, state: &JointStates<'g>, at: usize) {
        let link = &state.geometry.linkage.links[at];
        let flexible = &state.geometry.mechanism.body(link.body).flexible;
        let (Some(flexible), Freedom::Flexible { .. }) = (flexible, link.freedom) else { return };
        g.begin_section(format!("elasticity of {}", link.name));
        let modes = &state.motion.modes[at];
        let half = g.constant(0.5);
        for (k, speed) in link.speeds().enumerate() {
            let elastic = row_times(g, &flexible.data.stiffness[k], &modes.q);
            let viscous = row_times(g, &flexible.data.damping[k], &modes.v);
            let sum = g.add(elastic, viscous);
            self.joint[speed] = g.sub(self.joint[speed], sum);
            let (work, power) = (g.mul(elastic, modes.q[k]), g.mul(viscous, modes.v[k]));
            let energy = g.mul(half, work);
            self.potential = g.add(self.potential, energy);
            self.dissipated = g.add(self.dissipated, power);
        }
    }

    fn joint_force(&mut self, g: &'g Scope, state: &JointStates<'g>, joint: JointId, passive: &Passive) {
        let ball = state.geometry.mechanism.joint(joint).model.is_ball();
        if let (true, Passive::Damping { coefficient, .. }) = (ball, passive) {
            let coefficient = state.lower(g, coefficient);
            return self.spherical_damping(g, state, joint, coefficient);
        }
        let coordinates = state.coordinates(g, joint);
        let (coordinate, force) = match passive {
            Passive::Damping { coordinate, coefficient } => {
                let coefficient = state.lower(g, coefficient);
                let speed = coordinates.speed[*coordinate];
                let force = g.mul(coefficient, speed);
                let power = g.mul(force, speed);
                self.dissipated = g.add(self.dissipated, power);
                (*coordinate, g.neg(force))
            }
            Passive::Spring { coordinate, stiffness, rest } => {
                let (stiffness, rest) = (state.lower(g, stiffness), state.lower(g, rest));
                let stretch = g.sub(coordinates.position[*coordinate], rest);
                let force = g.mul(stiffness, stretch);
                let (half, work) = (g.constant(0.5), g.mul(force, stretch));
                let energy = g.mul(half, work);
                self.potential = g.add(self.potential, energy);
                (*coordinate, g.neg(force))
            }
            Passive::Actuator { coordinate, force } => {
                let force = state.lower(g, force);
                let power = g.mul(force, coordinates.speed[*coordinate]);
                self.supplied = g.add(self.supplied, power);
                (*coordinate, force)
            }
        };
        if let Some(link) = state.geometry.linkage.link_of_coordinate(joint, coordinate) {
            let speed = state.geometry.linkage.links[link].first_speed;
            self.joint[speed] = g.add(self.joint[speed], force);
        } else {
            let (moment, direction) = coordinates.duals[coordinate];
            let across = state.across(g, joint);
            let (moment, force) = (g.scale3(force, moment), g.scale3(force, direction));
            self.pair(g, state, joint, &across, moment, force);
        }
    }

    /// `-c omega_rel` on the child, its opposite on the parent. The ball sits on a section: where a body is
    /// flexible, its slope there turns the ball, and the moment bends the body.
    fn spherical_damping(&mut self, g: &'g Scope, state: &JointStates<'g>, joint: JointId, c: Expr<'g>) {
        let linkage = state.geometry.linkage;
        let sections = Sections::new(state, joint);
        if let Some(at) = linkage.ball_of(joint) {
            let rotation = state.motion.poses.relative[at].rotation;
            let mut omega = state.motion.relative_omega(linkage, at);
            let outer = sections.rate(g, state, Side::Outboard);
            omega = g.add3(omega, outer);
            let inner = sections.rate(g, state, Side::Inboard);
            let inner = g.transpose_mul_vec3(rotation, inner);
            omega = g.sub3(omega, inner);
            self.dissipate(g, c, omega);
            let scaled = g.scale3(c, omega);
            let moment = g.neg3(scaled);
            let first = linkage.links[at].first_speed;
            for (i, component) in moment.into_iter().enumerate() {
                self.joint[first + i] = g.add(self.joint[first + i], component);
            }
            self.bend(g, &sections, Side::Outboard, moment);
            let turned = g.mul_vec3(rotation, scaled);
            self.bend(g, &sections, Side::Inboard, turned);
            if let Some(parent) = linkage.links[at].parent {
                let force = g.zero_vector();
                let reaction = Wrench { moment: turned, force };
                self.reactions[parent] += reaction;
            }
        } else {
            let across = state.across(g, joint);
            let child = sections.rate(g, state, Side::Outboard);
            let child = g.mul_vec3(across.from_child, child);
            let parent = sections.rate(g, state, Side::Inboard);
            let parent = g.mul_vec3(across.from_parent, parent);
            let slopes = g.sub3(child, parent);
            let omega = g.add3(across.omega, slopes);
            self.dissipate(g, c, omega);
            let scaled = g.scale3(c, omega);
            let (moment, force) = (g.neg3(scaled), g.zero_vector());
            self.pair(g, state, joint, &across, moment, force);
            let on_child = g.transpose_mul_vec3(across.from_child, moment);
            self.bend(g, &sections, Side::Outboard, on_child);
            let on_parent = g.transpose_mul_vec3(across.from_parent, scaled);
            self.bend(g, &sections, Side::Inboard, on_parent);
        }
    }

    /// What modes feel of a moment on a section, given in the floating frame.
    fn bend(&mut self, g: &'g Scope, sections: &Sections, side: Side, moment: Vec3<'g>) {
        let Some((_, first, slopes)) = sections.of(side) else { return };
        for (k, slope) in slopes.iter().enumerate() {
            let slope = g.vector(*slope);
            let force = g.dot3(slope, moment);
            self.joint[first + k] = g.add(self.joint[first + k], force);
        }
    }

    fn dissipate(&mut self, g: &'g Scope, coefficient: Expr<'g>, rate: Vec3<'g>) {
        let square = g.dot3(rate, rate);
        let power = g.mul(coefficient, square);
        self.dissipated = g.add(self.dissipated, power);
    }

    fn element(&mut self, g: &'g Scope, state: &JointStates<'g>, kind: &ForceKind) {
        match kind {
            ForceKind::Spring { bodies, at, stiffness, rest, damping, preload } => {
                let [stiffness, rest, damping, preload] =
                    [stiffness, rest, damping, preload].map(|formula| state.lower(g, formula));
                self.spring(g, state, *bodies, *at, [stiffness, rest, damping, preload]);
            }
            ForceKind::Force { body, reaction, at, components, axes } => {
                let force = directed(g, state, components, *axes);
                let links =
                    [*body, *reaction].map(|carrier| state.geometry.linkage.link_at(carrier, *at, false));
                let local = state.geometry.local(links[0], *at);
                let place = state.motion.poses.position(links[0], local);
                let zero = g.zero_vector();
                self.world_pair(g, state, links, place, [zero, force]);
            }
            ForceKind::Torque { body, reaction, components, axes } => {
                let torque = directed(g, state, components, *axes);
                let links = [*body, *reaction].map(|carrier| state.geometry.linkage.link(carrier));
                let zero = g.zero_vector();
                self.world_pair(g, state, links, zero, [torque, zero]);
            }
        }
    }

    /// Pull `k (l - rest) + c l̇ + preload` along the line between two points.
    fn spring(
        &mut self,
        g: &'g Scope,
        state: &JointStates<'g>,
        bodies: [Carrier; 2],
        at: [PointId; 2],
        [stiffness, rest, damping, preload]: [Expr<'g>; 4],
    ) {
        let links = [0, 1].map(|i| state.geometry.linkage.link_at(bodies[i], at[i], false));
        let locals = [0, 1].map(|i| state.geometry.local(links[i], at[i]));
        let places = [0, 1].map(|i| state.motion.poses.position(links[i], locals[i]));
        let velocities = [0, 1].map(|i| state.motion.point_velocity_w(links[i], locals[i]));
        let (apart, rate) = (g.sub3(places[1], places[0]), g.sub3(velocities[1], velocities[0]));
        let square = g.dot3(apart, apart);
        let length = g.sqrt(square);
        let reciprocal = g.reciprocal(length);
        let direction = g.scale3(reciprocal, apart);
        let speed = g.dot3(direction, rate);
        let stretch = g.sub(length, rest);
        let (elastic, viscous) = (g.mul(stiffness, stretch), g.mul(damping, speed));
        let (half, work) = (g.constant(0.5), g.mul(elastic, stretch));
        let energy = g.mul(half, work);
        let drawn = g.mul(preload, length);
        let stored = g.add(energy, drawn);
        self.potential = g.add(self.potential, stored);
        let power = g.mul(viscous, speed);
        self.dissipated = g.add(self.dissipated, power);
        let sum = g.add(elastic, viscous);
        let pull = g.add(sum, preload);
        // On the first body towards the second, and the reverse.
        let force = g.scale3(pull, direction);
        for i in 0..2 {
            let own = if i == 0 { force } else { g.neg3(force) };
            let rotation = state.motion.poses.world_of(g, links[i]).rotation;
            let force = g.transpose_mul_vec3(rotation, own);
            let moment = g.cross3(locals[i], force);
            self.push(links[i], Wrench { moment, force });
        }
    }

    /// A wrench (moment, force) in W at a place in W on the first link and its opposite on the second.
    fn world_pair(
        &mut self,
        g: &'g Scope,
        state: &JointStates<'g>,
        links: [LinkIndex; 2],
        place: Vec3<'g>,
        [moment, force]: [Vec3<'g>; 2],
    ) {
        for (i, link) in links.into_iter().enumerate() {
            let Some(at) = link else { continue };
            let pose = state.motion.poses.world[at];
            let arm = g.sub3(place, pose.offset);
            let lever = g.cross3(arm, force);
            let is_force = force.into_iter().any(|component| !component.is_zero());
            let total = if is_force { g.add3(moment, lever) } else { moment };
            let wrench = Wrench {
                moment: g.transpose_mul_vec3(pose.rotation, total),
                force: g.transpose_mul_vec3(pose.rotation, force),
            };
            let wrench = if i == 0 { wrench } else { -wrench };
            let twist = state.motion.twists[at];
            let (turning, moving) = (g.dot3(wrench.moment, twist.omega), g.dot3(wrench.force, twist.origin));
            let power = g.add(turning, moving);
            self.supplied = g.add(self.supplied, power);
            self.push(Some(at), wrench);
        }
    }
}

/// Components in W of a vector given in W or in axes that move with a body.
fn directed<'g>(
    g: &'g Scope,
    state: &JointStates<'g>,
    components: &[crate::model::Formula; 3],
    axes: Carrier,
) -> Vec3<'g> {
    let components = Vec3::from_fn(|i| state.lower(g, &components[i]));
    let Some(at) = state.geometry.linkage.link(axes) else { return components };
    let local = state.geometry.turn(&state.geometry.linkage.links[at].frame, components);
    g.mul_vec3(state.motion.poses.world[at].rotation, local)
}

/// `sum_l row_l x_l`.
fn row_times<'g>(g: &'g Scope, row: &[f64], x: &[Expr<'g>]) -> Expr<'g> {
    let terms: Vec<(Expr<'g>, Expr<'g>)> = row.iter().zip(x).map(|(m, x)| (g.constant(*m), *x)).collect();
    g.dot(&terms)
}

/// One side of a joint: in the tree away from the ground, in a cut the child.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Side {
    Inboard,
    Outboard,
}

/// Slopes of the sections on which a ball joint sits: floating frame, first modal speed, and the rotation
/// vector per unit of each mode, for bodies that are flexible.
struct Sections([Option<Section>; 2]);

/// Floating frame, first modal speed, slopes.
type Section = (usize, usize, Vec<[f64; 3]>);

impl Sections {
    fn new(state: &JointStates<'_>, joint: JointId) -> Self {
        let (mechanism, linkage) = (state.geometry.mechanism, state.geometry.linkage);
        let data = mechanism.joint(joint);
        let side = |carrier: Carrier| {
            let Carrier::Body(body) = carrier else { return None };
            let flexible = mechanism.body(body).flexible.as_ref()?;
            let frame = linkage.link_of_body[body.index()];
            let slopes = flexible.node_at(data.at).rotation.clone();
            Some((frame, linkage.links[frame].first_speed, slopes))
        };
        let (parent, child) = (side(data.parent), side(data.child));
        if linkage.reversed[joint.index()] { Self([child, parent]) } else { Self([parent, child]) }
    }

    fn of(&self, side: Side) -> Option<&Section> {
        self.0[usize::from(side == Side::Outboard)].as_ref()
    }

    /// Angular velocity of the section relative to the floating frame, in that frame.
    fn rate<'g>(&self, g: &'g Scope, state: &JointStates<'g>, side: Side) -> Vec3<'g> {
        let Some((frame, _, slopes)) = self.of(side) else { return g.zero_vector() };
        let speeds = &state.motion.modes[*frame].v;
        g.weighted_vectors(slopes, speeds)
    }
}
