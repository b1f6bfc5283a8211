//! Builds the tree of links: chains of one-freedom motions, cheap frames, cuts, shares of split bodies.
//! In: [`Mechanism`], [`Topology`]. Out: [`Linkage`].

use crate::id::{BodyId, JointId};
use crate::model::{Axis, Carrier, Closure, Direction, Flexible, Mechanism, Primitive, Topology, TreeJoint};

use super::attachment::NodeShape;
use super::frame::{Frame, canonical_frame, cross, dot, reduce};
use super::linkage::{Cut, Freedom, Link, LinkIndex, Linkage, NodeLink};

/// Builds the tree of links. `parameters` are the default values, which only steer the choice of frames.
pub fn linkage(mechanism: &Mechanism, topology: &Topology, parameters: &[f64]) -> Linkage {
    let mut builder = Builder {
        mechanism,
        parameters,
        linkage: Linkage {
            links: Vec::new(),
            cuts: Vec::new(),
            rows_in_ground: topology.rows_in_ground,
            rows_off_balls: topology.rows_off_balls,
            link_of_body: vec![usize::MAX; mechanism.bodies.len()],
            link_of_joint: vec![None; mechanism.joints.len()],
            reversed: vec![false; mechanism.joints.len()],
            nodes: Vec::new(),
        },
    };
    for step in &topology.tree {
        let inboard = builder.held(step.joint, step.inboard);
        let last = builder.chain(*step, inboard);
        builder.linkage.link_of_body[step.outboard.index()] = builder.deform(*step, last);
        builder.linkage.link_of_joint[step.joint.index()] = Some(last);
        builder.linkage.reversed[step.joint.index()] = step.reversed;
    }
    for cut in &topology.cuts {
        builder.close(*cut);
    }
    builder.share_masses();
    builder.linkage
}

/// Unit vectors are parallel up to a few roundings.
const PARALLEL: f64 = 1e-14;

struct Builder<'a> {
    mechanism: &'a Mechanism,
    parameters: &'a [f64],
    linkage: Linkage,
}

/// Axes of a flexible body's floating frame in W at the reference pose.
fn floating_frame(flexible: &Flexible) -> Frame {
    let [x, y, z] = flexible.axes;
    Frame::from_axes(x, y, z)
}

impl Builder<'_> {
    /// Adds the links of one joint, those of its primitives, and returns the last.
    fn chain(&mut self, step: TreeJoint, inboard: LinkIndex) -> usize {
        let joint = &self.mechanism.joint(step.joint).model;
        let mut primitives = joint.primitives();
        // Seen from the other side, the joint runs backwards: opposite axes in opposite order.
        let sign = if step.reversed { -1.0 } else { 1.0 };
        if step.reversed {
            primitives.reverse();
        }
        let inner = |axis: &Axis| if step.reversed { axis.child } else { axis.parent };
        let along = |direction: Direction| {
            let axis = match direction {
                Direction::Z => inner(&joint.axes[0]),
                Direction::X => inner(&joint.axes[1]),
                Direction::Y => cross(inner(&joint.axes[0]), inner(&joint.axes[1])),
            };
            axis.map(|x| sign * x)
        };
        let mut parent = inboard;
        for (coordinate, primitive) in primitives {
            parent = match primitive {
                Primitive::Turn(direction) => {
                    Some(self.turn(step, parent, coordinate, along(direction), 0.0))
                }
                Primitive::Thread => {
                    let advance = joint.lead / std::f64::consts::TAU;
                    Some(self.turn(step, parent, coordinate, along(Direction::Z), advance))
                }
                Primitive::Slide(direction) => Some(self.slide(step, parent, coordinate, along(direction))),
                Primitive::Ball => Some(self.single(step, parent, coordinate, Freedom::Ball)),
                Primitive::Pose => Some(self.single(step, None, coordinate, Freedom::Free)),
                Primitive::Shift => (0..3).fold(parent, |parent, index| {
                    let axis = self.linkage.frame(parent).axis(index).map(|x| sign * x);
                    Some(self.slide(step, parent, coordinate + index, axis))
                }),
            };
        }
        let Some(last) = parent.filter(|_| !joint.primitives().is_empty()) else {
            return self.single(step, inboard, 0, Freedom::Weld);
        };
        if let Some(axis) = joint.axes.first() {
            // Where the branches are described open, the body's own description sees other axes: turned by the
            // smallest rotation from the inboard to the outboard description of the first.
            let [from, to] =
                if step.reversed { [axis.child, axis.parent] } else { [axis.parent, axis.child] };
            let frame = self.linkage.links[last].frame;
            self.linkage.links[last].frame = Frame::between(from, to).times(&frame).snapped();
        }
        last
    }

    fn turn(
        &mut self,
        step: TreeJoint,
        parent: LinkIndex,
        coordinate: usize,
        axis: [f64; 3],
        advance: f64,
    ) -> usize {
        let outer = self.linkage.frame(parent);
        let (mount, offset) =
            canonical_frame(outer.local(axis), |_| self.target(step).map(|direction| outer.local(direction)));
        let frame = outer.times(&mount).times(&Frame::about_z(offset)).snapped();
        self.push(step, parent, coordinate, Freedom::Rotation { offset, advance }, mount, frame)
    }

    fn slide(&mut self, step: TreeJoint, parent: LinkIndex, coordinate: usize, axis: [f64; 3]) -> usize {
        let frame = self.linkage.frame(parent);
        let axis = reduce(frame.local(axis));
        self.push(step, parent, coordinate, Freedom::Translation { axis }, Frame::IDENTITY, frame)
    }

    /// A chain of one link whose orientation is free to choose (ball, free) or the parent's (weld).
    fn single(&mut self, step: TreeJoint, parent: LinkIndex, coordinate: usize, freedom: Freedom) -> usize {
        let outer = self.linkage.frame(parent);
        let frame = match freedom {
            Freedom::Weld => outer,
            _ => match self.mechanism.body(step.outboard).flexible.as_ref() {
                Some(flexible) => floating_frame(flexible),
                None => self.target(step).map_or(Frame::IDENTITY, Frame::with_x_along),
            },
        };
        self.push(step, parent, coordinate, freedom, Frame::IDENTITY, frame)
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
            origin: self.mechanism.joint(step.joint).at,
            node: None,
        });
        self.linkage.links.len() - 1
    }

    /// The link of a joint's inboard side.
    fn held(&self, joint: JointId, carrier: Carrier) -> LinkIndex {
        let joint = self.mechanism.joint(joint);
        self.linkage.link_at(carrier, joint.at, !joint.model.turns_freely())
    }

    /// Adds the floating frame of a flexible body behind its inboard joint, and its nodes. Returns the link
    /// that carries the body.
    fn deform(&mut self, step: TreeJoint, last: usize) -> usize {
        let mechanism = self.mechanism;
        let Some(flexible) = &mechanism.body(step.outboard).flexible else { return last };
        let joint = mechanism.joint(step.joint);
        let frame = floating_frame(flexible);
        let mount = self.linkage.links[last].frame.transposed().times(&frame).snapped();
        let freedom = Freedom::Flexible { modes: flexible.data.modes.len() };
        let own = self.push(step, Some(last), usize::MAX, freedom, mount, frame);
        let inboard = flexible.node_at(joint.at);
        // A ball or free joint fixes no direction, so the floating frame's own serves.
        self.linkage.links[own].node = Some(NodeShape::new(inboard, !joint.model.turns_freely()));
        self.linkage.links[own].origin = flexible.origin;
        for (point, _) in &flexible.nodes {
            for turns in [false, true] {
                let shape = NodeShape::new(flexible.node_at(*point), turns);
                if !shape.moves() {
                    continue;
                }
                let link = self.push(step, Some(own), usize::MAX, Freedom::Node, Frame::IDENTITY, frame);
                let modal = &self.linkage.links[own];
                let (first_coordinate, first_speed) = (modal.first_coordinate, modal.first_speed);
                let node = &mut self.linkage.links[link];
                node.name = format!("{}_at_{}", node.name, mechanism.point(*point).name);
                (node.first_coordinate, node.first_speed) = (first_coordinate, first_speed);
                node.origin = *point;
                node.node = Some(shape);
                self.linkage.nodes.push(NodeLink { body: step.outboard, point: *point, turns, link });
            }
        }
        own
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
        let data = self.mechanism.joint(joint);
        let [on_parent, on_child] = data.points();
        let turns = !data.model.turns_freely();
        let (parent_link, child_link) =
            (self.linkage.link_at(parent, on_parent, turns), self.linkage.link_at(child, on_child, turns));
        let holds_place = self.mechanism.joint(joint).model.holds_place();
        let end_body = self.end_body(parent, child).filter(|_| !holds_place);
        let cut = match (self.mechanism.closure, end_body) {
            (Closure::Joint, _) | (_, None) => {
                let plane = self.is_plane(joint, [parent_link, child_link]);
                Cut { joint, closure: Closure::Joint, parent: parent_link, child: child_link, plane }
            }
            (Closure::Log, Some((body, inboard, reversed))) => {
                let step = TreeJoint { joint, inboard, outboard: body, reversed };
                let inboard = self.held(joint, inboard);
                let copy = self.chain(step, inboard);
                self.linkage.link_of_joint[joint.index()] = Some(copy);
                self.linkage.reversed[joint.index()] = reversed;
                let own = self.linkage.link_of_body[body.index()];
                Cut { joint, closure: Closure::Log, parent: Some(own), child: Some(copy), plane: false }
            }
        };
        self.linkage.cuts.push(cut);
    }

    /// See [`Cut::plane`].
    fn is_plane(&self, joint: JointId, links: [LinkIndex; 2]) -> bool {
        let model = &self.mechanism.joint(joint).model;
        let [axis] = model.axes[..] else { return false };
        let along = |direction: [f64; 3]| 1.0 - dot(direction, axis.child).abs() < PARALLEL;
        let parallel = |at: usize| match self.linkage.links[at].freedom {
            Freedom::Rotation { .. } => along(self.linkage.links[at].frame.axis(2)),
            Freedom::Translation { .. } | Freedom::Weld => true,
            _ => false,
        };
        let holds_point = model.held_axes().len() == 3;
        holds_point
            && along(axis.parent)
            && links.into_iter().all(|link| self.linkage.path(link).all(parallel))
    }

    /// The end body of [CS (2)], which is reached twice: on its own branch and through the cut joint; with its
    /// neighbour there and whether it is the joint's parent. A flexible body cannot be split.
    fn end_body(&self, parent: Carrier, child: Carrier) -> Option<(BodyId, Carrier, bool)> {
        let rigid = |carrier: Carrier| match carrier {
            Carrier::Body(body) if self.mechanism.body(body).flexible.is_none() => Some(body),
            _ => None,
        };
        let ends = rigid(child).map(|body| (body, parent, false));
        ends.or_else(|| rigid(parent).map(|body| (body, child, true)))
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
    }
}
