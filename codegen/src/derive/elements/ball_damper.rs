//! Viscous damping of a ball joint.

use crate::derive::element::Element;
use crate::derive::joint_state::JointStates;
use crate::derive::loads::Loads;
use crate::expr::{Expr, Scope, Vec3};
use crate::id::JointId;
use crate::model::{Carrier, Formula};

/// `-c omega_rel` on the child, its opposite on the parent. The ball sits on a section: where a body is
/// flexible, its slope there turns the ball, and the moment bends the body.
pub struct BallDamper<'m> {
    /// The joint.
    pub joint: JointId,
    /// c [N m s/rad].
    pub coefficient: &'m Formula,
}

impl<'g> Element<'g> for BallDamper<'_> {
    fn add_to(&self, loads: &mut Loads<'g>, g: &'g Scope, state: &JointStates<'g>) {
        let linkage = state.geometry.linkage;
        let c = state.lower(g, self.coefficient);
        let sections = Sections::new(state, self.joint);
        if let Some(ball) = linkage.ball_of(self.joint) {
            let rotation = state.motion.poses.relative[ball].rotation;
            let mut omega = state.motion.relative_omega(linkage, ball);
            omega += sections.rate(g, state, Side::Outboard);
            omega -= rotation.transpose() * sections.rate(g, state, Side::Inboard);
            dissipate(loads, c, omega);
            let scaled = c * omega;
            let moment = -scaled;
            loads.turn(linkage, ball, moment);
            sections.bend(loads, g, Side::Outboard, moment);
            let reaction = rotation * scaled;
            sections.bend(loads, g, Side::Inboard, reaction);
            loads.react(g, linkage, ball, reaction);
        } else {
            let motion = state.relative_motion(self.joint);
            let child = motion.from_child * sections.rate(g, state, Side::Outboard);
            let parent = motion.from_parent * sections.rate(g, state, Side::Inboard);
            let slopes = child - parent;
            let omega = motion.omega + slopes;
            dissipate(loads, c, omega);
            let scaled = c * omega;
            let moment = -scaled;
            loads.pair(self.joint, &motion, moment, g.zero_vector());
            sections.bend(loads, g, Side::Outboard, motion.from_child.transpose() * moment);
            sections.bend(loads, g, Side::Inboard, motion.from_parent.transpose() * scaled);
        }
    }
}

fn dissipate<'g>(loads: &mut Loads<'g>, coefficient: Expr<'g>, rate: Vec3<'g>) {
    let square = rate.dot(rate);
    loads.dissipated += coefficient * square;
}

/// One side of a joint: in the tree away from the ground, in a cut the child.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Side {
    Inboard,
    Outboard,
}

/// Slopes of the sections on which a ball joint sits, for bodies that are flexible.
struct Sections([Option<Section>; 2]);

struct Section {
    /// Link of the floating frame.
    frame: usize,
    /// First modal speed.
    first: usize,
    /// Rotation vector per unit of each mode, in the floating frame.
    slopes: Vec<[f64; 3]>,
}

impl Sections {
    fn new(state: &JointStates<'_>, joint: JointId) -> Self {
        let (mechanism, linkage) = (state.geometry.mechanism, state.geometry.linkage);
        let data = mechanism.joint(joint);
        let side = |carrier: Carrier| {
            let Carrier::Body(body) = carrier else { return None };
            let flexible = mechanism.body(body).flexible.as_ref()?;
            let frame = linkage.link_of_body[body.index()];
            let slopes = flexible.node_at(data.at).rotation.clone();
            Some(Section { frame, first: linkage.links[frame].first_speed, slopes })
        };
        let (parent, child) = (side(data.parent), side(data.child));
        if linkage.reversed[joint.index()] { Self([child, parent]) } else { Self([parent, child]) }
    }

    fn of(&self, side: Side) -> Option<&Section> {
        self.0[usize::from(side == Side::Outboard)].as_ref()
    }

    /// Angular velocity of the section relative to the floating frame, in that frame.
    fn rate<'g>(&self, g: &'g Scope, state: &JointStates<'g>, side: Side) -> Vec3<'g> {
        let Some(section) = self.of(side) else { return g.zero_vector() };
        g.weighted_vectors(&section.slopes, &state.motion.modes[section.frame].v)
    }

    /// What modes feel of a moment on a section, given in the floating frame.
    fn bend<'g>(&self, loads: &mut Loads<'g>, g: &'g Scope, side: Side, moment: Vec3<'g>) {
        let Some(section) = self.of(side) else { return };
        for (k, slope) in section.slopes.iter().enumerate() {
            loads.push_along(section.first + k, g.vector(*slope).dot(moment));
        }
    }
}
