//! Stiffness and damping of a flexible body.

use crate::derive::element::Element;
use crate::derive::joint_state::JointStates;
use crate::derive::linkage::Freedom;
use crate::derive::loads::Loads;
use crate::expr::Scope;

/// `-K_ff q_f - D_ff q_f'`, [CS (6)], if the link is the floating frame of a flexible body.
pub struct Elasticity {
    /// Index of the link.
    pub link: usize,
}

impl<'g> Element<'g> for Elasticity {
    fn add_to(&self, loads: &mut Loads<'g>, g: &'g Scope, state: &JointStates<'g>) {
        let link = &state.geometry.linkage.links[self.link];
        let flexible = &state.geometry.mechanism.body(link.body).flexible;
        let (Some(flexible), Freedom::Flexible { .. }) = (flexible, link.freedom) else { return };
        g.begin_section(format!("elasticity of {}", link.name));
        let modes = &state.motion.modes[self.link];
        for (k, speed) in link.speeds().enumerate() {
            let elastic = g.weighted(flexible.data.stiffness[k].iter().copied(), &modes.q);
            let viscous = g.weighted(flexible.data.damping[k].iter().copied(), &modes.v);
            loads.joint[speed] -= elastic + viscous;
            loads.unstretched[speed] -= viscous;
            loads.elastic[speed] = elastic;
            let (work, power) = (elastic * modes.q[k], viscous * modes.v[k]);
            loads.potential += 0.5 * work;
            loads.dissipated += power;
        }
    }
}
