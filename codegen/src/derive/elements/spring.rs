//! Spring and damper between two points.

use crate::derive::element::Element;
use crate::derive::joint_state::JointStates;
use crate::derive::loads::Loads;
use crate::derive::wrench::Wrench;
use crate::expr::Scope;
use crate::model::Spring;

impl<'g> Element<'g> for Spring {
    /// Pull `k (l - rest) + c l̇ + preload` along the line between two points.
    fn add_to(&self, loads: &mut Loads<'g>, g: &'g Scope, state: &JointStates<'g>) {
        let [stiffness, rest, damping, preload] = [&self.stiffness, &self.rest, &self.damping, &self.preload]
            .map(|formula| state.lower(g, formula));
        let (geometry, motion) = (&state.geometry, &state.motion);
        let links = [0, 1].map(|i| geometry.linkage.link_at(self.bodies[i], self.at[i], false));
        let points = [0, 1].map(|i| geometry.local(links[i], self.at[i]));
        let places = [0, 1].map(|i| motion.poses.position(links[i], points[i]));
        let velocities = [0, 1].map(|i| motion.point_velocity_w(links[i], points[i]));
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
}
