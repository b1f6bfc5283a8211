//! Finding the maximum of the likelihood. In: increments, model. Out: the parameters there. Never knows what is done
//! with them.

use super::error::FitError;
use super::exact::{hardly_scatters, has_no_scatter};
use super::model::Model;
use super::point::Point;
use crate::data::{Increment, Known};
use crate::matrix::Factor;

/// Largest coefficient of variation of units that is looked at: all beyond it say the same.
pub const LARGEST_CV: f64 = 1e3;
/// Steps of Newton's method; 5 to 15 are usual.
const MOST_STEPS: usize = 200;
/// What is left to climb below which a top that is none may be taken as one: relative to 1 in the log-likelihood.
const NEARLY_DONE: f64 = 1e-7;
/// By how much ln alpha is raised at most to see whether it has a finite estimate: half the scatter.
const HALF_THE_SCATTER: f64 = 1.4;

/// A start for [`maximise`]: the process's parameters given Lambda, c by a coarse search, no effect of covariates.
pub fn start(model: &Model, increments: &[Increment]) -> Result<Vec<f64>, FitError> {
    // Increments below half the gauge's step enter the start alone as that, bounds from above by their halves.
    let least = model.resolution.map_or(f64::NEG_INFINITY, |rounding| 0.5 * rounding.step);
    let growth: Vec<&Increment> = increments.iter().filter(|increment| increment.is_growth()).collect();
    let part = |one: &Increment| if one.known == Known::Below { 0.5 } else { 1.0 };
    let wears: Vec<f64> = growth.iter().map(|one| (part(one) * one.wear).max(least)).collect();
    let mut best: Option<(f64, Vec<f64>)> = None;
    let exponents: Vec<f64> =
        if model.power_law { (-7..=5).map(|at| libm::exp(f64::from(at) * 0.4)).collect() } else { vec![1.0] };
    for exponent in exponents {
        let mut phi = vec![0.0; model.parameters()];
        if model.power_law {
            phi[2] = exponent;
        }
        let lambdas: Vec<f64> = growth.iter().map(|increment| model.lambda(&phi, increment)).collect();
        let Some(logs) = model.process.maximum(&lambdas, &wears) else { continue };
        phi[..2].copy_from_slice(&logs);
        let value = model.value(&phi, increments);
        if value.is_finite() && best.as_ref().is_none_or(|(known, _)| value > *known) {
            best = Some((value, phi));
        }
    }
    // Where a gauge rounds, readings along a line say no more than that scatter hides in its step.
    let none = if model.resolution.is_some() { FitError::ScatterBelowGauge } else { FitError::NoScatter };
    best.map(|(_, phi)| phi).ok_or(none)
}

/// Newton's method from a start, each step shortened until the likelihood grows; a parameter may be held. With one held the
/// coefficient of variation of units may end at [`LARGEST_CV`]: the likelihood may still rise there, but by nothing that counts.
pub fn maximise(
    model: &Model,
    increments: &[Increment],
    start: &[f64],
    held: Option<usize>,
) -> Result<(Vec<f64>, Point), FitError> {
    let mut phi = start.to_vec();
    climb(model, increments, &mut phi, held).map(|point| (phi.clone(), point)).map_err(|error| match error {
        FitError::NotConverged if held.is_none() => unbounded(model, increments, &phi),
        error => error,
    })
}

/// Why there is no maximum beyond `phi`: there is no scatter, less of it explains readings of a gauge as well, or some other
/// parameter runs off.
pub fn unbounded(model: &Model, increments: &[Increment], phi: &[f64]) -> FitError {
    if model.resolution.is_none() {
        let is_exact = has_no_scatter(model, phi, increments);
        return if is_exact { FitError::NoScatter } else { FitError::NotConverged };
    }
    let here = model.value(phi, increments);
    let mut less = phi.to_vec();
    // The same mean, and then the best one; halfway at most to where the gauge tells no scatter.
    let rise = (0.5 * model.ln_scatter(phi, increments)).min(HALF_THE_SCATTER);
    less.iter_mut().take(2).for_each(|log| *log += rise);
    let same_mean = model.value(&less, increments);
    let best = climb(model, increments, &mut less, Some(0)).map_or(same_mean, |point| point.value);
    if best.max(same_mean) >= here - NEARLY_DONE {
        FitError::ScatterBelowGauge
    } else {
        FitError::NotConverged
    }
}

/// From `phi`, which goes along.
fn climb(
    model: &Model,
    increments: &[Increment],
    phi: &mut Vec<f64>,
    held: Option<usize>,
) -> Result<Point, FitError> {
    let mut here = model.point(phi, increments, held);
    let edge = held.and(model.units_differ.then(|| (phi.len() - 1, libm::log(LARGEST_CV))));
    // Whether there is scatter at all: with a parameter held there was some.
    let mut is_asked = held.is_some();
    for _ in 0..MOST_STEPS {
        let at_edge = edge.filter(|(cv, most)| phi[*cv] >= *most && here.gradient[*cv] > 0.0);
        let is_free = |at: &usize| Some(*at) != held && Some(*at) != at_edge.map(|(cv, _)| cv);
        let free: Vec<usize> = (0..phi.len()).filter(is_free).collect();
        let gradient: Vec<f64> = free.iter().map(|at| here.gradient[*at]).collect();
        let Some(step) = ascent(&here, &free, &gradient) else { return Err(FitError::NotConverged) };
        let gain: f64 = step.iter().zip(&gradient).map(|(s, g)| s * g).sum();
        // Half the gain is what is left to climb: relative to 1 in the log-likelihood, far below a standard error.
        let done = gain < 1e-13;
        // With a parameter held the likelihood alone is asked for.
        if done && held.is_some() {
            return Ok(here);
        }
        // No two e-folds at once: far from the top the quadratic model means nothing.
        let mut length = 2.0 / step.iter().fold(2.0_f64, |most, s| most.max(s.abs()));
        loop {
            let mut next = phi.clone();
            for (at, step) in free.iter().zip(&step) {
                next[*at] += length * step;
            }
            if let Some((cv, most)) = edge.filter(|(cv, _)| Some(*cv) != held) {
                next[cv] = next[cv].min(most);
            }
            let usable = !model.power_law || next[2] > 0.0;
            let there = usable.then(|| model.point(&next, increments, held));
            let slack = 1e-12 * here.value.abs().max(1.0);
            if let Some(there) = there.filter(|there| there.value >= here.value - slack) {
                (*phi, here) = (next, there);
                break;
            }
            length *= 0.5;
            if length < 1e-9 {
                return if gain < NEARLY_DONE { Ok(here) } else { Err(FitError::NotConverged) };
            }
        }
        if done {
            return Ok(here);
        }
        if model.ln_scatter(phi, increments) < 0.0 {
            return Err(FitError::ScatterBelowGauge);
        }
        if !is_asked && hardly_scatters(model, phi, increments) {
            is_asked = true;
            if has_no_scatter(model, phi, increments) {
                return Err(FitError::NoScatter);
            }
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
    use crate::data::Rounding;
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
                ..Increment::default()
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

    #[test]
    fn a_climb_to_no_scatter_at_all_says_so() {
        // Twelve increments 3 (to^c - from^c) load^b; c lies beside every exponent that the start tries.
        let exact = |at: u32, c: f64, b: f64| {
            let (from, load) = (f64::from(at % 4), f64::from(1 + at / 4));
            let wear = 3.0 * ((from + 1.0).powf(c) - from.powf(c)) * load.powf(b);
            let unit = (at / 4) as usize;
            let ln_covariates = vec![load.ln()];
            Increment { unit, from, to: from + 1.0, wear, ln_covariates, row: 0, ..Increment::default() }
        };
        let fitted = |model: &Model, increments: &[Increment]| {
            start(model, increments).and_then(|phi| maximise(model, increments, &phi, None)).map(drop)
        };
        for process in PROCESSES {
            let plain = Model { process, ..Model::default() };
            let power = Model { power_law: true, ..plain };
            for (c, b, model) in [
                (0.7, 0.0, power),
                // The start tries this one and passes over it.
                (1.0, 0.0, power),
                (1.0, 0.6, Model { covariates: 1, ..plain }),
                (1.0, 0.6, Model { sizes: 1, ..plain }),
                (0.7, 0.6, Model { covariates: 1, ..power }),
            ] {
                let mut increments: Vec<Increment> = (0..12).map(|at| exact(at, c, b)).collect();
                assert_eq!(fitted(&model, &increments), Err(FitError::NoScatter), "{model:?} {c} {b}");
                // A scatter of a hundredth is one.
                increments.iter_mut().step_by(3).for_each(|one| one.wear *= 1.01);
                assert_eq!(fitted(&model, &increments), Ok(()), "{model:?} {c} {b}");
            }
        }
    }

    /// Units of four increments of exposure 1 from new, read to whole steps.
    fn whole_steps(wears: &[[i32; 4]]) -> Vec<Increment> {
        let one = |(at, wear): (usize, &i32)| {
            let from = (at % 4) as f64;
            Increment {
                unit: at / 4,
                from,
                to: from + 1.0,
                wear: (*wear).into(),
                ln_covariates: vec![],
                row: 0,
                ..Increment::default()
            }
        };
        wears.iter().flatten().enumerate().map(one).collect()
    }

    #[test]
    fn fits_without_a_maximum_say_what_runs_off() {
        let rounded = Model { resolution: Some(Rounding::to(1.0)), ..Model::default() };
        let fitted = |model: &Model, wears: &[[i32; 4]]| {
            let increments = whole_steps(wears);
            let phi = start(model, &increments)?;
            maximise(model, &increments, &phi, None).map(drop)
        };
        // A line explains them for certain, and one through the edge of a step as well as any scatter does; both were said to run
        // off in some parameter.
        let line = [[1; 4]; 8];
        let mut edge = line;
        (edge[3], edge[5]) = ([1, 1, 1, 2], [1, 1, 1, 2]);
        for wears in [line, edge] {
            assert_eq!(fitted(&rounded, &wears), Err(FitError::ScatterBelowGauge), "{wears:?}");
            let near = [20.0_f64.ln(); 2];
            let found = maximise(&rounded, &whole_steps(&wears), &near, None);
            assert_eq!(found.map(drop), Err(FitError::ScatterBelowGauge), "{wears:?}");
        }
        // All wear within the last span: the exponent runs off, whatever the scatter.
        let power = Model { power_law: true, ..rounded };
        let late = [[0, 0, 0, 9], [0, 0, 0, 4], [0, 0, 0, 14], [0, 0, 0, 7]];
        assert_eq!(fitted(&power, &late), Err(FitError::NotConverged));
    }
}
