//! The mechanism as a tree of links with one frame each, chosen so that the equations stay small.
//! In: [`Mechanism`], [`Topology`]. Out: [`Linkage`]. Never evaluates coordinates; frames are numbers.
//!
//! A joint with several freedoms becomes a chain of links with one motion each; only the last link of
//! the chain carries the body. A link's origin lies on its inboard joint and its e_z on the joint axis
//! (docs/notation.md), so that rotations are two-by-two blocks and many products vanish.

use crate::id::{BodyId, JointId};
use crate::model::{Axis, Carrier, Closure, JointKind, Mechanism, Topology, TreeJoint};

use super::frame::{Frame, canonical_frame, cross, dot, reduce};

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
}

impl Freedom {
    /// Number of coordinates.
    #[must_use]
    pub fn coordinates(self) -> usize {
        match self {
            Self::Rotation { .. } | Self::Translation { .. } => 1,
            Self::Ball => 4,
            Self::Free => 7,
            Self::Weld => 0,
        }
    }

    /// Number of speeds.
    #[must_use]
    pub fn speeds(self) -> usize {
        match self {
            Self::Rotation { .. } | Self::Translation { .. } => 1,
            Self::Ball => 3,
            Self::Free => 6,
            Self::Weld => 0,
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
    /// First of this link's coordinates among all.
    pub first_coordinate: usize,
    /// First of this link's speeds among all.
    pub first_speed: usize,
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
}

/// All links, parents before children, and all cuts.
#[derive(Clone, Debug)]
pub struct Linkage {
    /// Links in tree order.
    pub links: Vec<Link>,
    /// Loop closures.
    pub cuts: Vec<Cut>,
    /// Link that carries each body on its own branch.
    pub link_of_body: Vec<usize>,
    /// Last link of each joint's chain, for joints in the tree.
    pub link_of_joint: Vec<Option<usize>>,
    /// Whether the joint's parent body is outboard of it in the tree.
    pub reversed: Vec<bool>,
}

impl Linkage {
    /// The link that carries a body, on its own branch.
    #[must_use]
    pub fn link(&self, carrier: Carrier) -> LinkIndex {
        match carrier {
            Carrier::Ground => None,
            Carrier::Body(body) => Some(self.link_of_body[body.index()]),
        }
    }

    /// Number of all coordinates, driven ones included.
    #[must_use]
    pub fn coordinates(&self) -> usize {
        self.links.iter().map(|link| link.freedom.coordinates()).sum()
    }

    /// Number of all speeds, driven ones included.
    #[must_use]
    pub fn speeds(&self) -> usize {
        self.links.iter().map(|link| link.freedom.speeds()).sum()
    }

    /// Links from `link` to the root, itself first.
    pub fn path(&self, link: LinkIndex) -> impl Iterator<Item = usize> + '_ {
        std::iter::successors(link, |at| self.links[*at].parent)
    }

    /// The last link that the paths of both have in common.
    #[must_use]
    pub fn common_ancestor(&self, a: LinkIndex, b: LinkIndex) -> LinkIndex {
        let on_a: Vec<usize> = self.path(a).collect();
        self.path(b).find(|link| on_a.contains(link))
    }

    /// The link whose motion carries this coordinate of a tree joint.
    #[must_use]
    pub fn link_of_coordinate(&self, joint: JointId, coordinate: usize) -> Option<usize> {
        let last = self.link_of_joint[joint.index()]?;
        self.path(Some(last))
            .take_while(|at| self.links[*at].joint == joint)
            .find(|at| self.links[*at].joint_coordinate == coordinate)
    }
}

/// Builds the tree of links. `parameters` are the default values, which only steer the choice of frames.
#[must_use]
pub fn linkage(mechanism: &Mechanism, topology: &Topology, parameters: &[f64]) -> Linkage {
    let mut builder = Builder {
        mechanism,
        topology,
        parameters,
        linkage: Linkage {
            links: Vec::new(),
            cuts: Vec::new(),
            link_of_body: vec![usize::MAX; mechanism.bodies.len()],
            link_of_joint: vec![None; mechanism.joints.len()],
            reversed: vec![false; mechanism.joints.len()],
        },
    };
    for step in &topology.tree {
        let inboard = builder.linkage.link(step.inboard);
        let last = builder.chain(*step, inboard);
        builder.linkage.link_of_body[step.outboard.index()] = last;
        builder.linkage.link_of_joint[step.joint.index()] = Some(last);
        builder.linkage.reversed[step.joint.index()] = step.reversed;
    }
    for cut in &topology.cuts {
        builder.close(*cut);
    }
    builder.share_masses();
    builder.linkage
}

struct Builder<'a> {
    mechanism: &'a Mechanism,
    topology: &'a Topology,
    parameters: &'a [f64],
    linkage: Linkage,
}

/// Rotation in W from the inboard to the outboard description of a joint's first axis (the smallest one).
fn joint_turn(kind: &JointKind, reversed: bool) -> Frame {
    let axis = match kind {
        JointKind::Revolute(axis)
        | JointKind::Prismatic(axis)
        | JointKind::Cylindrical(axis)
        | JointKind::Screw(axis, _)
        | JointKind::Universal(axis, _)
        | JointKind::Planar { normal: axis, .. } => axis,
        JointKind::Spherical | JointKind::Fixed | JointKind::Free => return Frame::IDENTITY,
    };
    if reversed { Frame::between(axis.child, axis.parent) } else { Frame::between(axis.parent, axis.child) }
}

/// An elementary motion of a joint: about or along a direction in W at the reference pose.
enum Motion {
    Turn([f64; 3], f64),
    Slide([f64; 3]),
}

impl Builder<'_> {
    /// Adds the links of one joint and returns the last.
    fn chain(&mut self, step: TreeJoint, inboard: LinkIndex) -> usize {
        let kind = self.mechanism.joint(step.joint).kind.clone();
        let inner = |axis: Axis| if step.reversed { axis.child } else { axis.parent };
        let mut motions: Vec<(usize, Motion)> = match kind {
            JointKind::Revolute(axis) => vec![(0, Motion::Turn(inner(axis), 0.0))],
            JointKind::Prismatic(axis) => vec![(0, Motion::Slide(inner(axis)))],
            JointKind::Cylindrical(axis) => {
                vec![(0, Motion::Turn(inner(axis), 0.0)), (1, Motion::Slide(inner(axis)))]
            }
            JointKind::Screw(axis, lead) => {
                vec![(0, Motion::Turn(inner(axis), lead / std::f64::consts::TAU))]
            }
            JointKind::Universal(first, second) => {
                vec![(0, Motion::Turn(inner(first), 0.0)), (1, Motion::Turn(inner(second), 0.0))]
            }
            JointKind::Planar { normal, first } => {
                let second = cross(inner(normal), inner(first));
                vec![
                    (0, Motion::Slide(inner(first))),
                    (1, Motion::Slide(second)),
                    (2, Motion::Turn(inner(normal), 0.0)),
                ]
            }
            JointKind::Fixed => return self.single(step, inboard, Freedom::Weld),
            JointKind::Spherical => return self.single(step, inboard, Freedom::Ball),
            JointKind::Free => return self.single(step, None, Freedom::Free),
        };
        // Seen from the other side, the joint runs backwards: opposite axes in opposite order.
        if step.reversed {
            motions.reverse();
        }
        let sign = if step.reversed { -1.0 } else { 1.0 };
        let mut parent = inboard;
        for (coordinate, motion) in motions {
            parent = Some(match motion {
                Motion::Turn(axis, advance) => {
                    self.turn(step, parent, coordinate, axis.map(|x| sign * x), advance)
                }
                Motion::Slide(axis) => self.slide(step, parent, coordinate, axis.map(|x| sign * x)),
            });
        }
        let last = parent.expect("every moving joint has at least one motion");
        // Where the branches are described open, the body's own description sees other axes.
        let turn = joint_turn(&kind, step.reversed);
        let frame = self.linkage.links[last].frame;
        self.linkage.links[last].frame = turn.times(&frame).snapped();
        last
    }

    fn parent_frame(&self, parent: LinkIndex) -> Frame {
        parent.map_or(Frame::IDENTITY, |at| self.linkage.links[at].frame)
    }

    fn turn(
        &mut self,
        step: TreeJoint,
        parent: LinkIndex,
        coordinate: usize,
        axis: [f64; 3],
        advance: f64,
    ) -> usize {
        let outer = self.parent_frame(parent);
        let (mount, offset) =
            canonical_frame(outer.local(axis), |_| self.target(step).map(|direction| outer.local(direction)));
        let frame = outer.times(&mount).times(&Frame::about_z(offset)).snapped();
        self.push(step, parent, coordinate, Freedom::Rotation { offset, advance }, mount, frame)
    }

    fn slide(&mut self, step: TreeJoint, parent: LinkIndex, coordinate: usize, axis: [f64; 3]) -> usize {
        let frame = self.parent_frame(parent);
        let axis = reduce(frame.local(axis));
        self.push(step, parent, coordinate, Freedom::Translation { axis }, Frame::IDENTITY, frame)
    }

    /// A chain of one link whose orientation is free to choose (ball, free) or the parent's (weld).
    fn single(&mut self, step: TreeJoint, parent: LinkIndex, freedom: Freedom) -> usize {
        let outer = self.parent_frame(parent);
        let frame = match freedom {
            Freedom::Weld => outer,
            _ => self.target(step).map_or(Frame::IDENTITY, Frame::with_x_along),
        };
        self.push(step, parent, 0, freedom, Frame::IDENTITY, frame)
    }

    fn push(
        &mut self,
        step: TreeJoint,
        parent: LinkIndex,
        joint_coordinate: usize,
        freedom: Freedom,
        mount: Frame,
        frame: Frame,
    ) -> usize {
        let (first_coordinate, first_speed) = (self.linkage.coordinates(), self.linkage.speeds());
        self.linkage.links.push(Link {
            name: self.mechanism.body(step.outboard).name.clone(),
            parent,
            freedom,
            mount,
            frame,
            joint: step.joint,
            joint_coordinate,
            body: step.outboard,
            mass_share: 0.0,
            first_coordinate,
            first_speed,
        });
        self.linkage.links.len() - 1
    }

    /// Direction from the inboard joint to the place that matters most on the body: another joint, the
    /// far end of a rod, or the centre of mass. W, at the reference pose.
    fn target(&self, step: TreeJoint) -> Option<[f64; 3]> {
        let carrier = Carrier::Body(step.outboard);
        let place = |point| {
            let position = self.mechanism.point(point).position_for(carrier);
            let values: Vec<f64> = position.iter().map(|x| x.value(self.parameters).unwrap_or(0.0)).collect();
            [values[0], values[1], values[2]]
        };
        let origin = place(self.mechanism.joint(step.joint).at);
        let joints = self
            .mechanism
            .joints
            .iter()
            .filter(|joint| joint.parent == carrier || joint.child == carrier)
            .map(|joint| joint.at);
        let described = self.mechanism.body(step.outboard).inertia.points();
        let places: Vec<[f64; 3]> = described.into_iter().chain(joints).map(place).collect();
        let reach = |p: &[f64; 3]| {
            let d = [p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]];
            (dot(d, d), d)
        };
        let size = places.iter().map(|p| reach(p).0).fold(0.0, f64::max);
        places.iter().map(reach).find(|(square, _)| *square > 1e-12 * size).map(|(_, d)| d)
    }

    fn close(&mut self, joint: JointId) {
        let (parent, child) = (self.mechanism.joint(joint).parent, self.mechanism.joint(joint).child);
        let (parent_link, child_link) = (self.linkage.link(parent), self.linkage.link(child));
        let cut = match self.mechanism.closure {
            Closure::Joint => Cut { joint, closure: Closure::Joint, parent: parent_link, child: child_link },
            Closure::Log => {
                // The end body of [CS (2)] is reached twice: on its own branch and through the cut joint.
                let (body, inboard, reversed) = match (parent, child) {
                    (_, Carrier::Body(body)) => (body, parent, false),
                    (Carrier::Body(body), Carrier::Ground) => (body, child, true),
                    (Carrier::Ground, Carrier::Ground) => {
                        unreachable!("a joint has at least one moving body")
                    }
                };
                let step = TreeJoint { joint, inboard, outboard: body, reversed };
                let inboard = self.linkage.link(inboard);
                let copy = self.chain(step, inboard);
                self.linkage.link_of_joint[joint.index()] = Some(copy);
                self.linkage.reversed[joint.index()] = reversed;
                let own = self.linkage.link_of_body[body.index()];
                Cut { joint, closure: Closure::Log, parent: Some(own), child: Some(copy) }
            }
        };
        self.linkage.cuts.push(cut);
    }

    /// A body that several branches reach is split evenly, so that no branch ends without mass.
    fn share_masses(&mut self) {
        for body in 0..self.mechanism.bodies.len() {
            let mut ends = vec![self.linkage.link_of_body[body]];
            for cut in self.linkage.cuts.iter().filter(|cut| cut.closure == Closure::Log) {
                if cut.parent == Some(self.linkage.link_of_body[body]) {
                    ends.extend(cut.child);
                }
            }
            let share = 1.0 / ends.len() as f64;
            for end in ends {
                self.linkage.links[end].mass_share = share;
            }
        }
        debug_assert_eq!(self.topology.cuts.len(), self.linkage.cuts.len());
    }
}
