//! Relative motion of two links across a joint, seen from one of them.
//! In: link kinematics. Out: [`Across`]. Never knows which rows a closure keeps.

use crate::expr::{Mat3, Scope, Vec3};
use crate::id::JointId;
use crate::model::{Axis, Carrier};

use super::frame::{Frame, canonical_frame};
use super::geometry::Geometry;
use super::kinematics::Poses;
use super::linkage::{Freedom, LinkIndex, Linkage};
use super::motion::Motion;

/// The two links of a joint and which of them lends its frame.
#[derive(Clone, Copy, Debug)]
pub struct Sides {
    /// The joint.
    pub joint: JointId,
    /// Link of the joint's parent body.
    pub parent: LinkIndex,
    /// Link of the joint's child body.
    pub child: LinkIndex,
    /// Whether vectors are expressed in the child's frame (else in the parent's).
    pub in_child: bool,
}

impl Sides {
    /// Chooses the frame that makes most Jacobian columns constant: that of a ball or free link, else of
    /// the moving side, else of the child.
    #[must_use]
    pub fn choose(linkage: &Linkage, joint: JointId, parent: LinkIndex, child: LinkIndex) -> Self {
        fn rank(linkage: &Linkage, link: LinkIndex) -> usize {
            let Some(at) = link else { return 0 };
            let own = &linkage.links[at];
            match own.freedom {
                Freedom::Ball | Freedom::Free => 2,
                // Parallel to the link that carries it.
                Freedom::Flexible { .. } | Freedom::Node
                    if own.mount == Frame::IDENTITY
                        && own.node.as_ref().is_none_or(|node| node.rotation.is_empty()) =>
                {
                    rank(linkage, own.parent)
                }
                _ => 1,
            }
        }
        let rank = |link: LinkIndex| rank(linkage, link);
        Self { joint, parent, child, in_child: rank(child) >= rank(parent) }
    }

    /// The link whose frame is used.
    #[must_use]
    pub fn beside(&self) -> LinkIndex {
        if self.in_child { self.child } else { self.parent }
    }
}

/// Constant axes of a joint in the frames of its two links; they coincide when all coordinates are zero.
#[derive(Clone, Copy, Debug)]
pub struct JointAxes {
    /// In the parent link's frame.
    pub parent: Frame,
    /// In the child link's frame.
    pub child: Frame,
}

/// At which of the two joint points both bodies are looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Each at its own joint point: right where the joint leaves no translation and the loop is closed.
    Own,
    /// Both where the child's joint point is.
    Child,
    /// Both where the parent's joint point is.
    Parent,
}

/// Relative motion, all in the frame of [`Sides::beside`].
pub struct Across<'g> {
    /// Takes components in the parent's frame to the common frame.
    pub from_parent: Mat3<'g>,
    /// Takes components in the child's frame to the common frame.
    pub from_child: Mat3<'g>,
    /// Child's joint point from the parent's [m].
    pub distance: Vec3<'g>,
    /// The chosen place as a point of the child, in its frame [m].
    pub child_point: Vec3<'g>,
    /// The chosen place as a point of the parent, in its frame [m].
    pub parent_point: Vec3<'g>,
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

impl<'g> Across<'g> {
    /// Computes everything for the joint between two links.
    pub fn new(
        g: &'g Scope,
        geometry: &Geometry<'g>,
        motion: &Motion<'g>,
        sides: Sides,
        place: Place,
    ) -> Self {
        let linkage = geometry.linkage;
        let at = geometry.mechanism.joint(sides.joint).at;
        let mut child_point = geometry.local(sides.child, at);
        let mut parent_point = geometry.local(sides.parent, at);
        let identity = g.matrix(Frame::IDENTITY.0);
        let (from_parent, from_child) = if sides.in_child {
            (motion.poses.rotation_between(g, linkage, sides.parent, sides.child), identity)
        } else {
            (identity, motion.poses.rotation_between(g, linkage, sides.child, sides.parent))
        };
        let distance = distance(g, linkage, &motion.poses, sides, child_point, parent_point);
        match place {
            Place::Own => {}
            Place::Child => {
                let arm = g.transpose_mul_vec3(from_parent, distance);
                parent_point = g.add3(parent_point, arm);
            }
            Place::Parent => {
                let arm = g.transpose_mul_vec3(from_child, distance);
                child_point = g.sub3(child_point, arm);
            }
        }
        let [parent_omega, parent_velocity] = motion.velocity(sides.parent, parent_point, from_parent);
        let [child_omega, child_velocity] = motion.velocity(sides.child, child_point, from_child);
        let [parent_alpha, parent_acceleration] =
            motion.acceleration(sides.parent, parent_point, from_parent);
        let [child_alpha, child_acceleration] = motion.acceleration(sides.child, child_point, from_child);
        Self {
            from_parent,
            from_child,
            distance,
            child_point,
            parent_point,
            omega: g.sub3(child_omega, parent_omega),
            slide: g.sub3(child_velocity, parent_velocity),
            parent_omega,
            child_omega,
            alpha: g.sub3(child_alpha, parent_alpha),
            acceleration: g.sub3(child_acceleration, parent_acceleration),
        }
    }

    /// Constant axis of the parent in the common frame.
    pub fn parent_axis(&self, g: &'g Scope, axes: &JointAxes, j: usize) -> Vec3<'g> {
        let axis = g.vector(axes.parent.axis(j));
        g.mul_vec3(self.from_parent, axis)
    }

    /// Constant axis of the child in the common frame.
    pub fn child_axis(&self, g: &'g Scope, axes: &JointAxes, j: usize) -> Vec3<'g> {
        let axis = g.vector(axes.child.axis(j));
        g.mul_vec3(self.from_child, axis)
    }

    /// Rotation of the child relative to the parent in joint axes: identity when all coordinates are zero.
    pub fn rotation(&self, g: &'g Scope, axes: &JointAxes) -> Mat3<'g> {
        let parent = [0, 1, 2].map(|j| self.parent_axis(g, axes, j));
        let child = [0, 1, 2].map(|j| self.child_axis(g, axes, j));
        Mat3::from_fn(|i, j| parent[i].dot(child[j]))
    }
}

/// From the parent's joint point to the child's, in the common frame, along the tree from the common
/// ancestor, so that motion that both share cancels.
fn distance<'g>(
    g: &'g Scope,
    linkage: &Linkage,
    poses: &Poses<'g>,
    sides: Sides,
    child_point: Vec3<'g>,
    parent_point: Vec3<'g>,
) -> Vec3<'g> {
    let top = linkage.common_ancestor(sides.parent, sides.child);
    let place = |link: LinkIndex, point: Vec3<'g>| {
        let (mut at, mut place) = (link, point);
        while at != top {
            let inner = at.expect("the ancestor lies on the path to the ground");
            let pose = poses.relative[inner];
            let turned = g.mul_vec3(pose.rotation, place);
            place = g.add3(pose.offset, turned);
            at = linkage.links[inner].parent;
        }
        place
    };
    let (child, parent) = (place(sides.child, child_point), place(sides.parent, parent_point));
    let apart = g.sub3(child, parent);
    let rotation = poses.rotation_between(g, linkage, top, sides.beside());
    g.mul_vec3(rotation, apart)
}

/// Axes of a joint in the frames of its links; `in_child` says which frame should see simple numbers.
#[must_use]
pub fn joint_axes<'g>(geometry: &Geometry<'g>, sides: Sides) -> JointAxes {
    let linkage = geometry.linkage;
    let frame = |link: LinkIndex| link.map_or(Frame::IDENTITY, |at| linkage.links[at].frame);
    let (parent, child) = (frame(sides.parent), frame(sides.child));
    let (outer_parent, outer_child) = match geometry.mechanism.joint(sides.joint).model.axes[..] {
        [] => {
            let own = if sides.in_child { child } else { parent };
            (own, own)
        }
        [axis] => both(axis, &parent, &child, sides.in_child),
        [axis, second, ..] => {
            let own = Frame::with_z_and_x(axis.parent, second.parent);
            (own, Frame::between(axis.parent, axis.child).times(&own))
        }
    };
    JointAxes {
        parent: parent.transposed().times(&outer_parent).snapped(),
        child: child.transposed().times(&outer_child).snapped(),
    }
}

/// Axes of a body that two branches reach: its copy's frame, and that frame seen from its own branch.
#[must_use]
pub fn weld_axes<'g>(geometry: &Geometry<'g>, sides: Sides) -> JointAxes {
    let frame = |link: LinkIndex| link.map_or(Frame::IDENTITY, |at| geometry.linkage.links[at].frame);
    let (own, copy) = (frame(sides.parent), frame(sides.child));
    JointAxes { parent: own.transposed().times(&copy).snapped(), child: Frame::IDENTITY }
}

/// A frame with e_z on the axis, simple in the frame of the chosen side, and its image on the other.
fn both(axis: Axis, parent: &Frame, child: &Frame, in_child: bool) -> (Frame, Frame) {
    let simple = |own: &Frame, direction: [f64; 3]| {
        own.times(&canonical_frame(own.local(direction), |_| None).0).snapped()
    };
    if in_child {
        let own = simple(child, axis.child);
        (Frame::between(axis.child, axis.parent).times(&own), own)
    } else {
        let own = simple(parent, axis.parent);
        (own, Frame::between(axis.parent, axis.child).times(&own))
    }
}

/// The link of a joint's parent or child body, as the joint sees it (through its copy for closure `log`).
#[must_use]
pub fn sides_of<'g>(geometry: &Geometry<'g>, joint: JointId) -> Sides {
    let linkage = geometry.linkage;
    let data = geometry.mechanism.joint(joint);
    let turns = !data.model.turns_freely();
    let mut parent = linkage.link_at(data.parent, data.at, turns);
    let mut child = linkage.link_at(data.child, data.at, turns);
    if let Some(last) = linkage.link_of_joint[joint.index()] {
        // The chain's end is the outboard body, which may be a copy of it on this branch.
        if linkage.reversed[joint.index()] { parent = Some(last) } else { child = Some(last) }
    }
    debug_assert!(data.parent != Carrier::Ground || parent.is_none());
    Sides::choose(linkage, joint, parent, child)
}
