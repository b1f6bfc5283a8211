//! The dead point behind a run that cannot go on. In: the last good state, and the error. Out: the driver that the loops
//! let go no further, with time and place, or the error as it was. Never integrates.

use super::motion::ConstrainedMotion;
use crate::assemble::close_loops;
use crate::error::RunError;
use crate::linear::{Lu, dot, largest};

/// A dead point is looked for as far ahead as the fastest driver moves by this [rad, longest lever arms]: fixed steps end
/// a whole step before it.
const AHEAD: f64 = 0.05;
/// Halvings of that stretch: the dead point is known to a part in 1e12 of it.
const HALVINGS: usize = 40;
/// Inverse iterations for the direction that the loops forbid; each gains the ratio of two singular values, squared.
const ITERATIONS: usize = 4;

/// Names the dead point if there is one just ahead of the coordinates reached at `t`.
pub(super) fn explain(
    motion: &mut ConstrainedMotion<'_>,
    (t, q): (f64, &[f64]),
    error: RunError,
) -> RunError {
    let failed_at = match &error {
        RunError::StepTooSmall { t, .. }
        | RunError::LostAssembly { t, .. }
        | RunError::BranchChange { t, .. }
        | RunError::NonFinite { t, .. }
        | RunError::EnergyLost { t, .. }
        | RunError::NoProgress { t, .. }
        | RunError::NewtonFailed { t, .. } => *t,
        _ => return error,
    };
    find(motion, (t, q), failed_at).unwrap_or(error)
}

fn find(motion: &mut ConstrainedMotion<'_>, (t, q): (f64, &[f64]), failed_at: f64) -> Option<RunError> {
    let arm = motion.arm;
    let evaluator = &mut motion.dynamics.evaluator;
    let drivers = &evaluator.description().drivers;
    let own = |rates: &[f64], driver: usize| {
        rates[3 * driver + 1].abs() / if drivers[driver].angular { 1.0 } else { arm }
    };
    let rates = evaluator.prescribed(t).to_vec();
    let fastest = (0..drivers.len()).map(|driver| own(&rates, driver)).fold(0.0, f64::max);
    let ahead = AHEAD / fastest;
    if !ahead.is_finite() {
        return None;
    }
    let nothing = vec![false; q.len()];
    // Clearances let a driver go a little beyond the dead point.
    let begins = [t, t - ahead];
    let found = begins.into_iter().find_map(|t| Some((close_loops(evaluator, t, q, &nothing).ok()?, t)));
    let ((mut q, mut closed), mut open) = (found?, failed_at.max(t) + ahead);
    if close_loops(evaluator, open, &q, &nothing).is_ok() {
        return None;
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (closed + open);
        match close_loops(evaluator, middle, &q, &nothing) {
            Ok(found) => (q, closed) = (found, middle),
            Err(_) => open = middle,
        }
    }
    let forbidden = forbidden(motion, closed, &q);
    let evaluator = &mut motion.dynamics.evaluator;
    let laws = evaluator.prescribed(closed).to_vec();
    let worst = |driver: &usize| forbidden[*driver] * laws[3 * driver + 1].abs();
    let driver = (0..drivers.len()).max_by(|a, b| worst(a).total_cmp(&worst(b)))?;
    Some(RunError::DeadPoint {
        t: closed,
        joint: drivers[driver].joint.to_string(),
        position: laws[3 * driver],
        angular: drivers[driver].angular,
    })
}

/// How strongly the loops forbid every driver to move: its part in the constraint that the free joints cannot follow.
fn forbidden(motion: &mut ConstrainedMotion<'_>, t: f64, q: &[f64]) -> Vec<f64> {
    let evaluator = &mut motion.dynamics.evaluator;
    let sizes = evaluator.sizes();
    let all = sizes.all_speeds;
    let (_, driven) = evaluator.layout().speed_places(sizes.drivers);
    let (mut all_q, mut all_v) = (vec![0.0; sizes.all_coordinates], vec![0.0; all]);
    evaluator.expand(t, q, &vec![0.0; sizes.speeds], &mut all_q, &mut all_v);
    let free = evaluator.closure(t, q, &vec![0.0; sizes.speeds]).jacobian.to_vec();
    let (kept, scales) = (evaluator.kept().to_vec(), evaluator.row_scales().to_vec());
    let rows: Vec<&[f64]> = free.chunks_exact(sizes.speeds.max(1)).collect();
    let m = rows.len();
    let entry = |i: usize, j: usize| scales[i] * scales[j] * dot(rows[i], rows[j]);
    let mut gram: Vec<f64> = (0..m * m).map(|at| entry(at / m, at % m)).collect();
    // At the dead point itself the matrix has no inverse; a shift by rounding keeps its directions.
    let shift = f64::EPSILON * largest(&gram);
    (0..m).for_each(|i| gram[i * m + i] += shift);
    let mut inverse = Lu::new(m);
    inverse.factor(&gram);
    let mut direction: Vec<f64> = (0..m).map(|i| 1.0 + i as f64 / m as f64).collect();
    for _ in 0..ITERATIONS {
        inverse.solve(&mut direction);
        let size = largest(&direction);
        direction.iter_mut().for_each(|x| *x /= size);
    }
    let jacobian = evaluator.equations(t, &all_q, &all_v).jacobian;
    let amounts: Vec<f64> = direction.iter().zip(&scales).map(|(x, scale)| x * scale).collect();
    let part = |place: &usize| -> f64 {
        kept.iter().zip(&amounts).map(|(row, amount)| jacobian[row * all + place] * amount).sum()
    };
    driven.iter().map(|place| part(place).abs()).collect()
}
