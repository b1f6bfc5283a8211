//! Whether loops are stretched to their limit, or folded to it: they close as they are drawn, and nowhere beside it.
//! In: closed positions. Out: the row that holds most. Never words a message.
//!
//! Motions `d` that the Jacobian of the rows allows open the loops by `B(d, d)` to second order. What other motions cannot take back of
//! it has to vanish. Where a combination of rows gives the same sign to all `d`, no motion exists.

use nalgebra::{DMatrix, DVector};

use crate::decompose::symmetric_directions;

use super::case::Case;
use super::samples::{ClosedPositions, Position, STEP, Walker};
use super::subspace::least_norm;

/// Positions within this part of a step from the start are the start.
const AWAY: f64 = 0.2;
/// Step of the second differences [rad, own units]: rounding leaves 1e-12 of them, and terms of fourth order 1e-5.
const DIFFERENCE: f64 = 1e-2;
/// Openings to second order below this part of the largest are errors of the differences.
const CLEARLY: f64 = 1e-3;
/// Openings to second order [own units/rad^2] that lengths make are larger: a loop that opens by less has axes that are a little off.
const BY_LENGTHS: f64 = 2e-2;

/// Whether no position was found away from the start, though the loops seem to let it go.
pub fn is_stuck(case: &Case<'_>, positions: &ClosedPositions) -> bool {
    let start = &positions.positions[0];
    let near = |position: &Position| distance(case, &start.q, &position.q) < AWAY * STEP;
    start.freedoms(&case.linkage.joint_speeds()).ncols() > 0 && positions.positions.iter().all(near)
}

/// The row that holds most where a loop is stretched to its limit.
pub fn stretched(case: &Case<'_>, positions: &ClosedPositions) -> Option<usize> {
    if !is_stuck(case, positions) {
        return None;
    }
    let walker = case.walker();
    let start = &positions.positions[0];
    let free = start.freedoms(&walker.joint_speeds);
    let directions: Vec<DVector<f64>> = free.column_iter().map(|column| column.clone_owned()).collect();
    let n = directions.len();
    let mut openings: Vec<Vec<DVector<f64>>> = Vec::with_capacity(n);
    for (i, one) in directions.iter().enumerate() {
        let along = |other: &DVector<f64>| opening(&walker, start, other);
        let row: Option<Vec<_>> = directions[..=i]
            .iter()
            .map(|other| Some((along(&(one + other))? - along(&(one - other))?) * 0.25))
            .collect();
        openings.push(row?);
    }
    // Each motion proposes a combination of rows, and all of them together one more.
    let own: Vec<&DVector<f64>> = (0..n).map(|i| &openings[i][i]).collect();
    let sum = own.iter().fold(DVector::zeros(start.residual.len()), |sum, opening| sum + *opening);
    let mut rows = own.into_iter().cloned().chain([sum]);
    let held = rows.find(|rows| {
        let by = DMatrix::from_fn(n, n, |i, j| rows.dot(&openings[i.max(j)][i.min(j)]));
        let Some(eigen) = symmetric_directions(by) else { return false };
        let largest = eigen.eigenvalues.amax();
        largest > BY_LENGTHS * BY_LENGTHS && eigen.eigenvalues.min() > CLEARLY * largest
    })?;
    Some(held.iamax())
}

/// By how much the rows open along a motion to second order, less what other motions take back.
fn opening(walker: &Walker<'_>, start: &Position, direction: &DVector<f64>) -> Option<DVector<f64>> {
    let residual = |amount: f64| {
        let mut q = start.q.clone();
        walker.layout.advance(&mut q, &walker.all_speeds(&(direction * amount)));
        walker.equations(&q).0
    };
    let [ahead, behind] = [DIFFERENCE, -DIFFERENCE].map(residual);
    let second = (ahead + behind - 2.0 * &start.residual) / (DIFFERENCE * DIFFERENCE);
    let jacobian = start.jacobian.select_columns(&walker.joint_speeds);
    let back = least_norm(&jacobian, &second)?;
    Some(second - jacobian.times(&back))
}

/// Largest difference of two positions [rad, own units].
fn distance(case: &Case<'_>, from: &[f64], to: &[f64]) -> f64 {
    let unit = |unit: &str| if unit == "m" { case.units.length } else { 1.0 };
    let differences = from.iter().zip(to).zip(&*case.description.coordinates);
    differences.map(|((a, b), info)| (a - b).abs() / unit(&info.unit)).fold(0.0, f64::max)
}
