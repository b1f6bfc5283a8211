//! Least squares within bounds. In: a problem, a start. Out: the nearest minimum. Never knows what residuals are of.
//!
//! Levenberg-Marquardt with Nielsen's damping (Madsen, Nielsen & Tingleff, Methods for non-linear least squares problems, 2nd ed.,
//! 2004, 3.2), on the parameters that are not held by a bound; steps end at bounds.

use nalgebra::{DMatrix, DVector};

use super::differences::jacobian;
use super::errors::ModelFault;
use super::problem::Problem;

/// A minimum, or how far a search came.
#[derive(Clone, Debug)]
pub(super) struct Found {
    pub places: Vec<f64>,
    pub residuals: DVector<f64>,
    /// Whether it came to rest.
    pub converged: bool,
}

impl Found {
    /// Sum of the squares.
    pub fn squares(&self) -> f64 {
        self.residuals.norm_squared()
    }
}

/// Steps of a search.
const MOST: usize = 60;
/// A step that promises less than this part of the noise's variance moves no parameter by a thousandth of its error.
const REST: f64 = 1e-6;
/// Residuals of this size, in units of the readings' noise, are those of a perfect model.
const PERFECT: f64 = 1e-10;
/// Damping beyond which no step is left.
const STUCK: f64 = 1e14;

/// From a start down; a parameter may be held where it is.
pub(super) fn minimise(
    problem: &Problem<'_>,
    start: Vec<f64>,
    (lengths, fixed): (&[f64], Option<usize>),
) -> Result<Found, ModelFault> {
    let residuals = problem.residuals(&start)?;
    let mut found = Found { places: start, residuals, converged: false };
    let degrees = found.residuals.len().saturating_sub(found.places.len()).max(1) as f64;
    let (mut damping, mut growth) = (1e-3, 2.0);
    'steps: for _ in 0..MOST {
        let slopes = jacobian(problem, &found.places, &found.residuals, (lengths, fixed))?;
        let gradient = slopes.tr_mul(&found.residuals);
        let normal = slopes.tr_mul(&slopes);
        let scale: Vec<f64> = normal.diagonal().iter().copied().collect();
        let moving: Vec<usize> = (0..found.places.len())
            .filter(|at| fixed != Some(*at) && scale[*at] > 0.0 && !is_held(found.places[*at], gradient[*at]))
            .collect();
        if moving.is_empty() {
            found.converged = true;
            break;
        }
        while damping <= STUCK {
            let Some(step) = step(&normal, &gradient, &moving, damping) else {
                damping *= 10.0;
                continue;
            };
            let places: Vec<f64> = (0..found.places.len())
                .map(|at| {
                    let step = moving.iter().position(|one| *one == at).map_or(0.0, |one| step[one]);
                    (found.places[at] + step).clamp(0.0, 1.0)
                })
                .collect();
            let taken = DVector::from_iterator(
                places.len(),
                places.iter().zip(&found.places).map(|(to, from)| to - from),
            );
            let promised = -(2.0 * gradient.dot(&taken) + taken.dot(&(&normal * &taken)));
            let rest = (REST * found.squares() / degrees).max(PERFECT * PERFECT);
            if promised <= rest && damping <= 1.0 {
                found.converged = true;
                break 'steps;
            }
            match problem.residuals(&places) {
                Ok(residuals) if residuals.norm_squared() < found.squares() => {
                    let gained = found.squares() - residuals.norm_squared();
                    let ratio = if promised > 0.0 { gained / promised } else { 1.0 };
                    damping *= (1.0 - (2.0 * ratio - 1.0).powi(3)).max(1.0 / 3.0);
                    growth = 2.0;
                    (found.places, found.residuals) = (places, residuals);
                    break;
                }
                Err(ModelFault::Interrupted) => return Err(ModelFault::Interrupted),
                _ => {
                    damping *= growth;
                    growth *= 2.0;
                }
            }
        }
        if damping > STUCK {
            // No step leads down: the minimum, as far as runs tell one value from the next.
            found.converged = true;
            break;
        }
    }
    Ok(found)
}

/// Whether a bound keeps a parameter from where the slope leads.
pub(super) fn is_held(place: f64, gradient: f64) -> bool {
    (place <= 0.0 && gradient > 0.0) || (place >= 1.0 && gradient < 0.0)
}

/// The damped step of the parameters that move; none where the equations have no solution.
fn step(
    normal: &DMatrix<f64>,
    gradient: &DVector<f64>,
    moving: &[usize],
    damping: f64,
) -> Option<DVector<f64>> {
    let damped = DMatrix::from_fn(moving.len(), moving.len(), |i, j| {
        let entry = normal[(moving[i], moving[j])];
        if i == j { entry * (1.0 + damping) } else { entry }
    });
    let right = DVector::from_iterator(moving.len(), moving.iter().map(|at| -gradient[*at]));
    damped.cholesky().map(|factor| factor.solve(&right))
}
