//! Wrenches on links: how they pass inwards and what the speeds feel of them.
//! In: poses, freedoms. Out: expressions. Never knows where a wrench comes from.

use std::ops::{Add, AddAssign, Neg};

use crate::expr::{Expr, Mat3, Scope, Vec3};

use super::attachment::NodePose;
use super::kinematics::Pose;
use super::linkage::Freedom;

/// A wrench in a link's frame: force, and moment about the link's origin.
#[derive(Clone, Copy, Debug)]
pub struct Wrench<'g> {
    /// Moment [N m].
    pub moment: Vec3<'g>,
    /// Force [N].
    pub force: Vec3<'g>,
}

impl Add for Wrench<'_> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { moment: self.moment + other.moment, force: self.force + other.force }
    }
}

impl AddAssign for Wrench<'_> {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Neg for Wrench<'_> {
    type Output = Self;
    fn neg(self) -> Self {
        Self { moment: -self.moment, force: -self.force }
    }
}

impl<'g> Wrench<'g> {
    pub fn zero(g: &'g Scope) -> Self {
        Self { moment: g.zero_vector(), force: g.zero_vector() }
    }

    /// The same wrench seen from the parent link.
    pub fn on_parent(self, pose: &Pose<'g>) -> Self {
        let force = pose.rotation * self.force;
        Self { moment: pose.rotation * self.moment + pose.offset.cross(force), force }
    }

    /// What the speeds inboard of the link feel of it: a ball link passes no moment, a free link nothing.
    pub fn passed_inwards(self, freedom: Freedom, pose: &Pose<'g>) -> Self {
        let zero = self.force.scope().zero_vector();
        match freedom {
            Freedom::Free => Self { moment: zero, force: zero },
            Freedom::Ball => Self { moment: zero, force: self.force }.on_parent(pose),
            _ => self.on_parent(pose),
        }
    }

    /// What a joint inboard of the parent link feels of it, whose screw moves that as `turn` and `slide` say, along this link's
    /// axes: see [`Self::passed_inwards`].
    pub fn felt_inboard(self, freedom: Freedom, pose: &Pose<'g>, screw: [Vec3<'g>; 2]) -> Expr<'g> {
        let [turn, slide] = pose.screw_outboard(freedom, screw);
        self.power(turn, slide)
    }

    /// Its power per unit of each speed that moves a link relative to its parent; of a flexible body's frame
    /// and nodes only what their motion takes, not what deforms the body.
    pub fn generalised(self, freedom: Freedom, node: Option<&NodePose<'g>>) -> Vec<Expr<'g>> {
        if let Some(node) = node {
            return self.on_node(freedom, node);
        }
        if let Some(screw) = freedom.screw() {
            let [turn, slide] = screw.map(|axis| self.force.scope().vector(axis));
            return vec![self.power(turn, slide)];
        }
        match freedom {
            Freedom::Ball => self.moment.0.to_vec(),
            Freedom::Free => [self.moment.0, self.force.0].concat(),
            _ => Vec::new(),
        }
    }

    fn on_node(self, freedom: Freedom, node: &NodePose<'g>) -> Vec<Expr<'g>> {
        if freedom == Freedom::Node {
            return node.generalised(node.to_floating(self.moment), node.to_floating(self.force));
        }
        // The floating frame moves against its inboard node.
        let moment = self.moment - node.place.cross(self.force);
        node.generalised(moment, self.force).into_iter().map(Neg::neg).collect()
    }

    /// Momentum of a body (mass, first moment, inertia about the origin) per unit of a twist.
    pub fn momentum(
        (mass, first, inertia): (Expr<'g>, Vec3<'g>, Mat3<'g>),
        omega: Vec3<'g>,
        origin: Vec3<'g>,
    ) -> Self {
        let (spun, carried) = (inertia * omega, first.cross(origin));
        let (moved, turned) = (mass * origin, omega.cross(first));
        Self { moment: spun + carried, force: moved + turned }
    }

    /// Power on a twist.
    pub fn power(self, omega: Vec3<'g>, origin: Vec3<'g>) -> Expr<'g> {
        self.moment.dot(omega) + self.force.dot(origin)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_joint_feels_is_the_same_along_either_link_s_axes() {
        let g = Scope::new();
        let rotation = g.matrix([[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]]);
        let pose = Pose { rotation, offset: g.vector([0.3, -0.7, 0.2]) };
        let wrench = Wrench { moment: g.vector([2.0, -1.0, 0.5]), force: g.vector([0.4, 3.0, -5.0]) };
        let screw = [[0.0, 0.6, 0.8], [0.2, 0.0, 0.1]].map(|axis| g.vector(axis));
        for freedom in [Freedom::Weld, Freedom::Ball, Freedom::Free] {
            let expected = wrench.passed_inwards(freedom, &pose).power(screw[0], screw[1]);
            let found = wrench.felt_inboard(freedom, &pose, screw);
            let [expected, found] = [expected, found].map(|x| x.as_number().expect("numbers make a number"));
            // A few roundings of numbers of the order of ten.
            assert!((expected - found).abs() < 1e-14, "{freedom:?}: {found} is not {expected}");
        }
    }
}
