//! Springs, dampers and actuators on the coordinates of a joint.

use super::ball_damper::BallDamper;
use super::dry_friction::dry_friction;
use crate::derive::element::Element;
use crate::derive::joint_coordinates::JointCoordinates;
use crate::derive::joint_state::JointStates;
use crate::derive::loads::Loads;
use crate::expr::{Expr, Scope};
use crate::id::JointId;
use crate::model::Passive;

/// A force in a joint.
pub struct JointElement<'m> {
    /// The joint.
    pub joint: JointId,
    /// Its law.
    pub passive: &'m Passive,
}

impl<'g> Element<'g> for JointElement<'_> {
    fn add_to(&self, loads: &mut Loads<'g>, g: &'g Scope, state: &JointStates<'g>) {
        let joint = self.joint;
        let is_ball = state.geometry.mechanism.joint(joint).model.is_ball();
        if let (true, Passive::Damping { coefficient, .. }) = (is_ball, self.passive) {
            return BallDamper { joint, coefficient }.add_to(loads, g, state);
        }
        let coordinates = state.coordinates(g, joint);
        let (coordinate, force) = match self.passive {
            Passive::Damping { coordinate, coefficient } => {
                let speed = coordinates.speed[*coordinate];
                let force = state.lower(g, coefficient) * speed;
                loads.dissipated += force * speed;
                (*coordinate, -force)
            }
            Passive::Spring { coordinate, stiffness, rest, preload } => {
                let (stiffness, rest) = (state.lower(g, stiffness), state.lower(g, rest));
                let stretch = coordinates.position[*coordinate] - rest;
                let force = stiffness * stretch;
                let preload = state.lower(g, preload);
                loads.potential += 0.5 * (force * stretch) + preload * stretch;
                (*coordinate, -(force + preload))
            }
            Passive::Actuator { coordinate, force } => {
                let force = state.force_law(g, force);
                loads.supplied += force * coordinates.speed[*coordinate];
                (*coordinate, force)
            }
            Passive::DryFriction(friction) => {
                let speed = coordinates.speed[0];
                let force = dry_friction(g, state, (joint, friction), speed);
                loads.dissipated -= force * speed;
                (0, force)
            }
        };
        push_along(loads, state, (joint, coordinate), &coordinates, force);
    }
}

/// A force along a coordinate of a joint, on the child, with its opposite on the parent.
pub fn push_along<'g>(
    loads: &mut Loads<'g>,
    state: &JointStates<'g>,
    (joint, coordinate): (JointId, usize),
    coordinates: &JointCoordinates<'g>,
    force: Expr<'g>,
) {
    let linkage = state.geometry.linkage;
    if let Some(link) = linkage.link_of_coordinate(joint, coordinate) {
        loads.push_along(linkage.links[link].first_speed, force);
    } else {
        let (moment, direction) = coordinates.duals[coordinate];
        let motion = state.relative_motion(joint);
        loads.pair(joint, &motion, force * moment, force * direction);
    }
}
