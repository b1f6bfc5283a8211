//! Force elements: what each adds to the loads. In: motion of links. Out: [`Loads`].
//! Never knows constraints. Gravity enters with the accelerations.

use crate::expr::Scope;
use crate::id::JointId;

use super::contact_wrench::ContactWrench;
use super::contacts::contact_forces;
use super::element::Element;
use super::joint_state::JointStates;
use super::loads::Loads;

mod ball_damper;
mod coupling;
mod dry_friction;
mod elasticity;
mod forces;
mod joint;
mod stop;

pub use forces::force_columns;

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
    for coupling in mechanism.couplings.iter().filter(|coupling| coupling.compliance.is_some()) {
        g.begin_section(format!("coupling {}", coupling.name));
        coupling.add_to(&mut loads, g, state);
    }
    for stop in &mechanism.stops {
        g.begin_section(format!("stop {}", stop.name));
        stop.add_to(&mut loads, g, state);
    }
    for force in &mechanism.forces {
        g.begin_section(format!("force {}", force.name));
        force.add_to(&mut loads, g, state);
    }
    loads
}
