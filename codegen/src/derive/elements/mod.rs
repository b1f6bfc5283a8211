//! Force elements: what each adds to the loads, one file per kind. In: motion of links. Out: [`Loads`].
//! Never knows constraints. Gravity enters with the accelerations.

use crate::expr::Scope;
use crate::id::JointId;
use crate::model::ForceKind;

use super::contacts::{ContactWrench, contact_forces};
use super::element::Element;
use super::joint_state::JointStates;
use super::loads::Loads;

mod applied;
mod ball_damper;
mod bushing;
mod elasticity;
mod joint;
mod spring;

fn element<'g>(kind: &ForceKind) -> &dyn Element<'g> {
    match kind {
        ForceKind::Spring(spring) => spring,
        ForceKind::Bushing(bushing) => bushing,
        ForceKind::Force(force) => force,
        ForceKind::Torque(torque) => torque,
    }
}

/// Collects all loads.
pub fn loads<'g>(g: &'g Scope, state: &JointStates<'g>, contacts: &[ContactWrench<'g>]) -> Loads<'g> {
    let (mechanism, linkage) = (state.geometry.mechanism, state.geometry.linkage);
    let mut loads = Loads::none(g, linkage);
    for link in 0..linkage.links.len() {
        elasticity::Elasticity { link }.add_to(&mut loads, g, state);
    }
    for contact in contacts {
        g.begin_section(format!("contact in {}", mechanism.joint(contact.joint).name));
        contact_forces(g, &mut loads, state, contact);
    }
    for (index, data) in mechanism.joints.iter().enumerate() {
        if !data.passive.is_empty() {
            g.begin_section(format!("forces in {}", data.name));
        }
        for passive in &data.passive {
            joint::JointElement { joint: JointId::new(index), passive }.add_to(&mut loads, g, state);
        }
    }
    for force in &mechanism.forces {
        g.begin_section(format!("force {}", force.name));
        element(&force.kind).add_to(&mut loads, g, state);
    }
    loads
}
