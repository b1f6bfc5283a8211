//! Speeds that keep the loops closed, nearest to the wish. In: a closed position. Out: speeds.

use super::held::conflicts;
use super::state::State;
use super::units::Units;
use crate::error::AssemblyError;
use crate::evaluate::Evaluator;
use crate::linear::{Shortest, add_scaled, largest};

/// Largest residual [rad/s, own units of length per second] per unit of the largest speed (at least 1).
const CONSISTENT: f64 = 1e-10;
/// Singular values below this part of the largest count as zero.
const TOLERANCE: f64 = 1e-10;

/// Minimises |v - wish| subject to the velocity rows, held speeds exact.
pub(super) fn consistent(
    evaluator: &mut Evaluator<'_>,
    t: f64,
    q: &[f64],
    wish: &[f64],
) -> Result<Vec<f64>, AssemblyError> {
    let held: Vec<bool> = evaluator.description().speeds.iter().map(|speed| speed.held).collect();
    let units = Units::new(evaluator, t, q, wish);
    let (v, worst, residual) = solve(evaluator, t, q, wish, &held, &units);
    let pure =
        |v: &[f64]| largest(&v.iter().zip(&units.speeds).map(|(v, unit)| v / unit).collect::<Vec<_>>());
    let limit = CONSISTENT * pure(wish).max(pure(&v)).max(1.0);
    if residual <= limit {
        return Ok(v);
    }
    let joint = evaluator.kept().get(worst).map(|row| evaluator.joint_of_row(*row)).unwrap_or_default();
    if residual.is_nan() {
        return Err(AssemblyError::NonFinite { what: format!("speed residual of {joint}") });
    }
    if held.contains(&true) {
        let (free, _, open) = solve(evaluator, t, q, wish, &vec![false; held.len()], &units);
        if open <= limit {
            // Far above rounding, far below what a user would call different.
            let slack = |wish: f64| 1e-8 * wish.abs().max(1.0);
            let names = conflicts(&evaluator.description().speeds, wish, &free, slack);
            return Err(AssemblyError::HeldSpeeds { names, joint, residual });
        }
    }
    Err(AssemblyError::SpeedsImpossible { joint, residual })
}

/// The nearest speeds that keep the loops closed, where those of a state do not; nothing if there are none.
pub(super) fn where_open(evaluator: &mut Evaluator<'_>, t: f64, state: &State) -> Option<Vec<f64>> {
    let open = largest(evaluator.closure(t, &state.q, &state.v).speeds);
    if open <= CONSISTENT * largest(&state.v).max(1.0) {
        return None;
    }
    consistent(evaluator, t, &state.q, &state.v).ok()
}

/// Speeds, kept row with the largest residual left, and that residual in the units given.
fn solve(
    evaluator: &mut Evaluator<'_>,
    t: f64,
    q: &[f64],
    wish: &[f64],
    held: &[bool],
    units: &Units,
) -> (Vec<f64>, usize, f64) {
    let (n, m) = (wish.len(), evaluator.sizes().rows);
    let mut v = wish.to_vec();
    let mut delta = vec![0.0; n];
    let mut decomposition: Option<Shortest> = None;
    let kept = evaluator.kept().to_vec();
    // Rows that no speed moves, which plane mechanisms have many of, ask for nothing.
    let mut rows: Vec<usize> = Vec::new();
    // The second pass removes what rounding of a large first correction left; its rows are the same.
    for pass in 0..2 {
        let closure = evaluator.closure(t, q, &v);
        if pass == 0 {
            let mut jacobian = closure.jacobian.to_vec();
            units.scale(&mut jacobian, kept.iter().copied());
            if n > 0 {
                for row in jacobian.chunks_exact_mut(n) {
                    row.iter_mut().zip(held).filter(|(_, held)| **held).for_each(|(entry, _)| *entry = 0.0);
                }
            }
            rows.extend((0..m).filter(|row| jacobian[row * n..][..n].iter().any(|entry| *entry != 0.0)));
            let rests = rows.iter().all(|row| closure.speeds[*row] == 0.0);
            if rests {
                // Nothing to correct, as of every mechanism that starts at rest.
                break;
            }
            for (place, row) in rows.iter().enumerate() {
                jacobian.copy_within(row * n..(row + 1) * n, place * n);
            }
            decomposition = Some(Shortest::new(&jacobian[..rows.len() * n], rows.len(), n, TOLERANCE));
        }
        let Some(decomposition) = &mut decomposition else { break };
        let right: Vec<f64> = rows.iter().map(|row| -closure.speeds[*row] * units.rows[kept[*row]]).collect();
        decomposition.solve(&right, &mut delta);
        units.restore(&mut delta);
        add_scaled(&mut v, 1.0, &delta);
    }
    let left = evaluator.closure(t, q, &v).speeds.iter().zip(&kept);
    let left: Vec<f64> = left.map(|(speed, row)| speed * units.rows[*row]).collect();
    let residual = largest(&left);
    let worst = left.iter().position(|x| x.abs() >= residual || x.is_nan()).unwrap_or(0);
    (v, worst, residual)
}
