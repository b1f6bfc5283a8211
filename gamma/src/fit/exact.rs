//! Wear that is an exact function of Lambda. In: increments, parameters near those. Out: whether any scatter is left. Never knows the
//! likelihood.
//!
//! At such an exponent, or power of a covariate, the likelihood grows without end as the scatter of the process vanishes. A climb
//! comes near in a few steps, and then creeps. Least squares of ln wear go there at once.

use super::model::{Model, units};
use crate::data::Increment;
use crate::matrix::Factor;
use crate::process::scatters;

/// Variance of an increment over its squared mean, by the parameters that a climb has come to, below which the data are asked: readings
/// hardly ever scatter so little, and least squares converge from there.
const SUSPECT: f64 = 1e-4;
/// Turns of least squares; each squares what is left, so that four are enough.
const TURNS: usize = 8;

/// Whether no increment scatters by more than a hundredth. With a gauge's resolution never: its own edge comes before.
pub fn hardly_scatters(model: &Model, phi: &[f64], increments: &[Increment]) -> bool {
    model.resolution.is_none()
        && increments.iter().filter(|one| one.is_exact()).all(|one| {
            let logs = model.logs(phi, one);
            let mean = libm::exp(model.process.ln_mean(logs));
            model.process.variance(logs) < SUSPECT * mean * mean
        })
}

/// Whether there are an exponent and powers near those of `phi` by which wear follows Lambda but for rounding.
pub fn has_no_scatter(model: &Model, phi: &[f64], increments: &[Increment]) -> bool {
    let exact = increments.iter().filter(|one| one.is_exact());
    let exact: Vec<Increment> = exact.cloned().collect();
    // Each unit has a rate of its own where units differ.
    let lines: Vec<&[Increment]> =
        if model.units_differ { units(&exact).collect() } else { vec![exact.as_slice()] };
    let mut phi = phi.to_vec();
    for _ in 0..TURNS {
        if lines.iter().all(|line| is_line(model, &phi, line)) {
            return true;
        }
        let Some(step) = step(model, &phi, &lines) else { return false };
        phi.iter_mut().skip(2).zip(step).for_each(|(value, step)| *value += step);
        if model.power_law && phi[2] <= 0.0 {
            return false;
        }
    }
    false
}

/// Whether wear, at a common size, is proportional to Lambda.
fn is_line(model: &Model, phi: &[f64], increments: &[Increment]) -> bool {
    let at = |one: &Increment| (model.lambda(phi, one), one.wear * libm::exp(-model.ln_size(phi, one)));
    let (exposure, wear) = increments.iter().map(at).fold((0.0, 0.0), |sum, (l, w)| (sum.0 + l, sum.1 + w));
    let rate = wear / exposure;
    let scatter: f64 = increments.iter().map(at).map(|(l, w)| (w - rate * l) * (w - rate * l) / l).sum();
    // Not a number is no line either.
    scatter.is_finite() && !scatters(scatter, rate * wear)
}

/// The change of exponent and powers by which ln wear is nearest to what they make of it, beside a rate for each line; None where
/// wear is not positive, or does not tell them.
fn step(model: &Model, phi: &[f64], lines: &[&[Increment]]) -> Option<Vec<f64>> {
    let size = model.parameters() - 2 - usize::from(model.units_differ);
    let mut matrix = vec![vec![0.0; size]; size];
    let mut right = vec![0.0; size];
    for line in lines {
        let rows: Vec<Vec<f64>> = line.iter().map(|one| row(model, phi, one)).collect();
        let mean = |at: usize| rows.iter().map(|row| row[at]).sum::<f64>() / rows.len() as f64;
        let means: Vec<f64> = (0..=size).map(mean).collect();
        for row in &rows {
            let off = |at: usize| row[at] - means[at];
            for i in 0..size {
                (0..size).for_each(|j| matrix[i][j] += off(i) * off(j));
                right[i] += off(i) * off(size);
            }
        }
    }
    let step = Factor::definite(&matrix)?.solve(&right)?;
    step.iter().all(|one| one.is_finite()).then_some(step)
}

/// Slopes of the ln of the mean by exponent and powers, and what ln wear is above it, but for the rate.
fn row(model: &Model, phi: &[f64], one: &Increment) -> Vec<f64> {
    let (ln_lambda, mut row, _) = model.ln_lambda(phi, one);
    row.extend(one.ln_covariates.iter().skip(model.covariates).take(model.sizes));
    row.push(libm::log(one.wear) - ln_lambda - model.ln_size(phi, one));
    row
}
