//! Relative motion of any two frames that are fixed to links, seen from one of the links.
//! In: motion of the links. Out: [`RelativeMotion`]. Never knows joints and elements.

use crate::expr::{Mat3, Vec3};

use super::frame::Frame;
use super::geometry::Geometry;
use super::kinematics::Poses;
use super::linkage::{Freedom, LinkIndex, Linkage};
use super::motion::Motion;
use super::wrench::Wrench;

/// A frame that is fixed to a link.
#[derive(Clone, Copy, Debug)]
pub struct Marker<'g> {
    /// The link; nothing for the ground.
    pub link: LinkIndex,
    /// The marker's origin in the link's frame [m].
    pub point: Vec3<'g>,
    /// Columns: the marker's axes in the link's frame.
    pub frame: Frame,
}

/// At which of the two origins both links are looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Each at its own: right where nothing moves the origins apart.
    Own,
    /// Both where the child's is.
    Child,
    /// Both where the parent's is.
    Parent,
}

/// Whose axes vectors are along.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Those of the parent's link.
    Parent,
    /// Those of the child's link.
    Child,
    /// Those of W.
    Ground,
}

/// Along whose axes distance, velocity and acceleration are summed up before they are turned to the common ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Sums {
    /// From link to link.
    Links,
    /// Those of W: turned once. Where branches part outboard of a link, what they share would be there twice: from link to
    /// link there.
    Ground,
    /// Those of W, each branch turned by itself: what it has alone may be wanted elsewhere.
    Apart,
}

/// Motion of one marker, the child, relative to another, the parent; all in the frame of [`Self::beside`].
pub struct RelativeMotion<'g> {
    /// The parent, its origin moved to the chosen place.
    pub parent: Marker<'g>,
    /// The child, its origin moved to the chosen place.
    pub child: Marker<'g>,
    /// Along whose axes vectors are.
    pub side: Side,
    /// Takes components in the frame of the parent's link to the common frame.
    pub from_parent: Mat3<'g>,
    /// Takes components in the frame of the child's link to the common frame.
    pub from_child: Mat3<'g>,
    /// Child's origin from the parent's [m].
    pub distance: Vec3<'g>,
    /// Angular velocity of the child relative to the parent.
    pub omega: Vec3<'g>,
    /// Velocity of the child at the chosen place relative to the parent there.
    pub slide: Vec3<'g>,
    /// Angular velocity of the parent.
    pub parent_omega: Vec3<'g>,
    /// Angular velocity of the child.
    pub child_omega: Vec3<'g>,
    /// Angular acceleration of the child minus that of the parent.
    pub alpha: Vec3<'g>,
    /// Acceleration of the child at the chosen place minus that of the parent there.
    pub acceleration: Vec3<'g>,
}

/// Whether the frame of the child's link makes more Jacobian columns constant than that of the parent's: that of a
/// ball or free link does best, then that of a moving link. `off_balls`: they shall be along the axes of the other link.
pub fn seen_from_child(linkage: &Linkage, [parent, child]: [LinkIndex; 2], off_balls: bool) -> bool {
    fn rank(linkage: &Linkage, link: LinkIndex, ball: usize) -> usize {
        let Some(at) = link else { return 0 };
        let link = &linkage.links[at];
        match link.freedom {
            Freedom::Ball | Freedom::Free => ball,
            // Parallel to the link that carries it.
            Freedom::Flexible { .. } | Freedom::Node
                if link.mount == Frame::IDENTITY
                    && link.node.as_ref().is_none_or(|node| node.rotation.is_empty()) =>
            {
                rank(linkage, link.parent, ball)
            }
            _ => 1,
        }
    }
    let ball = if off_balls { 0 } else { 2 };
    rank(linkage, child, ball) >= rank(linkage, parent, ball)
}

impl<'g> RelativeMotion<'g> {
    /// Computes everything for two markers.
    pub fn between(
        motion: &Motion<'g>,
        [mut parent, mut child]: [Marker<'g>; 2],
        side: Side,
        (place, sums): (Place, Sums),
    ) -> Self {
        let beside = match side {
            Side::Parent => parent.link,
            Side::Child => child.link,
            Side::Ground => None,
        };
        let [from_parent, from_child] =
            [parent.link, child.link].map(|link| motion.poses.rotation_between(link, beside));
        let apart = motion.poses.geometry.linkage.common_ancestor(parent.link, child.link).is_none();
        let in_ground = side == Side::Ground || (sums != Sums::Links && apart);
        let turn = motion.poses.world_of(motion.poses.geometry.g, beside).rotation;
        let turned = Turning { turn, side, apart: sums == Sums::Apart };
        let distance = if in_ground {
            turned.place([&parent, &child], |marker, whole| motion.place(marker.link, marker.point, whole))
        } else {
            distance(&motion.poses, [&parent, &child], beside)
        };
        match place {
            Place::Own => {}
            Place::Child => parent.point += from_parent.transpose() * distance,
            Place::Parent => child.point -= from_child.transpose() * distance,
        }
        let [parent_omega, parent_velocity] = motion.velocity(parent.link, parent.point, from_parent);
        let [child_omega, child_velocity] = motion.velocity(child.link, child.point, from_child);
        let [parent_alpha, parent_acceleration] = motion.acceleration(parent.link, parent.point, from_parent);
        let [child_alpha, child_acceleration] = motion.acceleration(child.link, child.point, from_child);
        let (mut slide, mut acceleration) =
            (child_velocity - parent_velocity, child_acceleration - parent_acceleration);
        if in_ground {
            let ends = [&parent, &child];
            slide = turned
                .difference(ends, |marker, whole| motion.turned_velocity(marker.link, marker.point, whole));
            acceleration = turned.difference(ends, |marker, whole| {
                motion.turned_acceleration(marker.link, marker.point, whole)
            });
        }
        Self {
            parent,
            child,
            side,
            from_parent,
            from_child,
            distance,
            omega: child_omega - parent_omega,
            slide,
            parent_omega,
            child_omega,
            alpha: child_alpha - parent_alpha,
            acceleration,
        }
    }

    /// The link whose frame is used.
    pub fn beside(&self) -> LinkIndex {
        match self.side {
            Side::Parent => self.parent.link,
            Side::Child => self.child.link,
            Side::Ground => None,
        }
    }

    /// Axis of the parent in the common frame.
    pub fn parent_axis(&self, j: usize) -> Vec3<'g> {
        self.from_parent * self.distance[0].scope().vector(self.parent.frame.axis(j))
    }

    /// Axis of the child in the common frame.
    pub fn child_axis(&self, j: usize) -> Vec3<'g> {
        self.from_child * self.distance[0].scope().vector(self.child.frame.axis(j))
    }

    /// Rotation of the child relative to the parent: takes components along the child's axes to the parent's.
    pub fn rotation(&self) -> Mat3<'g> {
        let parent = [0, 1, 2].map(|j| self.parent_axis(j));
        let child = [0, 1, 2].map(|j| self.child_axis(j));
        Mat3::from_fn(|i, j| parent[i].dot(child[j]))
    }

    /// Wrenches on the parent's link and on the child's, in their own frames about their origins, of a wrench
    /// (moment, force) on the child at the chosen place, given in the common frame, and of its opposite.
    pub fn link_wrenches(&self, moment: Vec3<'g>, force: Vec3<'g>) -> [Wrench<'g>; 2] {
        let side = |rotation: Mat3<'g>, point: Vec3<'g>| {
            let force = rotation.transpose() * force;
            Wrench { moment: rotation.transpose() * moment + point.cross(force), force }
        };
        let child = side(self.from_child, self.child.point);
        let parent = side(self.from_parent, self.parent.point);
        [-parent, child]
    }
}

/// How a difference is turned from the axes of W to those of one side.
struct Turning<'g> {
    /// Takes components along the axes of that side to those of W.
    turn: Mat3<'g>,
    side: Side,
    /// Each end by itself.
    apart: bool,
}

impl<'g> Turning<'g> {
    /// Of the child's minus that of the parent. `of` gives what is along the axes of W and what is along the link's own: all
    /// of it along those of W where the whole is asked for.
    fn difference(
        &self,
        ends: [&Marker<'g>; 2],
        of: impl Fn(&Marker<'g>, bool) -> [Vec3<'g>; 2],
    ) -> Vec3<'g> {
        let none = self.turn[0][0].scope().zero_vector();
        self.place(ends, |marker, whole| (none, of(marker, whole)))
    }

    /// The same of what is constant in part, which is subtracted first: a mechanism that is drawn a kilometre off keeps the
    /// digits of its loops.
    fn place(
        &self,
        [parent, child]: [&Marker<'g>; 2],
        of: impl Fn(&Marker<'g>, bool) -> (Vec3<'g>, [Vec3<'g>; 2]),
    ) -> Vec3<'g> {
        let [(parent_mount, parent), (child_mount, child)] = [(parent, Side::Parent), (child, Side::Child)]
            .map(|(marker, side)| of(marker, side != self.side));
        let mounts = child_mount - parent_mount;
        let inwards = self.turn.transpose();
        let apart = if self.apart {
            inwards * mounts + (inwards * child[0] - inwards * parent[0])
        } else {
            inwards * (mounts + (child[0] - parent[0]))
        };
        match self.side {
            Side::Parent => apart - parent[1],
            Side::Child => apart + child[1],
            Side::Ground => apart,
        }
    }
}

/// From the parent's origin to the child's, in the frame of `beside`, along the tree from the common ancestor, so
/// that motion that both share cancels.
///
/// What is constant there is subtracted first, as in [`Turning::place`].
fn distance<'g>(poses: &Poses<'g>, [parent, child]: [&Marker<'g>; 2], beside: LinkIndex) -> Vec3<'g> {
    let Geometry { g, linkage, .. } = poses.geometry;
    let top = linkage.common_ancestor(parent.link, child.link);
    let place = |marker: &Marker<'g>| {
        let path = linkage.between(marker.link, top);
        path.fold((marker.point, g.zero_vector()), |(mount, moved), at| {
            let carried = poses.relative[at].rotation * (mount + moved);
            (poses.mounts[at], poses.moved[at] + carried)
        })
    };
    let ((child_mount, child_moved), (parent_mount, parent_moved)) = (place(child), place(parent));
    let mounts = child_mount - parent_mount;
    let apart = mounts + (child_moved - parent_moved);
    poses.rotation_between(top, beside) * apart
}
