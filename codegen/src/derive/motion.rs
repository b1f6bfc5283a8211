//! Motion of all links at one instant, and of their points.
//! In: poses, twists, accelerations. Out: expressions. Never knows joints.

use crate::expr::{Expr, Mat3, Vec3};

use super::accelerations::accelerations;
use super::geometry::Geometry;
use super::kinematics::{Acceleration, Pose, Poses, Twist, carried_twist};
use super::linkage::{LinkIndex, Linkage};
use super::turned::{Axes, Lever};

/// Kinematics of all links at one instant.
#[derive(Clone)]
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
    /// The same positions and speeds (`v`) with other accelerations.
    pub fn accelerated(&self, v: &[Expr<'g>], v_dot: &[Expr<'g>]) -> Self {
        let Geometry { g, linkage, .. } = self.poses.geometry;
        g.begin_section("accelerations of the links");
        let mut motion = self.clone();
        motion.accelerations = accelerations(&self.poses, &self.twists, (v, v_dot), self.ground);
        for (modes, link) in motion.modes.iter_mut().zip(&linkage.links) {
            if !modes.v_dot.is_empty() {
                modes.v_dot = v_dot[link.speeds()].to_vec();
            }
        }
        motion
    }

    /// The same motion with accelerations of origins made along the given axes.
    pub fn along(&self, axes: Axes) -> Self {
        let mut motion = self.clone();
        if axes.accelerations_in_ground {
            for (acceleration, pose) in motion.accelerations.iter_mut().zip(&self.poses.world) {
                let [ground, own] = acceleration.turned.parts();
                acceleration.origin = own + inwards(pose, ground, self.ground);
            }
        }
        motion
    }

    /// What changes of the speeds' derivatives change of all links' accelerations.
    pub fn changed(&self, v_dot: &[Expr<'g>]) -> Vec<Acceleration<'g>> {
        let Geometry { g, linkage, .. } = self.poses.geometry;
        g.begin_section("accelerations of the links");
        let still = vec![g.zero(); v_dot.len()];
        let twists = vec![Twist::none(g); linkage.links.len()];
        accelerations(&self.poses, &twists, (&still, v_dot), g.zero_vector())
    }

    /// Such changes, made along the given axes.
    pub fn changed_along(&self, mut changes: Vec<Acceleration<'g>>, axes: Axes) -> Vec<Acceleration<'g>> {
        if axes.accelerations_in_ground {
            for (change, pose) in changes.iter_mut().zip(&self.poses.world) {
                let [ground, own] = change.turned.parts();
                change.origin = own + pose.inwards(ground);
            }
        }
        changes
    }

    fn twist(&self, link: LinkIndex) -> Twist<'g> {
        link.map_or_else(|| Twist::none(self.ground.scope()), |at| self.twists[at])
    }

    /// Angular velocity of a link and velocity of a point of it, turned by `rotation`.
    pub fn velocity(&self, link: LinkIndex, point: Vec3<'g>, rotation: Mat3<'g>) -> [Vec3<'g>; 2] {
        let twist = self.twist(link);
        let velocity = twist.at(point);
        [rotation * twist.omega, rotation * velocity]
    }

    /// Angular acceleration of a link and acceleration of a point of it, turned by `rotation`.
    pub fn acceleration(&self, link: LinkIndex, point: Vec3<'g>, rotation: Mat3<'g>) -> [Vec3<'g>; 2] {
        let (alpha, of_point) = match link {
            None => (self.ground.scope().zero_vector(), self.ground),
            Some(at) => (self.accelerations[at].alpha, self.accelerations[at].at(point)),
        };
        [rotation * alpha, rotation * of_point]
    }

    /// Place of a point of a link, along the axes of W and along the link's own: if the `whole` is asked for, all along those
    /// of W. In front of both what is constant along those of W.
    pub fn place(&self, link: LinkIndex, point: Vec3<'g>, whole: bool) -> (Vec3<'g>, [Vec3<'g>; 2]) {
        let zero = self.ground.scope().zero_vector();
        let Some(at) = link else { return if whole { (point, [zero, zero]) } else { (zero, [zero, point]) } };
        let [mount, offset] = self.poses.mount_and_offset(at);
        if !whole {
            return (mount, [offset, point]);
        }
        let carried = self.poses.world[at].rotation * point;
        (mount, [offset + carried, zero])
    }

    /// Velocity of a point of a link in the same two parts.
    pub fn turned_velocity(&self, link: LinkIndex, point: Vec3<'g>, whole: bool) -> [Vec3<'g>; 2] {
        if whole {
            return [self.velocity_in_ground(link, point), self.ground.scope().zero_vector()];
        }
        let twist = self.twist(link);
        twist.turned.plus(twist.omega.cross(point)).parts()
    }

    /// The same of its acceleration, without the ground's.
    pub fn turned_acceleration(&self, link: LinkIndex, point: Vec3<'g>, whole: bool) -> [Vec3<'g>; 2] {
        let Some(at) = link.filter(|_| !whole) else {
            return [self.acceleration_in_ground(link, point), self.ground.scope().zero_vector()];
        };
        let acceleration = &self.accelerations[at];
        acceleration.turned.plus(acceleration.spin * point).parts()
    }

    /// Velocity of a point of a link along the axes of W.
    pub fn velocity_in_ground(&self, link: LinkIndex, point: Vec3<'g>) -> Vec3<'g> {
        let turn = self.poses.world_of(self.ground.scope(), link).rotation;
        let twist = self.twist(link);
        twist.turned.at(turn, &Lever::of_velocity(turn, twist.omega), point).in_ground(turn)
    }

    /// Acceleration of a point of a link along the axes of W, without the ground's.
    pub fn acceleration_in_ground(&self, link: LinkIndex, point: Vec3<'g>) -> Vec3<'g> {
        let Some(at) = link else { return self.ground.scope().zero_vector() };
        let acceleration = &self.accelerations[at];
        let turn = self.poses.world[at].rotation;
        let lever = Lever::of_acceleration(turn, self.twists[at].omega, acceleration.alpha);
        acceleration.turned.at(turn, &lever, point).in_ground(turn)
    }

    /// Angular velocity of a ball link relative to its parent, in the ball link's frame.
    pub fn relative_omega(&self, linkage: &Linkage, at: usize) -> Vec3<'g> {
        let carried = carried_twist(self.twist(linkage.links[at].parent), &self.poses.relative[at]);
        self.twists[at].omega - carried.omega
    }
}

/// Components in a link's frame of two vectors along the axes of W: each by itself where that takes no more, so that what is
/// asked for alone as well is one.
fn inwards<'g>(pose: &Pose<'g>, moved: Vec3<'g>, ground: Vec3<'g>) -> Vec3<'g> {
    if moved.into_iter().zip(ground).all(|(moved, ground)| moved.is_zero() || ground.is_zero()) {
        pose.inwards(moved) + pose.inwards(ground)
    } else {
        pose.inwards(moved + ground)
    }
}
