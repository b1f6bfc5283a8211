//! Modes that follow the floating frame of their body: no loop row and no joint moves with them, so that their
//! accelerations are known as soon as the frame's is.
//! In: the tree, where the loop Jacobian is not zero. Out: [`LocalModes`]. Never knows forces.

use crate::expr::{Expr, Scope};
use crate::flexible::Reduced;

use super::frame_inertia::FrameInertia;
use super::link_mass::LinkMass;
use super::linkage::{Freedom, Linkage};
use super::mass_matrix::Eliminated;
use super::motion::Motion;
use super::plan::PlanBlock;
use super::wrench::Wrench;

/// The modes of one body.
pub struct LocalModes {
    /// Link of the floating frame.
    pub link: usize,
    /// Modal speeds, by number among the free ones.
    pub speeds: Vec<usize>,
    pub reduced: Reduced,
}

/// Of all bodies whose modes are among what the plan leaves to the equations of motion; `free` has the free speeds by
/// index among all.
pub fn local_modes(
    motion: &Motion<'_>,
    pattern: &[Vec<bool>],
    rest: &PlanBlock,
    free: &[usize],
) -> Vec<LocalModes> {
    let linkage = motion.poses.geometry.linkage;
    let flexible = (0..linkage.links.len()).filter(|at| has_still_nodes(linkage, *at));
    flexible
        .filter_map(|link| {
            let speeds: Option<Vec<usize>> = linkage.links[link]
                .speeds()
                .map(|speed| free.iter().position(|other| *other == speed))
                .collect();
            let speeds = speeds?;
            let in_rows = |speed: &usize| pattern.iter().any(|row| row[*speed]);
            if speeds.iter().any(|speed| in_rows(speed) || !rest.speeds.contains(speed)) {
                return None;
            }
            let body = linkage.links[link].body;
            let data = &motion.poses.geometry.mechanism.body(body).flexible.as_ref()?.data;
            Some(LocalModes { link, speeds, reduced: data.reduced()? })
        })
        .collect()
}

/// Whether a link is the floating frame of a flexible body, and nothing that hangs on the body moves with its modes.
fn has_still_nodes(linkage: &Linkage, at: usize) -> bool {
    let link = &linkage.links[at];
    let carries = |node: usize| linkage.links.iter().any(|other| other.parent == Some(node));
    let mut nodes = (0..linkage.links.len()).filter(|node| {
        linkage.links[*node].freedom == Freedom::Node && linkage.links[*node].parent == Some(at)
    });
    matches!(link.freedom, Freedom::Flexible { .. })
        && link.node.as_ref().is_none_or(|node| !node.moves())
        && !nodes.any(carries)
}

impl LocalModes {
    /// The body without them, at modal coordinates `q`.
    pub fn eliminated<'g>(&self, g: &'g Scope, q: &[Expr<'g>]) -> Eliminated<'g> {
        Eliminated { link: self.link, inertia: FrameInertia::new(g, &self.reduced, q) }
    }

    /// Momentum per unit of each modal speed.
    pub fn columns<'g>(&self, mass: &LinkMass<'g>) -> Vec<Wrench<'g>> {
        let modal = mass.modal.as_ref();
        modal.map_or_else(Vec::new, |modal| (0..self.speeds.len()).map(|k| modal.column(k)).collect())
    }
}
