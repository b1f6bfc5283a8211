//! What every force element can do. Never knows which there are.

use crate::expr::Scope;

use super::joint_state::JointStates;
use super::loads::Loads;

/// Something that pushes links apart or together.
pub trait Element<'g> {
    /// Adds its wrenches, the energy that it stores, the power that it takes and the power that it puts in.
    fn add_to(&self, loads: &mut Loads<'g>, g: &'g Scope, state: &JointStates<'g>);
}
