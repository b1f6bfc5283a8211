//! Loop closure: residuals, Jacobian rows and acceleration bias of every cut, [CS (3)].
//! In: a [`Linkage`] with cuts, link motion. Out: [`Row`]s. Never evaluates a number.
//!
//! A row is a unit wrench that the child feels at its joint point and the parent feels in reverse at
//! the same place. Its Jacobian follows by carrying that wrench to the ground along both branches:
//! the joint screws moved to the closure point, read from the other side. `bias` is the row's
//! acceleration for zero `v̇` of the free speeds, by the velocity-product recursion.

use crate::expr::Expr;
use crate::model::{Closure, JointModel};

use super::geometry::Geometry;
use super::joint_markers::{joint_in_child, joint_markers, split_body_markers};
use super::joint_rows::RowMaker;
use super::kinematics::Poses;
use super::linkage::{Cut, Freedom, LinkIndex};
use super::log_closure::log_rows;
use super::motion::Motion;
use super::relative_motion::{Place, RelativeMotion, Side, Sums};
use super::row::Row;
use super::surface_row::surface_row;
use super::wrench::Wrench;

/// All rows of one cut with the relative motion they were made from.
pub struct CutRows<'g> {
    /// The cut.
    pub cut: Cut,
    /// Motion of the child relative to the parent.
    pub motion: RelativeMotion<'g>,
    /// Rows, in a fixed order: rotation first for `log`, translation first for `joint`.
    pub rows: Vec<Row<'g>>,
}

/// Number of rows of a cut, without deriving them.
pub fn row_count(joint: &JointModel, closure: Closure) -> usize {
    match closure {
        Closure::Log => 6,
        Closure::Joint => joint.rows(),
    }
}

/// Derives the rows of every cut. With `exact` the Jacobian is exact off the closed positions too.
pub fn cut_rows<'g>(motion: &Motion<'g>, exact: bool, sums: Sums) -> Vec<CutRows<'g>> {
    motion.poses.geometry.linkage.cuts.iter().map(|cut| rows_of(motion, *cut, exact, sums)).collect()
}

fn rows_of<'g>(motion: &Motion<'g>, cut: Cut, exact: bool, sums: Sums) -> CutRows<'g> {
    let geometry = &motion.poses.geometry;
    let g = geometry.g;
    let data = geometry.mechanism.joint(cut.joint);
    g.begin_section(format!("loop closure at {}", data.name));
    let links = [cut.parent, cut.child];
    if cut.closure == Closure::Log {
        let markers = split_body_markers(geometry, cut.joint, links);
        let place = if exact { Place::Child } else { Place::Own };
        let motion = RelativeMotion::between(motion, markers, Side::Child, (place, sums));
        let rows = log_rows(&motion, exact);
        return CutRows { cut, motion, rows };
    }
    let slides = data.model.holds_place() || (data.model.rows() > 0 && data.model.slides());
    let in_child = joint_in_child(geometry, cut.joint, links);
    let side = match in_child {
        _ if cut.plane && geometry.linkage.rows_in_ground => Side::Ground,
        true => Side::Child,
        false => Side::Parent,
    };
    let place = match (exact && side != Side::Ground, slides) {
        (false, false) => Place::Own,
        // Directions that turn with the child measure its distance exactly at the parent's point.
        (true, _) if in_child => Place::Parent,
        _ => Place::Child,
    };
    let markers = joint_markers(geometry, cut.joint, links, in_child);
    let motion = RelativeMotion::between(motion, markers, side, (place, sums));
    let mut rows = RowMaker::new(&motion, exact).joint(geometry, &data.model);
    rows.extend(data.surface.iter().map(|surface| surface_row(geometry, &motion, surface)));
    CutRows { cut, motion, rows }
}

impl<'g> CutRows<'g> {
    /// Jacobian of one row by all speeds.
    pub fn jacobian(&self, poses: &Poses<'g>, row: &Row<'g>) -> Vec<Expr<'g>> {
        let Geometry { g, linkage, .. } = poses.geometry;
        let mut columns = vec![g.zero(); linkage.speeds()];
        let [parent, child] = self.motion.link_wrenches(row.moment, row.force);
        let (parent_link, child_link) = (self.motion.parent.link, self.motion.child.link);
        let top = linkage.common_ancestor(child_link, parent_link);
        let (mut sum, child_lost) = carry(poses, &mut columns, child, child_link, top);
        let (other, parent_lost) = carry(poses, &mut columns, parent, parent_link, top);
        if child_lost || parent_lost {
            // The pair's forces cancel at the common ancestor; a moment stays because a ball link passed none.
            sum += other;
            sum.force = g.zero_vector();
            carry(poses, &mut columns, sum, top, None);
        }
        columns
    }
}

/// Carries a wrench inwards to `top` (exclusive), adding to the columns on the way. Returns the wrench on
/// `top` and whether a ball or free link kept something back.
fn carry<'g>(
    poses: &Poses<'g>,
    columns: &mut [Expr<'g>],
    wrench: Wrench<'g>,
    from: LinkIndex,
    top: LinkIndex,
) -> (Wrench<'g>, bool) {
    let (mut carried, mut lost) = (wrench, false);
    for at in poses.geometry.linkage.between(from, top) {
        let link = &poses.geometry.linkage.links[at];
        for (speed, entry) in link.speeds().zip(carried.generalised(link.freedom, poses.nodes[at].as_ref())) {
            columns[speed] += entry;
        }
        lost |= matches!(link.freedom, Freedom::Ball | Freedom::Free);
        carried = carried.passed_inwards(link.freedom, &poses.relative[at]);
    }
    (carried, lost)
}
