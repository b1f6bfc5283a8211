//! Forces and torques by formula.

use crate::derive::element::Element;
use crate::derive::joint_state::JointStates;
use crate::derive::linkage::LinkIndex;
use crate::derive::loads::Loads;
use crate::derive::wrench::Wrench;
use crate::expr::{Scope, Vec3};
use crate::model::{AppliedForce, AppliedTorque, Carrier, Formula};

impl<'g> Element<'g> for AppliedForce {
    fn add_to(&self, loads: &mut Loads<'g>, g: &'g Scope, state: &JointStates<'g>) {
        let force = directed(g, state, &self.components, self.axes);
        let linkage = state.geometry.linkage;
        let links = [self.body, self.reaction].map(|carrier| linkage.link_at(carrier, self.at, false));
        let local = state.geometry.local(links[0], self.at);
        let place = state.motion.poses.position(links[0], local);
        world_pair(loads, state, links, place, [g.zero_vector(), force]);
    }
}

impl<'g> Element<'g> for AppliedTorque {
    fn add_to(&self, loads: &mut Loads<'g>, g: &'g Scope, state: &JointStates<'g>) {
        let torque = directed(g, state, &self.components, self.axes);
        let links = [self.body, self.reaction].map(|carrier| state.geometry.linkage.link(carrier));
        let zero = g.zero_vector();
        world_pair(loads, state, links, zero, [torque, zero]);
    }
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
fn directed<'g>(g: &'g Scope, state: &JointStates<'g>, components: &[Formula; 3], axes: Carrier) -> Vec3<'g> {
    let components = Vec3::from_fn(|i| state.lower(g, &components[i]));
    let Some(at) = state.geometry.linkage.link(axes) else { return components };
    let local = state.geometry.turn(&state.geometry.linkage.links[at].frame, components);
    state.motion.poses.world[at].rotation * local
}
