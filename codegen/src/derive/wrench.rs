//! Wrenches on links: how they pass inwards and what the speeds feel of them.
//! In: poses, freedoms. Out: expressions. Never knows where a wrench comes from.

use crate::expr::{Expr, Mat3, Scope, Vec3};

use super::kinematics::Pose;
use super::linkage::Freedom;
use super::node::NodePose;

/// A wrench in a link's frame: force, and moment about the link's origin.
#[derive(Clone, Copy, Debug)]
pub struct Wrench<'g> {
    /// Moment [N m].
    pub moment: Vec3<'g>,
    /// Force [N].
    pub force: Vec3<'g>,
}

impl<'g> Wrench<'g> {
    /// No wrench.
    pub fn zero(g: &'g Scope) -> Self {
        Self { moment: g.zero_vector(), force: g.zero_vector() }
    }

    /// Sum.
    pub fn plus(self, g: &'g Scope, other: Self) -> Self {
        Self { moment: g.add3(self.moment, other.moment), force: g.add3(self.force, other.force) }
    }

    /// Opposite.
    pub fn negated(self, g: &'g Scope) -> Self {
        Self { moment: g.neg3(self.moment), force: g.neg3(self.force) }
    }

    /// The same wrench seen from the parent link.
    pub fn on_parent(self, g: &'g Scope, pose: &Pose<'g>) -> Self {
        let force = g.mul_vec3(pose.rotation, self.force);
        let turned = g.mul_vec3(pose.rotation, self.moment);
        let lever = g.cross3(pose.offset, force);
        Self { moment: g.add3(turned, lever), force }
    }

    /// What the speeds inboard of the link feel of it: a ball link passes no moment, a free link nothing.
    pub fn passed_inwards(self, g: &'g Scope, freedom: Freedom, pose: &Pose<'g>) -> Self {
        match freedom {
            Freedom::Free => Self::zero(g),
            Freedom::Ball => {
                let moment = g.zero_vector();
                Self { moment, force: self.force }.on_parent(g, pose)
            }
            _ => self.on_parent(g, pose),
        }
    }

    /// Its power per unit of each speed that moves a link relative to its parent; of a flexible body's frame
    /// and nodes only what their motion takes, not what deforms the body.
    pub fn generalised(self, g: &'g Scope, freedom: Freedom, node: Option<&NodePose<'g>>) -> Vec<Expr<'g>> {
        if let Some(node) = node {
            return self.on_node(g, freedom, node);
        }
        match freedom {
            Freedom::Rotation { advance, .. } => {
                let rate = g.constant(advance);
                let along = g.mul(rate, self.force[2]);
                vec![g.add(self.moment[2], along)]
            }
            Freedom::Translation { axis } => {
                let axis = g.vector(axis);
                vec![g.dot3(axis, self.force)]
            }
            Freedom::Ball => self.moment.0.to_vec(),
            Freedom::Free => [self.moment.0, self.force.0].concat(),
            Freedom::Weld | Freedom::Flexible { .. } | Freedom::Node => Vec::new(),
        }
    }

    fn on_node(self, g: &'g Scope, freedom: Freedom, node: &NodePose<'g>) -> Vec<Expr<'g>> {
        if freedom == Freedom::Node {
            let (moment, force) = (node.to_floating(g, self.moment), node.to_floating(g, self.force));
            return node.generalised(g, moment, force);
        }
        // The floating frame moves against its inboard node.
        let lever = g.cross3(node.place, self.force);
        let moment = g.sub3(self.moment, lever);
        node.generalised(g, moment, self.force).into_iter().map(|x| g.neg(x)).collect()
    }

    /// Momentum of a body (mass, first moment, inertia about the origin) per unit of a twist.
    pub fn momentum(
        g: &'g Scope,
        (mass, first, inertia): (Expr<'g>, Vec3<'g>, Mat3<'g>),
        omega: Vec3<'g>,
        origin: Vec3<'g>,
    ) -> Self {
        let (spun, carried) = (g.mul_vec3(inertia, omega), g.cross3(first, origin));
        let (moved, turned) = (g.scale3(mass, origin), g.cross3(omega, first));
        Self { moment: g.add3(spun, carried), force: g.add3(moved, turned) }
    }

    /// Power on a twist.
    pub fn power(self, g: &'g Scope, omega: Vec3<'g>, origin: Vec3<'g>) -> Expr<'g> {
        let (turned, moved) = (g.dot3(self.moment, omega), g.dot3(self.force, origin));
        g.add(turned, moved)
    }
}
