//! Force elements between bodies: the equations of every kind.

use super::mount::mount;
use crate::derive::element::Element;
use crate::derive::joint_state::JointStates;
use crate::derive::linkage::LinkIndex;
use crate::derive::loads::Loads;
use crate::derive::wrench::Wrench;
use crate::expr::{Expr, Scope, Vec3};
use crate::model::Force;
use crate::spec::ForceKind;

/// What the elements of a kind add to the loads.
type Equations = for<'g> fn(&Force, &mut Loads<'g>, &'g Scope, &JointStates<'g>);

/// Output columns of the elements of a kind: name, unit, value.
type Columns = for<'g> fn(&Force, &'g Scope, &JointStates<'g>) -> Vec<(&'static str, &'static str, Expr<'g>)>;

/// The equations of every kind, and what it tells of itself.
const EQUATIONS: &[(&str, Equations, Option<Columns>)] = &[
    ("spring", spring, None),
    ("cable", pull, Some(pull_columns)),
    ("bushing", mount, None),
    ("force", push, None),
    ("torque", turn, None),
];

fn own(kind: &ForceKind) -> (Equations, Option<Columns>) {
    let own = EQUATIONS.iter().find(|(known, ..)| *known == kind.name);
    #[expect(clippy::expect_used, reason = "a test looks for the equations of every kind")]
    let (_, equations, columns) = own.expect("every kind has equations");
    (*equations, *columns)
}

/// Output columns of an element: name behind its own, unit, value.
pub fn force_columns<'g>(
    element: &Force,
    g: &'g Scope,
    state: &JointStates<'g>,
) -> Vec<(&'static str, &'static str, Expr<'g>)> {
    let Some(columns) = own(element.kind).1 else { return Vec::new() };
    g.begin_section(format!("force {}", element.name));
    columns(element, g, state)
}

impl<'g> Element<'g> for Force {
    fn add_to(&self, loads: &mut Loads<'g>, g: &'g Scope, state: &JointStates<'g>) {
        own(self.kind).0(self, loads, g, state);
    }
}

/// Spring and damper: pull `k (l - rest) + c l̇ + preload` along the line between two points.
fn spring<'g>(element: &Force, loads: &mut Loads<'g>, g: &'g Scope, state: &JointStates<'g>) {
    let [stiffness, rest, damping, preload] = element.numbers().map(|formula| state.lower(g, formula));
    let line = Line::new(element, state);
    let stretch = line.length - rest;
    let (elastic, viscous) = (stiffness * stretch, damping * line.speed);
    loads.potential += 0.5 * (elastic * stretch) + preload * line.length;
    loads.dissipated += viscous * line.speed;
    line.pull(loads, g, state, elastic + viscous + preload);
}

/// The line between the two points of an element.
struct Line<'g> {
    links: [LinkIndex; 2],
    /// In the frames of the links.
    points: [Vec3<'g>; 2],
    /// From the first to the second, in W.
    direction: Vec3<'g>,
    length: Expr<'g>,
    /// Rate of the length.
    speed: Expr<'g>,
}

impl<'g> Line<'g> {
    fn new(element: &Force, state: &JointStates<'g>) -> Self {
        let (geometry, motion) = (&state.geometry, &state.motion);
        let links = [0, 1].map(|i| geometry.linkage.link_at(element.bodies[i], element.at[i], false));
        let points = [0, 1].map(|i| geometry.local(links[i], element.at[i]));
        let places = [0, 1].map(|i| motion.poses.position(links[i], points[i]));
        let velocities = [0, 1].map(|i| motion.velocity_in_ground(links[i], points[i]));
        let (apart, rate) = (places[1] - places[0], velocities[1] - velocities[0]);
        let length = apart.dot(apart).sqrt();
        let direction = length.recip() * apart;
        Self { links, points, direction, length, speed: direction.dot(rate) }
    }

    /// Pulls both bodies towards each other.
    fn pull(&self, loads: &mut Loads<'g>, g: &'g Scope, state: &JointStates<'g>, force: Expr<'g>) {
        // On the first body towards the second, and the reverse.
        let force = force * self.direction;
        for i in 0..2 {
            let pull = if i == 0 { force } else { -force };
            let force = state.motion.poses.world_of(g, self.links[i]).rotation.transpose() * pull;
            loads.push(self.links[i], Wrench { moment: self.points[i].cross(force), force });
        }
    }
}

/// Pull of a rope: with `s = k (l - rest) + preload`, `max(0, s + c l̇)` where s is above zero, else nothing. It stores `s²/2k`.
struct Taut<'g> {
    force: Expr<'g>,
    stored: Expr<'g>,
    dissipated: Expr<'g>,
}

impl<'g> Taut<'g> {
    fn new(element: &Force, g: &'g Scope, state: &JointStates<'g>, line: &Line<'g>) -> Self {
        let [stiffness, rest, damping, preload] = element.numbers().map(|formula| state.lower(g, formula));
        let strain = stiffness * (line.length - rest) + preload;
        let slack = -strain;
        let elastic = slack.below_zero(strain, g.zero());
        let stored = 0.5 * (elastic.square() / stiffness);
        if damping.is_zero() {
            return Self { force: elastic, stored, dissipated: g.zero() };
        }
        let pull = slack.below_zero(strain + damping * line.speed, g.zero());
        let force = pull.below_zero(g.zero(), pull);
        Self { force, stored, dissipated: (force - elastic) * line.speed }
    }
}

fn pull<'g>(element: &Force, loads: &mut Loads<'g>, g: &'g Scope, state: &JointStates<'g>) {
    let line = Line::new(element, state);
    let taut = Taut::new(element, g, state, &line);
    loads.potential += taut.stored;
    loads.dissipated += taut.dissipated;
    line.pull(loads, g, state, taut.force);
}

fn pull_columns<'g>(
    element: &Force,
    g: &'g Scope,
    state: &JointStates<'g>,
) -> Vec<(&'static str, &'static str, Expr<'g>)> {
    let line = Line::new(element, state);
    let taut = Taut::new(element, g, state, &line);
    vec![("F", "N", taut.force), ("length", "m", line.length)]
}

/// Force by formula at a point of a body, with its opposite on another at the same place.
fn push<'g>(element: &Force, loads: &mut Loads<'g>, g: &'g Scope, state: &JointStates<'g>) {
    let force = components(element, g, state);
    let at = element.at[0];
    let links = element.bodies.map(|carrier| state.geometry.linkage.link_at(carrier, at, false));
    let local = state.geometry.local(links[0], at);
    let place = state.motion.poses.position(links[0], local);
    world_pair(loads, state, links, place, [g.zero_vector(), force]);
}

/// Torque by formula on a body, with its opposite on another.
fn turn<'g>(element: &Force, loads: &mut Loads<'g>, g: &'g Scope, state: &JointStates<'g>) {
    let torque = components(element, g, state);
    let links = element.bodies.map(|carrier| state.geometry.linkage.link(carrier));
    let zero = g.zero_vector();
    world_pair(loads, state, links, zero, [torque, zero]);
}

/// A wrench (moment, force) in W at a place in W on the first link and its opposite on the second.
fn world_pair<'g>(
    loads: &mut Loads<'g>,
    state: &JointStates<'g>,
    links: [LinkIndex; 2],
    place: Vec3<'g>,
    [moment, force]: [Vec3<'g>; 2],
) {
    for (i, link) in links.into_iter().enumerate() {
        let Some(at) = link else { continue };
        let pose = state.motion.poses.world[at];
        let lever = (place - pose.offset).cross(force);
        let is_force = force.into_iter().any(|component| !component.is_zero());
        let total = if is_force { moment + lever } else { moment };
        let to_link = pose.rotation.transpose();
        let wrench = Wrench { moment: to_link * total, force: to_link * force };
        let wrench = if i == 0 { wrench } else { -wrench };
        let twist = state.motion.twists[at];
        loads.supplied += wrench.moment.dot(twist.omega) + wrench.force.dot(twist.origin);
        loads.push(Some(at), wrench);
    }
}

/// Components in W of a vector given in W or in axes that move with a body.
fn components<'g>(element: &Force, g: &'g Scope, state: &JointStates<'g>) -> Vec3<'g> {
    let [components] = element.triples();
    let components = Vec3::from_fn(|i| state.force_law(g, &components[i]));
    state.taken_along(element.axes, components)
}

#[cfg(test)]
mod tests {
    use super::EQUATIONS;
    use crate::spec::FORCE_KINDS;

    #[test]
    fn every_kind_has_equations() {
        let kinds = FORCE_KINDS.iter().map(|kind| kind.name);
        assert!(kinds.eq(EQUATIONS.iter().map(|(kind, ..)| *kind)));
    }
}
