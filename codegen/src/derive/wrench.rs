//! Wrenches on links: how they pass inwards and what the speeds feel of them.
//! In: poses, freedoms. Out: expressions. Never knows where a wrench comes from.

use crate::expr::{ExprId, Graph, Vec3};

use super::kinematics::Pose;
use super::linkage::Freedom;

/// A wrench in a link's frame: force, and moment about the link's origin.
#[derive(Clone, Copy, Debug)]
pub struct Wrench {
    /// Moment [N m].
    pub moment: Vec3,
    /// Force [N].
    pub force: Vec3,
}

impl Wrench {
    /// No wrench.
    pub fn zero(g: &mut Graph) -> Self {
        Self { moment: g.zero_vector(), force: g.zero_vector() }
    }

    /// Sum.
    pub fn plus(self, g: &mut Graph, other: Self) -> Self {
        Self { moment: g.add3(self.moment, other.moment), force: g.add3(self.force, other.force) }
    }

    /// Opposite.
    pub fn negated(self, g: &mut Graph) -> Self {
        Self { moment: g.neg3(self.moment), force: g.neg3(self.force) }
    }

    /// The same wrench seen from the parent link.
    pub fn on_parent(self, g: &mut Graph, pose: &Pose) -> Self {
        let force = g.mul_vec3(pose.rotation, self.force);
        let turned = g.mul_vec3(pose.rotation, self.moment);
        let lever = g.cross3(pose.offset, force);
        Self { moment: g.add3(turned, lever), force }
    }

    /// What the speeds inboard of the link feel of it: a ball link passes no moment, a free link nothing.
    pub fn passed_inwards(self, g: &mut Graph, freedom: Freedom, pose: &Pose) -> Self {
        match freedom {
            Freedom::Free => Self::zero(g),
            Freedom::Ball => {
                let moment = g.zero_vector();
                Self { moment, force: self.force }.on_parent(g, pose)
            }
            _ => self.on_parent(g, pose),
        }
    }

    /// Its power per unit of each own speed of a link.
    pub fn generalised(self, g: &mut Graph, freedom: Freedom) -> Vec<ExprId> {
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
            Freedom::Ball => self.moment.to_vec(),
            Freedom::Free => [self.moment, self.force].concat(),
            Freedom::Weld => Vec::new(),
        }
    }
}
