//! The constraint rows that are kept, and which speeds are free.
//! In: link motion, rows of all cuts. Out: [`KeptRow`]s. Never knows why the others are dropped.

use crate::expr::Expr;

use super::closure::CutRows;
use super::couplings::CouplingRow;
use super::motion::Motion;
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
}

/// Picks the rows that are kept, in order, with their Jacobians.
pub fn kept_rows<'a, 'g>(
    motion: &Motion<'g>,
    (cuts, couplings): (&'a [CutRows<'g>], &'a [CouplingRow<'g>]),
    keep: &[bool],
) -> Vec<KeptRow<'a, 'g>> {
    let rows = cuts.iter().flat_map(|cut| cut.rows.iter().map(move |row| (cut, row)));
    let (of_cuts, of_couplings) = keep.split_at(keep.len() - couplings.len());
    let of_cuts = rows
        .zip(of_cuts)
        .filter(|(_, keep)| **keep)
        .map(|((cut, row), _)| KeptRow { row, jacobian: cut.jacobian(&motion.poses, row) });
    let of_couplings = couplings
        .iter()
        .zip(of_couplings)
        .filter(|(_, keep)| **keep)
        .map(|(coupling, _)| KeptRow { row: &coupling.row, jacobian: coupling.jacobian.clone() });
    of_cuts.chain(of_couplings).collect()
}
