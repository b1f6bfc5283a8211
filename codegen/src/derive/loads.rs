//! Everything that pushes, and what it does to energy.
//! In: wrenches and forces. Out: [`Loads`]. Never knows where they come from.

use crate::expr::{Expr, Scope, Vec3};
use crate::id::JointId;

use super::across::{Across, sides_of};
use super::closure::link_wrenches;
use super::joint_state::JointStates;
use super::linkage::{LinkIndex, Linkage};
use super::wrench::Wrench;

/// Everything that pushes, and what it does to energy.
pub struct Loads<'g> {
    /// Wrench on every link from force elements and cut joints, in its frame about its origin.
    pub external: Vec<Wrench<'g>>,
    /// Force of tree joints along every speed, on the outboard side.
    pub joint: Vec<Expr<'g>>,
    /// Reactions of ball joints' moments on their parent links.
    pub reactions: Vec<Wrench<'g>>,
    /// Moment and force of forces in cut joints on the child at its joint point, in the frame of
    /// [`super::across::Sides::beside`].
    pub in_cuts: Vec<(JointId, Vec3<'g>, Vec3<'g>)>,
    /// Energy stored in springs [J].
    pub potential: Expr<'g>,
    /// Power taken out by dampers [W].
    pub dissipated: Expr<'g>,
    /// Power put in by actuators and applied forces [W].
    pub supplied: Expr<'g>,
}

impl<'g> Loads<'g> {
    /// No loads.
    pub fn none(g: &'g Scope, linkage: &Linkage) -> Self {
        let (zero, none) = (g.zero(), Wrench::zero(g));
        Self {
            external: vec![none; linkage.links.len()],
            joint: vec![zero; linkage.speeds()],
            reactions: vec![none; linkage.links.len()],
            in_cuts: Vec::new(),
            potential: zero,
            dissipated: zero,
            supplied: zero,
        }
    }

    /// A wrench on the child of a joint and its opposite on the parent.
    pub fn pair(
        &mut self,
        g: &'g Scope,
        state: &JointStates<'g>,
        joint: JointId,
        across: &Across<'g>,
        moment: Vec3<'g>,
        force: Vec3<'g>,
    ) {
        let sides = sides_of(&state.geometry, joint);
        self.in_cuts.push((joint, moment, force));
        let [child, parent] = link_wrenches(g, across, moment, force);
        self.push(sides.child, child);
        self.push(sides.parent, parent);
    }

    /// Adds a wrench on a link; the ground takes any.
    pub fn push(&mut self, link: LinkIndex, wrench: Wrench<'g>) {
        if let Some(at) = link {
            self.external[at] += wrench;
        }
    }
}
