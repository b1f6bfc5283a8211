//! Force elements between bodies: the equations of every kind.

use crate::derive::element::Element;
use crate::derive::frame::Frame;
use crate::derive::joint_state::JointStates;
use crate::derive::linkage::LinkIndex;
use crate::derive::loads::Loads;
use crate::derive::log_closure::Logarithm;
use crate::derive::relative_motion::{Marker, Place, RelativeMotion, Side, Sums};
use crate::derive::wrench::Wrench;
use crate::expr::{Scope, Vec3};
use crate::model::Force;

/// What the elements of a kind add to the loads.
type Equations = for<'g> fn(&Force, &mut Loads<'g>, &'g Scope, &JointStates<'g>);

/// The equations of every kind.
const EQUATIONS: &[(&str, Equations)] =
    &[("spring", spring), ("bushing", bushing), ("force", push), ("torque", turn)];

impl<'g> Element<'g> for Force {
    fn add_to(&self, loads: &mut Loads<'g>, g: &'g Scope, state: &JointStates<'g>) {
        let own = EQUATIONS.iter().find(|(kind, _)| *kind == self.kind.name);
        #[expect(clippy::expect_used, reason = "a test looks for the equations of every kind")]
        let (_, equations) = own.expect("every kind has equations");
        equations(self, loads, g, state);
    }
}

/// Spring and damper: pull `k (l - rest) + c l̇ + preload` along the line between two points.
fn spring<'g>(element: &Force, loads: &mut Loads<'g>, g: &'g Scope, state: &JointStates<'g>) {
    let [stiffness, rest, damping, preload] = element.numbers().map(|formula| state.lower(g, formula));
    let (geometry, motion) = (&state.geometry, &state.motion);
    let links = [0, 1].map(|i| geometry.linkage.link_at(element.bodies[i], element.at[i], false));
    let points = [0, 1].map(|i| geometry.local(links[i], element.at[i]));
    let places = [0, 1].map(|i| motion.poses.position(links[i], points[i]));
    let velocities = [0, 1].map(|i| motion.velocity_in_ground(links[i], points[i]));
    let (apart, rate) = (places[1] - places[0], velocities[1] - velocities[0]);
    let length = apart.dot(apart).sqrt();
    let direction = length.recip() * apart;
    let speed = direction.dot(rate);
    let stretch = length - rest;
    let (elastic, viscous) = (stiffness * stretch, damping * speed);
    loads.potential += 0.5 * (elastic * stretch) + preload * length;
    loads.dissipated += viscous * speed;
    // On the first body towards the second, and the reverse.
    let force = (elastic + viscous + preload) * direction;
    for i in 0..2 {
        let pull = if i == 0 { force } else { -force };
        let force = motion.poses.world_of(g, links[i]).rotation.transpose() * pull;
        loads.push(links[i], Wrench { moment: points[i].cross(force), force });
    }
}

/// Elastic mount between two bodies, stiff and damped along and about three axes, at rest in the reference pose.
///
/// With d the second body's marker from the first's, along the first's axes, and phi the rotation vector between
/// both: `V = sum k_j d_j² / 2 + sum kr_j phi_j² / 2`, a force `-(k_j d_j + c_j d_j')` along the first's axes, a
/// moment `-A^T (kr phi) - cr omega` along the second's, where `phi' = A omega`, A as for closure `log`.
fn bushing<'g>(element: &Force, loads: &mut Loads<'g>, g: &'g Scope, state: &JointStates<'g>) {
    let (geometry, linkage) = (&state.geometry, state.geometry.linkage);
    let ([x, y, z], [at, _]) = (element.directions, element.at);
    let axes = Frame::from_axes(x, y, z);
    let markers = element.bodies.map(|body| {
        let link = linkage.link_at(body, at, true);
        let outer = link.map_or(Frame::IDENTITY, |at| linkage.links[at].frame);
        let frame = outer.transposed().times(&axes).snapped();
        Marker { link, point: geometry.local(link, at), frame }
    });
    let motion = RelativeMotion::between(&state.motion, markers, Side::Child, (Place::Child, Sums::Links));
    let rotation = motion.rotation();
    let logarithm = Logarithm::new(g, rotation, motion.distance);
    let [stiffness, damping, turning_stiffness, turning_damping] =
        element.triples().map(|list| Vec3::from_fn(|j| state.lower(g, &list[j])));
    let (mut force, mut elastic, mut moment) = (g.zero_vector(), g.zero_vector(), g.zero_vector());
    for j in 0..3 {
        let axis = motion.parent_axis(j);
        let (displacement, speed) = (axis.dot(motion.distance), axis.dot(motion.slide));
        let (spring, damper) = (stiffness[j] * displacement, damping[j] * speed);
        force -= (spring + damper) * axis;
        elastic[j] = turning_stiffness[j] * logarithm.phi[j];
        loads.potential += 0.5 * (spring * displacement + elastic[j] * logarithm.phi[j]);
        loads.dissipated += damper * speed;
    }
    let elastic = logarithm.half_jacobian(g).transpose() * elastic;
    for j in 0..3 {
        let axis = motion.child_axis(j);
        let rate = axis.dot(motion.omega);
        let damper = turning_damping[j] * rate;
        moment -= (elastic[j] + damper) * axis;
        loads.dissipated += damper * rate;
    }
    loads.between(&motion, moment, force);
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
    let components = Vec3::from_fn(|i| state.lower(g, &components[i]));
    let Some(at) = state.geometry.linkage.link(element.axes) else { return components };
    let local = state.geometry.turn(&state.geometry.linkage.links[at].frame, components);
    state.motion.poses.world[at].rotation * local
}

#[cfg(test)]
mod tests {
    use super::EQUATIONS;
    use crate::spec::FORCE_KINDS;

    #[test]
    fn every_kind_has_equations() {
        let kinds = FORCE_KINDS.iter().map(|kind| kind.name);
        assert!(kinds.eq(EQUATIONS.iter().map(|(kind, _)| *kind)));
    }
}
