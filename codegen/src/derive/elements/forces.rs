//! Force elements between bodies: the equations of every kind.

use crate::derive::element::Element;
use crate::derive::force_values::force_values;
use crate::derive::joint_state::JointStates;
use crate::derive::line::{Line, Taut};
use crate::derive::linkage::LinkIndex;
use crate::derive::loads::Loads;
use crate::derive::mount::Mount;
use crate::derive::wrench::Wrench;
use crate::expr::{Expr, Scope, Vec3};
use crate::model::Force;

/// What the elements of a kind add to the loads.
type Equations = for<'g> fn(&Force, &mut Loads<'g>, &'g Scope, &JointStates<'g>);

/// The equations of every kind.
const EQUATIONS: &[(&str, Equations)] =
    &[("spring", spring), ("cable", pull), ("bushing", mount), ("force", push), ("torque", turn)];

/// Output columns of an element: name behind its own, unit, value.
pub fn force_columns<'g>(
    element: &Force,
    g: &'g Scope,
    state: &JointStates<'g>,
) -> Vec<(String, String, Expr<'g>)> {
    let columns = element.kind.told.columns();
    if columns.is_empty() {
        return Vec::new();
    }
    g.begin_section(format!("force {}", element.name));
    let values = force_values(element, &state.motion);
    let named = columns.iter().zip(values);
    named
        .filter_map(|((name, dimension), value)| {
            Some((element.column(name, *dimension)?, dimension.si_unit(), value))
        })
        .collect()
}

impl<'g> Element<'g> for Force {
    fn add_to(&self, loads: &mut Loads<'g>, g: &'g Scope, state: &JointStates<'g>) {
        let own = EQUATIONS.iter().find(|(known, _)| *known == self.kind.name);
        #[expect(clippy::expect_used, reason = "a test looks for the equations of every kind")]
        let (_, equations) = own.expect("every kind has equations");
        equations(self, loads, g, state);
    }
}

/// Spring and damper: pull `k (l - rest) + c l̇ + preload` along the line between two points.
fn spring<'g>(element: &Force, loads: &mut Loads<'g>, g: &'g Scope, state: &JointStates<'g>) {
    let [stiffness, rest, damping, preload] = element.numbers().map(|formula| state.lower(g, formula));
    let line = Line::new(element, &state.motion);
    let stretch = line.length - rest;
    let (elastic, viscous) = (stiffness * stretch, damping * line.speed);
    loads.potential += 0.5 * (elastic * stretch) + preload * line.length;
    loads.dissipated += viscous * line.speed;
    pull_along(&line, loads, g, state, elastic + viscous + preload);
}

/// Pulls both bodies towards each other.
fn pull_along<'g>(
    line: &Line<'g>,
    loads: &mut Loads<'g>,
    g: &'g Scope,
    state: &JointStates<'g>,
    force: Expr<'g>,
) {
    // On the first body towards the second, and the reverse.
    let force = force * line.direction;
    for i in 0..2 {
        let pull = if i == 0 { force } else { -force };
        let force = state.motion.poses.world_of(g, line.links[i]).rotation.transpose() * pull;
        loads.push(line.links[i], Wrench { moment: line.points[i].cross(force), force });
    }
}

/// Pulls as a rope does.
fn pull<'g>(element: &Force, loads: &mut Loads<'g>, g: &'g Scope, state: &JointStates<'g>) {
    let line = Line::new(element, &state.motion);
    let taut = Taut::new(element, &state.motion, &line);
    loads.potential += taut.stored;
    loads.dissipated += taut.dissipated;
    pull_along(&line, loads, g, state, taut.force);
}

/// Holds as rubber does.
fn mount<'g>(element: &Force, loads: &mut Loads<'g>, _: &'g Scope, state: &JointStates<'g>) {
    let mount = Mount::new(element, &state.motion);
    for part in mount.stored {
        loads.potential += part;
    }
    for part in mount.dissipated {
        loads.dissipated += part;
    }
    loads.between(&mount.motion, mount.moment, mount.force);
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
