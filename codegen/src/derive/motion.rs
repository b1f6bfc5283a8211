//! Motion of all links at one instant, and of their points.
//! In: poses, twists, accelerations. Out: expressions. Never knows joints.

use crate::expr::{Expr, Mat3, Vec3};

use super::kinematics::{Acceleration, Poses, Twist, carried_twist};
use super::linkage::{LinkIndex, Linkage};

/// Kinematics of all links at one instant.
pub struct Motion<'g> {
    pub poses: Poses<'g>,
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
    pub q: Vec<Expr<'g>>,
    pub v: Vec<Expr<'g>>,
    pub v_dot: Vec<Expr<'g>>,
}

impl<'g> Motion<'g> {
    fn twist(&self, link: LinkIndex) -> Twist<'g> {
        link.map_or_else(|| Twist::none(self.ground.scope()), |at| self.twists[at])
    }

    /// Angular velocity of a link and velocity of a point of it, turned by `rotation`.
    pub fn velocity(&self, link: LinkIndex, point: Vec3<'g>, rotation: Mat3<'g>) -> [Vec3<'g>; 2] {
        let twist = self.twist(link);
        let velocity = twist.at(point);
        [twist.omega, velocity].map(|v| rotation * v)
    }

    /// Angular acceleration of a link and acceleration of a point of it, turned by `rotation`.
    pub fn acceleration(&self, link: LinkIndex, point: Vec3<'g>, rotation: Mat3<'g>) -> [Vec3<'g>; 2] {
        let (alpha, of_point) = match link {
            None => (self.ground.scope().zero_vector(), self.ground),
            Some(at) => (self.accelerations[at].alpha, self.accelerations[at].at(point)),
        };
        [alpha, of_point].map(|v| rotation * v)
    }

    /// Velocity in W of a point of a link.
    pub fn point_velocity_w(&self, link: LinkIndex, point: Vec3<'g>) -> Vec3<'g> {
        let rotation = self.poses.world_of(self.ground.scope(), link).rotation;
        self.velocity(link, point, rotation)[1]
    }

    /// Angular velocity of a ball link relative to its parent, in the ball link's frame.
    pub fn relative_omega(&self, linkage: &Linkage, at: usize) -> Vec3<'g> {
        let carried = carried_twist(self.twist(linkage.links[at].parent), &self.poses.relative[at]);
        self.twists[at].omega - carried.omega
    }
}
