//! Motion of all links at one instant, and of their points.
//! In: poses, twists, accelerations. Out: expressions. Never knows joints.

use crate::expr::{Expr, Mat3, Scope, Vec3};

use super::kinematics::{Acceleration, Poses, Twist, carried_twist, point_acceleration, point_velocity};
use super::linkage::{LinkIndex, Linkage};

/// Kinematics of all links at one instant.
pub struct Motion<'g> {
    /// Poses.
    pub poses: Poses<'g>,
    /// Twists.
    pub twists: Vec<Twist<'g>>,
    /// Accelerations, gravity included (the ground accelerates by minus gravity).
    pub accelerations: Vec<Acceleration<'g>>,
    /// Acceleration of the ground [m/s²].
    pub ground: Vec3<'g>,
    /// Modal coordinates, speeds and accelerations of every link; empty unless it is a floating frame.
    pub modes: Vec<ModalState<'g>>,
}

/// Modal coordinates of a flexible body with their derivatives.
#[derive(Clone, Debug, Default)]
pub struct ModalState<'g> {
    /// Coordinates.
    pub q: Vec<Expr<'g>>,
    /// Speeds.
    pub v: Vec<Expr<'g>>,
    /// Accelerations.
    pub v_dot: Vec<Expr<'g>>,
}

impl<'g> Motion<'g> {
    /// Angular velocity of a link and velocity of a point of it, turned by `rotation`.
    pub fn velocity(
        &self,
        g: &'g Scope,
        link: LinkIndex,
        point: Vec3<'g>,
        rotation: Mat3<'g>,
    ) -> [Vec3<'g>; 2] {
        match link {
            None => [g.zero_vector(); 2],
            Some(at) => {
                let velocity = point_velocity(g, &self.twists[at], point);
                [self.twists[at].omega, velocity].map(|v| g.mul_vec3(rotation, v))
            }
        }
    }

    /// Angular acceleration of a link and acceleration of a point of it, turned by `rotation`.
    pub fn acceleration(
        &self,
        g: &'g Scope,
        link: LinkIndex,
        point: Vec3<'g>,
        rotation: Mat3<'g>,
    ) -> [Vec3<'g>; 2] {
        let (alpha, origin) = match link {
            None => (g.zero_vector(), self.ground),
            Some(at) => {
                let acceleration = &self.accelerations[at];
                (acceleration.alpha, point_acceleration(g, acceleration, point))
            }
        };
        [alpha, origin].map(|v| g.mul_vec3(rotation, v))
    }

    /// Velocity in W of a point of a link.
    pub fn point_velocity_w(&self, g: &'g Scope, link: LinkIndex, point: Vec3<'g>) -> Vec3<'g> {
        let rotation = self.poses.world_of(g, link).rotation;
        self.velocity(g, link, point, rotation)[1]
    }

    /// Angular velocity of a ball link relative to its parent, in the ball link's frame.
    pub fn relative_omega(&self, g: &'g Scope, linkage: &Linkage, at: usize) -> Vec3<'g> {
        let parent = linkage.links[at].parent.map(|p| self.twists[p]);
        let carried = carried_twist(g, parent, &self.poses.relative[at]);
        g.sub3(self.twists[at].omega, carried.omega)
    }
}
