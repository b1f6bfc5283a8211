//! End stops of joint coordinates.

use super::joint::push_along;
use crate::derive::element::Element;
use crate::derive::joint_state::JointStates;
use crate::derive::loads::Loads;
use crate::derive::stops::pressed;
use crate::expr::Scope;
use crate::model::Stop;

impl<'g> Element<'g> for Stop {
    fn add_to(&self, loads: &mut Loads<'g>, g: &'g Scope, state: &JointStates<'g>) {
        let coordinates = state.coordinates(g, self.joint);
        let own = [&coordinates.position, &coordinates.speed].map(|list| list[self.coordinate]);
        let pressed = pressed(g, state, self, own);
        loads.potential += pressed.stored;
        loads.dissipated += pressed.dissipated;
        push_along(loads, state, (self.joint, self.coordinate), &coordinates, pressed.force);
    }
}
