//! The mechanism as a tree of links with one frame each, chosen so that the equations stay small.
//! In: what [`super::linkage_build`] found. Out: [`Linkage`]. Never evaluates coordinates; frames are numbers.
//!
//! A joint with several freedoms becomes a chain of links with one motion each; only the last link of
//! the chain carries the body. A link's origin lies on its inboard joint and its e_z on the joint axis
//! (docs/notation.md), so that rotations are two-by-two blocks and many products vanish.

use std::ops::Range;

use crate::id::{BodyId, JointId, PointId};
use crate::model::{Carrier, Closure};

use super::attachment::NodeShape;
use super::frame::Frame;

/// Index of a link; `None` stands for the ground.
pub type LinkIndex = Option<usize>;

/// How a link moves relative to its parent link.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Freedom {
    /// Rotation about e_z by `q + offset`, followed by `advance` [m/rad] times `q` along e_z.
    Rotation {
        /// Angle [rad] between the canonical frame on the parent and this frame at q = 0.
        offset: f64,
        /// Lead / 2 pi [m/rad]; zero for a plain rotation.
        advance: f64,
    },
    /// Translation along an axis, given in this link's frame (parallel to the parent's).
    Translation {
        /// Unit direction.
        axis: [f64; 3],
    },
    /// Free rotation; speed: absolute angular velocity in this frame.
    Ball,
    /// No constraint; speed: absolute twist in this frame. The parent is the ground.
    Free,
    /// Rigidly fixed to the parent.
    Weld,
    /// The floating frame of a flexible body, seen from the node where its inboard joint holds it.
    /// Coordinates and speeds: those of its modes.
    Flexible {
        /// Number of modes.
        modes: usize,
    },
    /// A node of the flexible body that is the parent: moves with that body's modes, has no speeds of its own.
    Node,
}

impl Freedom {
    /// Number of coordinates.
    pub fn coordinates(self) -> usize {
        match self {
            Self::Ball => 4,
            Self::Free => 7,
            _ => self.speeds(),
        }
    }

    /// Angular velocity and velocity relative to the parent per unit of the one speed, in this link's frame; of
    /// joints with one freedom.
    pub fn screw(self) -> Option<[[f64; 3]; 2]> {
        match self {
            Self::Rotation { advance, .. } => Some([[0.0, 0.0, 1.0], [0.0, 0.0, advance]]),
            Self::Translation { axis } => Some([[0.0; 3], axis]),
            _ => None,
        }
    }

    /// Number of speeds.
    pub fn speeds(self) -> usize {
        match self {
            Self::Rotation { .. } | Self::Translation { .. } => 1,
            Self::Ball => 3,
            Self::Free => 6,
            Self::Flexible { modes } => modes,
            Self::Weld | Self::Node => 0,
        }
    }
}

/// One frame of the tree.
#[derive(Clone, Debug)]
pub struct Link {
    /// Name for readers: the body's, or body and joint for links inside a chain.
    pub name: String,
    /// Inboard link.
    pub parent: LinkIndex,
    /// Motion relative to it.
    pub freedom: Freedom,
    /// Constant rotation before the motion: columns are this link's canonical axes in the parent's frame.
    pub mount: Frame,
    /// Columns: axes of this link in W at the reference pose.
    pub frame: Frame,
    /// Joint that the motion belongs to.
    pub joint: JointId,
    /// Which coordinate of that joint, for one-freedom motions.
    pub joint_coordinate: usize,
    /// Body at the end of the chain.
    pub body: BodyId,
    /// Share of the body's mass that this link carries: 0 inside a chain, 1 at its end, less for a body
    /// that is split between two branches (closure `log`).
    pub mass_share: f64,
    /// First of this link's coordinates among all; for a node those of its body's modes.
    pub first_coordinate: usize,
    /// First of this link's speeds among all; for a node those of its body's modes.
    pub first_speed: usize,
    /// Point where this link's origin lies.
    pub origin: PointId,
    /// Of a floating frame: its body's node at the inboard joint. Of a node: its own shapes. Else nothing.
    pub node: Option<NodeShape>,
}

impl Link {
    /// Indices among all speeds that move the link relative to its parent.
    pub fn speeds(&self) -> Range<usize> {
        self.first_speed..self.first_speed + self.modes_or(self.freedom.speeds())
    }

    /// Indices among all coordinates that place the link relative to its parent.
    pub fn coordinates(&self) -> Range<usize> {
        self.first_coordinate..self.first_coordinate + self.modes_or(self.freedom.coordinates())
    }

    fn modes_or(&self, own: usize) -> usize {
        self.node.as_ref().map_or(own, |node| node.displacement.len())
    }
}

/// A node that something is attached to, as a link.
#[derive(Clone, Copy, Debug)]
pub struct NodeLink {
    /// The flexible body.
    pub body: BodyId,
    /// The point at the node.
    pub point: PointId,
    /// Whether the link turns with the body's section at the node, or stays parallel to the floating frame.
    pub turns: bool,
    /// The link.
    pub link: usize,
}

/// A loop closure between two links.
#[derive(Clone, Copy, Debug)]
pub struct Cut {
    /// The joint named by the user.
    pub joint: JointId,
    /// `Joint`: the rows that the joint takes away. `Log`: six rows of a split body.
    pub closure: Closure,
    /// Link of the joint's parent body (for `Log`: the split body on its own branch).
    pub parent: LinkIndex,
    /// Link of the joint's child body (for `Log`: its copy at the cut joint).
    pub child: LinkIndex,
    /// Whether the joint holds a point and both links turn about lines of one direction alone, those of their joints to the
    /// ground and its own: rows are then as simple along the axes of W as along those of the links.
    pub plane: bool,
}

/// All links, parents before children, and all cuts.
#[derive(Clone, Debug)]
pub struct Linkage {
    /// Links in tree order.
    pub links: Vec<Link>,
    /// Loop closures.
    pub cuts: Vec<Cut>,
    /// Whether rows of plane cuts are along the axes of W.
    pub rows_in_ground: bool,
    /// Whether rows of cuts at a ball or free link are along the axes of the other link.
    pub rows_off_balls: bool,
    /// Link that carries each body on its own branch.
    pub link_of_body: Vec<usize>,
    /// Last link of each joint's chain, for joints in the tree.
    pub link_of_joint: Vec<Option<usize>>,
    /// Whether the joint's parent body is outboard of it in the tree.
    pub reversed: Vec<bool>,
    /// Nodes of flexible bodies that move relative to their floating frames.
    pub nodes: Vec<NodeLink>,
}

impl Linkage {
    /// The link that moves with a material point of a body: a node's, if the body is flexible there.
    /// `turns` asks for the orientation of the section at the point too.
    pub fn link_at(&self, carrier: Carrier, point: PointId, turns: bool) -> LinkIndex {
        let Carrier::Body(body) = carrier else { return None };
        let same = |node: &&NodeLink| node.body == body && node.point == point && node.turns == turns;
        self.nodes.iter().find(same).map_or_else(|| self.link(carrier), |node| Some(node.link))
    }

    /// The link that carries a body, on its own branch: its floating frame if it is flexible.
    pub fn link(&self, carrier: Carrier) -> LinkIndex {
        match carrier {
            Carrier::Ground => None,
            Carrier::Body(body) => Some(self.link_of_body[body.index()]),
        }
    }

    /// Axes of a link in W at the reference pose.
    pub fn frame(&self, link: LinkIndex) -> Frame {
        link.map_or(Frame::IDENTITY, |at| self.links[at].frame)
    }

    /// Number of all coordinates, driven ones included.
    pub fn coordinates(&self) -> usize {
        self.links.iter().map(|link| link.freedom.coordinates()).sum()
    }

    /// Number of all speeds, driven ones included.
    pub fn speeds(&self) -> usize {
        self.links.iter().map(|link| link.freedom.speeds()).sum()
    }

    /// Speeds of joints, those of modes left out, by index among all.
    pub fn joint_speeds(&self) -> Vec<usize> {
        let links = self.links.iter().filter(|link| !matches!(link.freedom, Freedom::Flexible { .. }));
        links.flat_map(|link| link.first_speed..link.first_speed + link.freedom.speeds()).collect()
    }

    /// Links from `link` to the root, itself first.
    pub fn path(&self, link: LinkIndex) -> impl Iterator<Item = usize> + '_ {
        std::iter::successors(link, |at| self.links[*at].parent)
    }

    /// Links from `link` to its ancestor `top`, itself first, `top` left out.
    pub fn between(&self, link: LinkIndex, top: LinkIndex) -> impl Iterator<Item = usize> + '_ {
        self.path(link).take_while(move |at| Some(*at) != top)
    }

    /// The last link that the paths of both have in common.
    pub fn common_ancestor(&self, a: LinkIndex, b: LinkIndex) -> LinkIndex {
        let on_a: Vec<usize> = self.path(a).collect();
        self.path(b).find(|link| on_a.contains(link))
    }

    /// The link of a tree joint that turns like a ball.
    pub fn ball_of(&self, joint: JointId) -> Option<usize> {
        let last = self.link_of_joint[joint.index()]?;
        self.path(Some(last))
            .take_while(|at| self.links[*at].joint == joint)
            .find(|at| self.links[*at].freedom == Freedom::Ball)
    }

    /// The link whose motion carries this coordinate of a tree joint.
    pub fn link_of_coordinate(&self, joint: JointId, coordinate: usize) -> Option<usize> {
        let last = self.link_of_joint[joint.index()]?;
        self.path(Some(last))
            .take_while(|at| self.links[*at].joint == joint)
            .find(|at| self.links[*at].joint_coordinate == coordinate)
    }

    /// The link that a coordinate of a tree joint moves.
    #[expect(
        clippy::expect_used,
        reason = "asked of joints in the tree only, which have all their coordinates"
    )]
    pub fn moved_link(&self, joint: JointId, coordinate: usize) -> &Link {
        let link = self.link_of_coordinate(joint, coordinate).expect("a tree joint has its coordinates");
        &self.links[link]
    }
}
