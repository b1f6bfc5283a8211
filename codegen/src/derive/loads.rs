//! Everything that pushes, and what it does to energy.
//! In: wrenches and forces. Out: [`Loads`]. Never knows where they come from.

use crate::expr::{Expr, Scope, Vec3};
use crate::id::JointId;

use super::linkage::{LinkIndex, Linkage};
use super::relative_motion::RelativeMotion;
use super::wrench::Wrench;

/// Everything that pushes, and what it does to energy.
pub struct Loads<'g> {
    /// Wrench on every link from force elements and cut joints, in its frame about its origin.
    pub external: Vec<Wrench<'g>>,
    /// Force of tree joints along every speed, on the outboard side.
    pub joint: Vec<Expr<'g>>,
    /// Of that, everything but stiffness of bodies.
    pub unstretched: Vec<Expr<'g>>,
    /// What stiffness of bodies takes away.
    pub elastic: Vec<Expr<'g>>,
    /// Reactions of ball joints' moments on their parent links.
    pub reactions: Vec<Wrench<'g>>,
    /// Moment and force of forces in cut joints on the child at its joint point, in the frame of
    /// [`RelativeMotion::beside`].
    pub in_cuts: Vec<(JointId, Vec3<'g>, Vec3<'g>)>,
    /// Energy stored in springs [J].
    pub potential: Expr<'g>,
    /// Power taken out by dampers [W].
    pub dissipated: Expr<'g>,
    /// Power put in by actuators and applied forces [W].
    pub supplied: Expr<'g>,
}

impl<'g> Loads<'g> {
    pub fn none(g: &'g Scope, linkage: &Linkage) -> Self {
        let (zero, none) = (g.zero(), Wrench::zero(g));
        Self {
            external: vec![none; linkage.links.len()],
            joint: vec![zero; linkage.speeds()],
            unstretched: vec![zero; linkage.speeds()],
            elastic: vec![zero; linkage.speeds()],
            reactions: vec![none; linkage.links.len()],
            in_cuts: Vec::new(),
            potential: zero,
            dissipated: zero,
            supplied: zero,
        }
    }

    /// A wrench on the child of a cut joint and its opposite on the parent.
    pub fn pair(&mut self, joint: JointId, motion: &RelativeMotion<'g>, moment: Vec3<'g>, force: Vec3<'g>) {
        self.in_cuts.push((joint, moment, force));
        self.between(motion, moment, force);
    }

    /// A wrench on the child of a relative motion at its chosen place, and its opposite on the parent.
    pub fn between(&mut self, motion: &RelativeMotion<'g>, moment: Vec3<'g>, force: Vec3<'g>) {
        let [parent, child] = motion.link_wrenches(moment, force);
        self.push(motion.child.link, child);
        self.push(motion.parent.link, parent);
    }

    /// A force along a speed.
    pub fn push_along(&mut self, speed: usize, force: Expr<'g>) {
        self.joint[speed] += force;
        self.unstretched[speed] += force;
    }

    /// A moment on a ball link, in its frame.
    pub fn turn(&mut self, linkage: &Linkage, ball: usize, moment: Vec3<'g>) {
        let first = linkage.links[ball].first_speed;
        for (i, component) in moment.into_iter().enumerate() {
            self.push_along(first + i, component);
        }
    }

    /// The reaction of a moment on a ball link, in the frame of its parent link.
    pub fn react(&mut self, g: &'g Scope, linkage: &Linkage, ball: usize, reaction: Vec3<'g>) {
        if let Some(parent) = linkage.links[ball].parent {
            let reaction = Wrench { moment: reaction, force: g.zero_vector() };
            self.reactions[parent] += reaction;
        }
    }

    /// Adds a wrench on a link; the ground takes any.
    pub fn push(&mut self, link: LinkIndex, wrench: Wrench<'g>) {
        if let Some(at) = link {
            self.external[at] += wrench;
        }
    }
}
