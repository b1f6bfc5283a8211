//! Builds the tree of links: chains of one-freedom motions, cheap frames, cuts, shares of split bodies.
//! In: [`Mechanism`], [`Topology`]. Out: [`Linkage`].

use crate::id::JointId;
use crate::model::{Axis, Carrier, Closure, JointKind, Mechanism, Topology, TreeJoint};

use super::frame::{Frame, canonical_frame, cross, dot, reduce};
use super::linkage::{Cut, Freedom, Link, LinkIndex, Linkage};

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
