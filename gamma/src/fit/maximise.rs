//! Finding the maximum of the likelihood. In: increments, model. Out: the parameters there. Never knows what is done
//! with them.

use super::error::FitError;
use super::model::{Model, Point};
use crate::data::Increment;
use crate::matrix::Factor;

/// Steps of Newton's method; 5 to 15 are usual.
const MOST_STEPS: usize = 200;

/// A start for [`maximise`]: the process's parameters given Lambda, c by a coarse search, no effect of covariates.
pub fn start(model: &Model, increments: &[Increment]) -> Result<Vec<f64>, FitError> {
    // Increments below half the gauge's step enter the start alone as that.
    let least = model.resolution.map_or(f64::NEG_INFINITY, |rounding| 0.5 * rounding.step);
    let wears: Vec<f64> = increments.iter().map(|increment| increment.wear.max(least)).collect();
    let mut best: Option<(f64, Vec<f64>)> = None;
    let exponents: Vec<f64> =
        if model.power_law { (-7..=5).map(|at| libm::exp(f64::from(at) * 0.4)).collect() } else { vec![1.0] };
    for exponent in exponents {
        let mut phi = vec![0.0; model.parameters()];
        if model.power_law {
            phi[2] = exponent;
        }
        let lambdas: Vec<f64> = increments.iter().map(|increment| model.lambda(&phi, increment)).collect();
        let Some(logs) = model.process.maximum(&lambdas, &wears) else { continue };
        phi[..2].copy_from_slice(&logs);
        let value = model.value(&phi, increments);
        if value.is_finite() && best.as_ref().is_none_or(|(known, _)| value > *known) {
            best = Some((value, phi));
        }
    }
    best.map(|(_, phi)| phi).ok_or(FitError::NoScatter)
}

/// Newton's method from a start, each step shortened until the likelihood grows; a parameter may be held.
pub fn maximise(
    model: &Model,
    increments: &[Increment],
    start: &[f64],
    held: Option<usize>,
) -> Result<(Vec<f64>, Point), FitError> {
    let mut phi = start.to_vec();
    let mut here = model.point(&phi, increments, held);
    let free: Vec<usize> = (0..phi.len()).filter(|at| Some(*at) != held).collect();
    for _ in 0..MOST_STEPS {
        let gradient: Vec<f64> = free.iter().map(|at| here.gradient[*at]).collect();
        let Some(step) = ascent(&here, &free, &gradient) else { return Err(FitError::NotConverged) };
        let gain: f64 = step.iter().zip(&gradient).map(|(s, g)| s * g).sum();
        // Half the gain is what is left to climb: relative to 1 in the log-likelihood, far below a standard error.
        let done = gain < 1e-13;
        // No two e-folds at once: far from the top the quadratic model means nothing.
        let mut length = 2.0 / step.iter().fold(2.0_f64, |most, s| most.max(s.abs()));
        loop {
            let mut next = phi.clone();
            for (at, step) in free.iter().zip(&step) {
                next[*at] += length * step;
            }
            let usable = !model.power_law || next[2] > 0.0;
            let there = usable.then(|| model.point(&next, increments, held));
            let slack = 1e-12 * here.value.abs().max(1.0);
            if let Some(there) = there.filter(|there| there.value >= here.value - slack) {
                (phi, here) = (next, there);
                break;
            }
            length *= 0.5;
            if length < 1e-9 {
                return if gain < 1e-7 { Ok((phi, here)) } else { Err(FitError::NotConverged) };
            }
        }
        if done {
            return Ok((phi, here));
        }
        if model.has_no_scatter(&phi, increments) {
            return Err(FitError::ScatterBelowGauge);
        }
    }
    Err(FitError::NotConverged)
}

/// Newton's step among the free parameters; where the likelihood is not concave, the information is raised until it is.
fn ascent(here: &Point, free: &[usize], gradient: &[f64]) -> Option<Vec<f64>> {
    let scale = free.iter().map(|at| here.information[*at][*at].abs()).fold(1e-12, f64::max);
    let mut raised = 0.0;
    for _ in 0..40 {
        let matrix: Vec<Vec<f64>> = free
            .iter()
            .map(|i| {
                let entry = |j: &usize| here.information[*i][*j] + if i == j { raised } else { 0.0 };
                free.iter().map(entry).collect()
            })
            .collect();
        if let Some(step) = Factor::definite(&matrix).and_then(|factor| factor.solve(gradient)) {
            return Some(step);
        }
        raised = if raised == 0.0 { 1e-6 * scale } else { 4.0 * raised };
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::process::PROCESSES;

    #[test]
    fn parameters_given_lambda_are_the_maximum_of_the_full_likelihood() {
        let wears = [1.2, 0.7, 2.4, 0.9, 1.6];
        let spans = [1.0, 0.5, 2.0, 1.0, 1.5];
        let increments: Vec<Increment> = wears
            .iter()
            .zip(spans)
            .map(|(wear, to)| Increment {
                unit: 0,
                from: 0.0,
                to,
                wear: *wear,
                ln_covariates: vec![],
                row: 0,
            })
            .collect();
        for process in PROCESSES {
            let model = Model { process, ..Model::default() };
            let logs = process.maximum(&spans, &wears).unwrap();
            let (phi, _) = maximise(&model, &increments, &[0.0, 0.0], None).unwrap();
            // Newton ends at a gain of 1e-13, squared once more by its last step.
            for (found, logs) in phi.iter().zip(logs) {
                assert!((found - logs).abs() < 1e-11, "{process:?}: {phi:?} {logs}");
            }
        }
    }
}
