//! Couplings that give way.

use crate::derive::couplings::{Multiplied, given, mesh_wrenches};
use crate::derive::element::Element;
use crate::derive::joint_state::JointStates;
use crate::derive::loads::Loads;
use crate::expr::Scope;
use crate::model::Coupling;

impl<'g> Element<'g> for Coupling {
    fn add_to(&self, loads: &mut Loads<'g>, g: &'g Scope, state: &JointStates<'g>) {
        let Some(law) = &self.compliance else { return };
        let given = given(g, state, self, law);
        loads.potential += given.stored;
        loads.dissipated += given.dissipated;
        for (link, wrench) in mesh_wrenches(state, self, &Multiplied::new(given.force)) {
            loads.push(link, wrench);
        }
        for (speed, factor) in given.factors.into_iter().enumerate().filter(|_| self.meshes.is_empty()) {
            loads.push_along(speed, factor * given.force);
        }
    }
}
