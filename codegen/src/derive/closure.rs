//! Loop closure: residuals, Jacobian rows and acceleration bias of every cut, [CS (3)].
//! In: a [`Linkage`] with cuts, link motion. Out: [`Row`]s. Never evaluates a number.
//!
//! A row is a unit wrench that the child feels at its joint point and the parent feels in reverse at
//! the same place. Its Jacobian follows by carrying that wrench to the ground along both branches:
//! the joint screws moved to the closure point, read from the other side. `bias` is the row's
//! acceleration for zero `v̇` of the free speeds, by the velocity-product recursion.

use crate::expr::{Expr, Mat3, Scope, Vec3};
use crate::model::{Closure, JointModel};

use super::across::{Across, Place, Sides, joint_axes};
use super::geometry::Geometry;
use super::joint_rows::RowMaker;
use super::kinematics::Poses;
use super::linkage::{Cut, LinkIndex, Linkage};
use super::log_closure::log_rows;
use super::motion::Motion;
use super::row::Row;
use super::wrench::Wrench;

/// All rows of one cut with the relative motion they were made from.
pub struct CutRows<'g> {
    /// The cut.
    pub cut: Cut,
    /// Its sides.
    pub sides: Sides,
    /// Relative motion.
    pub across: Across<'g>,
    /// Rows, in a fixed order: rotation first for `log`, translation first for `joint`.
    pub rows: Vec<Row<'g>>,
}

/// Number of rows of a cut, without deriving them.
#[must_use]
pub fn row_count(joint: &JointModel, closure: Closure) -> usize {
    match closure {
        Closure::Log => 6,
        Closure::Joint => joint.rows(),
    }
}

/// Derives the rows of every cut. With `exact` the Jacobian is exact off the closed positions too.
pub fn cut_rows<'g>(
    g: &'g Scope,
    geometry: &Geometry<'g>,
    motion: &Motion<'g>,
    exact: bool,
) -> Vec<CutRows<'g>> {
    geometry.linkage.cuts.iter().map(|cut| rows_of(g, geometry, motion, *cut, exact)).collect()
}

fn rows_of<'g>(
    g: &'g Scope,
    geometry: &Geometry<'g>,
    motion: &Motion<'g>,
    cut: Cut,
    exact: bool,
) -> CutRows<'g> {
    let name = &geometry.mechanism.joint(cut.joint).name;
    g.begin_section(format!("loop closure at {name}"));
    if cut.closure == Closure::Log {
        let sides = Sides { joint: cut.joint, parent: cut.parent, child: cut.child, in_child: true };
        let across = Across::new(g, geometry, motion, sides, if exact { Place::Child } else { Place::Own });
        let rows = log_rows(g, geometry, &across, sides, exact);
        return CutRows { cut, sides, across, rows };
    }
    let sides = Sides::choose(geometry.linkage, cut.joint, cut.parent, cut.child);
    let joint = &geometry.mechanism.joint(cut.joint).model;
    let slides = joint.rows() > 0 && joint.slides();
    let place = match (exact, slides) {
        (false, false) => Place::Own,
        // Directions that turn with the child measure its distance exactly at the parent's point.
        (true, _) if sides.in_child => Place::Parent,
        _ => Place::Child,
    };
    let across = Across::new(g, geometry, motion, sides, place);
    let axes = joint_axes(geometry, sides);
    let rows = RowMaker::new(g, &across, sides, axes, exact).joint(geometry, joint);
    CutRows { cut, sides, across, rows }
}

impl<'g> CutRows<'g> {
    /// Wrenches on the child link and on the parent link, in their own frames about their origins, of a
    /// wrench (moment, force) on the child at the joint point given in the common frame.
    pub fn link_wrenches(&self, g: &'g Scope, moment: Vec3<'g>, force: Vec3<'g>) -> [Wrench<'g>; 2] {
        link_wrenches(g, &self.across, moment, force)
    }

    /// Jacobian of one row by all speeds.
    pub fn jacobian(
        &self,
        g: &'g Scope,
        linkage: &Linkage,
        poses: &Poses<'g>,
        row: &Row<'g>,
    ) -> Vec<Expr<'g>> {
        let zero = g.zero();
        let mut columns = vec![zero; linkage.speeds()];
        let [child, parent] = self.link_wrenches(g, row.moment, row.force);
        let top = linkage.common_ancestor(self.sides.child, self.sides.parent);
        let mut carrier = Carrier { linkage, poses, columns: &mut columns };
        let (mut sum, child_lost) = carrier.carry(g, child, self.sides.child, top);
        let (other, parent_lost) = carrier.carry(g, parent, self.sides.parent, top);
        if child_lost || parent_lost {
            // The pair's forces cancel at the common ancestor; a moment stays because a ball link passed none.
            sum = sum + other;
            sum.force = g.zero_vector();
            carrier.carry(g, sum, top, None);
        }
        columns
    }
}

/// See [`CutRows::link_wrenches`].
pub fn link_wrenches<'g>(
    g: &'g Scope,
    across: &Across<'g>,
    moment: Vec3<'g>,
    force: Vec3<'g>,
) -> [Wrench<'g>; 2] {
    let side = |rotation: Mat3<'g>, point: Vec3<'g>| {
        let force = g.transpose_mul_vec3(rotation, force);
        let moment = g.transpose_mul_vec3(rotation, moment);
        let lever = g.cross3(point, force);
        Wrench { moment: g.add3(moment, lever), force }
    };
    let child = side(across.from_child, across.child_point);
    let parent = side(across.from_parent, across.parent_point);
    [child, -parent]
}

struct Carrier<'a, 'g> {
    linkage: &'a Linkage,
    poses: &'a Poses<'g>,
    columns: &'a mut [Expr<'g>],
}

impl<'g> Carrier<'_, 'g> {
    /// Carries a wrench inwards to `top` (exclusive), adding to the columns on the way. Returns the wrench on
    /// `top` and whether a ball or free link kept something back.
    fn carry(
        &mut self,
        g: &'g Scope,
        wrench: Wrench<'g>,
        from: LinkIndex,
        top: LinkIndex,
    ) -> (Wrench<'g>, bool) {
        use super::linkage::Freedom;
        let (mut carried, mut at, mut lost) = (wrench, from, false);
        while at != top {
            let index = at.expect("the ancestor lies on the path to the ground");
            let link = &self.linkage.links[index];
            let node = self.poses.nodes[index].as_ref();
            for (offset, entry) in carried.generalised(link.freedom, node).into_iter().enumerate() {
                let column = &mut self.columns[link.first_speed + offset];
                *column = g.add(*column, entry);
            }
            lost |= matches!(link.freedom, Freedom::Ball | Freedom::Free);
            carried = carried.passed_inwards(link.freedom, &self.poses.relative[index]);
            at = link.parent;
        }
        (carried, lost)
    }
}
