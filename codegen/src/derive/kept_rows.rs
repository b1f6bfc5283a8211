//! The constraint rows that are kept, and which speeds are free.
//! In: link motion, rows of all cuts. Out: [`KeptRow`]s. Never knows why the others are dropped.

use crate::expr::Expr;

use super::closure::{CutRows, cut_rows};
use super::couplings::CouplingRow;
use super::motion::Motion;
use super::relative_motion::{RelativeMotion, Sums};
use super::row::Row;

/// Which speeds are free and which are driven, by index among all.
#[derive(Clone, Debug, Default)]
pub struct Partition {
    /// Free speeds, in tree order.
    pub free: Vec<usize>,
    /// Driven speeds, in the order of the drivers.
    pub driven: Vec<usize>,
}

/// A kept row with its Jacobian by all speeds.
pub struct KeptRow<'a, 'g> {
    /// The row.
    pub row: &'a Row<'g>,
    /// Columns by all speeds.
    pub jacobian: Vec<Expr<'g>>,
    /// Of a row of a cut: between which links it acts.
    pub between: Option<&'a RelativeMotion<'g>>,
}

/// Acceleration residuals of the kept rows of cuts at closed states, for the accelerations that a motion has.
pub fn closed_biases<'g>(motion: &Motion<'g>, sums: Sums, keep: &[bool]) -> Vec<Expr<'g>> {
    let cuts = cut_rows(motion, false, sums);
    let rows = cuts.iter().flat_map(|cut| &cut.rows).zip(keep);
    rows.filter(|(_, keep)| **keep).map(|(row, _)| row.bias.closed).collect()
}

/// Picks the rows that are kept, in order, with their Jacobians.
pub fn kept_rows<'a, 'g>(
    motion: &Motion<'g>,
    (cuts, couplings): (&'a [CutRows<'g>], &'a [CouplingRow<'g>]),
    keep: &[bool],
) -> Vec<KeptRow<'a, 'g>> {
    let rows = cuts.iter().flat_map(|cut| cut.rows.iter().map(move |row| (cut, row)));
    let (of_cuts, of_couplings) = keep.split_at(keep.len() - couplings.len());
    let of_cuts = rows.zip(of_cuts).filter(|(_, keep)| **keep).map(|((cut, row), _)| KeptRow {
        row,
        jacobian: cut.jacobian(&motion.poses, row),
        between: Some(&cut.motion),
    });
    let of_couplings = couplings.iter().zip(of_couplings).filter(|(_, keep)| **keep).map(|(coupling, _)| {
        KeptRow { row: &coupling.row, jacobian: coupling.jacobian.clone(), between: None }
    });
    of_cuts.chain(of_couplings).collect()
}
