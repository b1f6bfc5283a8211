//! Whether loops that move only thanks to special geometry are drawn exactly enough to stay closed along their motion.
//! In: closed positions, and the rows that a run keeps. Out: by how much the loops open at worst. Never words a message.

use std::ops::Range;

use linkwear_runtime::CLOSED_AT_START;
use nalgebra::DVector;

use super::case::Case;
use super::samples::{ClosedPositions, Ended, Position, STEP, Walker};
use super::stretched::is_stuck;
use super::subspace::{least_norm, nearly_null_space, singular_values};

/// A loop that opens by more than this part of the mechanism is another mechanism, not one drawn with too few digits.
pub const NEARLY: f64 = 1e-3;
/// Openings below this part are rounding.
pub const ROUNDING: f64 = 1e-10;
/// Kept rows whose weakest direction falls below this part of the strongest pass a singular position nearby ...
const WEAK: f64 = 0.1;
/// ... as near as projection follows weak directions.
const WEAKEST: f64 = 1e-4;
/// Residuals that are below this even where they grow most are no opening, whatever the lever arms.
const NOTHING: f64 = 1e-3 * CLOSED_AT_START;

/// A row that opens along the motion.
pub struct Opening {
    /// The row of the description.
    pub row: usize,
    /// By how much [m or rad].
    pub amount: f64,
}

/// The worst opening along the walk, if it is more than a run can take. `keep`: rows that the run keeps closed.
pub fn opens(case: &Case<'_>, positions: &ClosedPositions, keep: &[bool]) -> Option<Opening> {
    let walker = case.walker();
    let along = positions.open.iter().cloned();
    let dropped = keep.contains(&false);
    let kept_only = positions.positions.iter().filter(|_| dropped);
    let residuals =
        along.chain(kept_only.filter_map(|position| with_kept_rows_closed(&walker, position, keep)));
    let worst = residuals.filter_map(|residual| opening(case, positions, &residual));
    let worst = worst.filter(|(part, _)| (CLOSED_AT_START..NEARLY).contains(part));
    let worst = worst.max_by(|(a, _), (b, _)| a.total_cmp(b)).map(|(_, opening)| opening);
    worst.or_else(|| {
        if is_stuck(case, positions) { beside(case, positions, CLOSED_AT_START..f64::INFINITY) } else { None }
    })
}

/// By how much the loops open where they would move, if lengths and axes were a little different: of a structure that is
/// nearly none, or that would leave a `singular` start.
pub fn nearly_moves(case: &Case<'_>, positions: &ClosedPositions, singular: bool) -> Option<Opening> {
    let (start, joint_speeds) = (&positions.positions[0], case.linkage.joint_speeds());
    let jacobian = start.jacobian.select_columns(&joint_speeds);
    let more = nearly_null_space(&jacobian, NEARLY).ncols() > start.freedoms(&joint_speeds).ncols();
    if more || singular { beside(case, positions, ROUNDING..NEARLY) } else { None }
}

/// The worst opening within these parts a step beside the start.
fn beside(case: &Case<'_>, positions: &ClosedPositions, parts: Range<f64>) -> Option<Opening> {
    let walker = case.walker();
    let start = &positions.positions[0];
    let free = nearly_null_space(&start.jacobian.select_columns(&walker.joint_speeds), NEARLY);
    let openings = free.column_iter().filter_map(|direction| {
        let mut q = start.q.clone();
        walker.layout.advance(&mut q, &walker.all_speeds(&(direction * (STEP / direction.amax()))));
        let residual = match walker.close(q, NEARLY)? {
            Ended::Open(residual) => residual,
            Ended::Closed(position) => position.residual,
        };
        opening(case, positions, &residual)
    });
    let openings = openings.filter(|(part, _)| parts.contains(part));
    openings.max_by(|(a, _), (b, _)| a.total_cmp(b)).map(|(_, opening)| opening)
}

/// The largest residual, given in own units: as a part of the mechanism, and as it is.
fn opening(case: &Case<'_>, positions: &ClosedPositions, residual: &DVector<f64>) -> Option<(f64, Opening)> {
    let part = |row: usize| {
        let unit = if case.description.rows[row].angular { 1.0 } else { case.units.length / positions.arm };
        residual[row].abs() * unit
    };
    let row = (0..residual.len()).max_by(|a, b| part(*a).total_cmp(&part(*b)))?;
    Some((part(row), Opening { row, amount: residual[row].abs() * case.units.rows[row] }))
}

/// Residuals of all rows when only the kept ones are closed, as a run does it; where these come near a singular position
/// of their own, what a run meets that passes it.
fn with_kept_rows_closed(walker: &Walker<'_>, position: &Position, keep: &[bool]) -> Option<DVector<f64>> {
    let residual = &position.residual;
    let jacobian = position.jacobian.select_columns(&walker.joint_speeds);
    let kept: Vec<usize> = (0..keep.len()).filter(|row| keep[*row]).collect();
    let rows = jacobian.select_rows(&kept);
    if rows.nrows() == 0 || rows.ncols() == 0 {
        return Some(residual.clone());
    }
    // A row that only modes move has no length of its own.
    let length = |row: usize| Some(rows.length(row)).filter(|length| *length > WEAKEST).unwrap_or(1.0);
    let lengths: Vec<f64> = (0..rows.nrows()).map(length).collect();
    let scaled = rows.scaled(|row, _| 1.0 / lengths[row]);
    let right = DVector::from_fn(kept.len(), |i, _| -residual[kept[i]] / lengths[i]);
    let step = least_norm(&scaled, &right)?;
    let opened = residual + jacobian.times(&step);
    if residual.amax() + (&opened - residual).amax() * (WEAK / WEAKEST) < NOTHING {
        return Some(opened);
    }
    let values = singular_values(&scaled);
    let [strongest, weakest] = [values.first(), values.last()].map(|value| value.copied().unwrap_or(0.0));
    let weak = weakest / strongest.max(f64::MIN_POSITIVE);
    let growth = if weak < WEAK { (weak / WEAKEST).max(1.0) } else { 1.0 };
    // The least opening is that of the position; what the step adds grows.
    Some(residual + (opened - residual) * growth)
}
