//! What data leave open of the parameters of any model: weighted sets of them. In: increments, a model and its maximum. Out: the
//! posterior under a prior without information, as sets of parameters whose weights sum to 1. Never knows what is predicted.
//!
//! The prior is that of the exact posterior: flat in the logarithms and in the powers of covariates, weighed by
//! [`crate::process::Process::ln_matching_weight`]. A gauge that rounds says little of a scatter far below its step: the prior falls
//! there, as the information does; flat, it would leave all weight on no scatter at all. Where exposure counts by a power, the
//! parameters that it is flat in are those over the largest exposure, so that it is the same in every unit of exposure.
//!
//! Importance sampling: points of a lattice, carried over to Student's law around the maximum, whose tails are wider than those
//! of any posterior with more increments than parameters. After few increments that is too narrow all the same: posteriors are skew, and
//! few points lie in their longer tail. So the sets that count come from a second round, around the mean of the first.

use super::model::Model;
use crate::data::{Increment, Known};
use crate::matrix::Factor;
use crate::process::{Reference, sheared};

/// Sets tried of exact readings, for two parameters, three, and more: with four times as many the ends of intervals move by up to
/// 3 % of their distance after 12 increments (tests below), to and fro from data to data.
const TRIED: [usize; 3] = [1024, 1024, 2048];
/// The same of rounded readings, whose likelihood costs a thousand times as much.
const TRIED_ROUNDED: [usize; 3] = [512, 1024, 2048];
/// Weight, beside the largest, below which a set is left out: thousands of them are less than 1e-3 of all, and in truth 1e-5.
const NEGLIGIBLE: f64 = 1e-7;
/// Part of the sets tried that as many of equal weight would replace, below which the next round tries where these are.
const ENOUGH: f64 = 0.2;
/// Rounds, two at least, after which the sets are no picture of the posterior.
const ROUNDS: usize = 4;

/// Logarithms of the process's parameters, of the exponent if it was estimated, then the powers of covariates; a probability.
type Set = (Vec<f64>, f64);

/// The posterior of a model's parameters around the maximum `phi`, by the covariance there; None where it is too unlike any
/// Student's law to be told by some hundred sets.
pub fn parameter_sets(
    model: &Model,
    increments: &[Increment],
    phi: &[f64],
    covariance: &[Vec<f64>],
) -> Option<Vec<Set>> {
    let tried = if model.resolution.is_some() { TRIED_ROUNDED } else { TRIED };
    let tried = tried[phi.len().clamp(2, 4) - 2];
    if !model.power_law {
        return sets_of(model, increments, (phi, covariance), tried);
    }
    let most = increments.iter().map(|one| one.to).fold(0.0, f64::max);
    let reference = Reference::exposure(model.process, most);
    let increments: Vec<Increment> = increments.iter().map(|one| counted(one, &reference)).collect();
    let mut taken = phi.to_vec();
    reference.taken(&mut taken, phi[2]);
    let covariance = sheared(covariance, reference.slopes());
    let mut sets = sets_of(model, &increments, (&taken, &covariance), tried)?;
    for (logs, _) in &mut sets {
        let exponent = libm::exp(logs[2]);
        reference.back(logs, exponent);
    }
    Some(sets)
}

/// An increment with its exposures in units of a reference.
fn counted(one: &Increment, reference: &Reference) -> Increment {
    let known = match one.known {
        Known::Through { at, below } => Known::Through { at: reference.counted(at), below },
        known => known,
    };
    Increment { from: reference.counted(one.from), to: reference.counted(one.to), known, ..one.clone() }
}

fn sets_of(
    model: &Model,
    increments: &[Increment],
    (phi, covariance): (&[f64], &[Vec<f64>]),
    tried: usize,
) -> Option<Vec<Set>> {
    // The exponent, too, by its logarithm.
    let is_exponent = |at: usize| model.power_law && at == 2;
    let scale = |at: usize| if is_exponent(at) { phi[at] } else { 1.0 };
    let size = phi.len();
    let entry = |i: usize, j: usize| covariance[i][j] / (scale(i) * scale(j));
    let mut spread: Vec<Vec<f64>> = (0..size).map(|i| (0..size).map(|j| entry(i, j)).collect()).collect();
    let own = |(at, value): (usize, &f64)| if is_exponent(at) { libm::log(*value) } else { *value };
    let natural = |(at, value): (usize, &f64)| if is_exponent(at) { libm::exp(*value) } else { *value };
    let mut middle: Vec<f64> = phi.iter().enumerate().map(own).collect();
    let ln_density = |values: &[f64]| {
        let phi: Vec<f64> = values.iter().enumerate().map(natural).collect();
        model.value(&phi, increments) + ln_prior(model, &phi, increments)
    };
    for round in 0..ROUNDS {
        let factor = Factor::definite(&spread)?;
        let sets = weighed(&ln_density, &middle, &factor, tried);
        let squares: f64 = sets.iter().map(|set| set.1 * set.1).sum();
        if round > 0 && squares * ENOUGH * (tried as f64) < 1.0 {
            return Some(sets);
        }
        // Around the mean of these sets, as wide as they are.
        let mean =
            |of: &dyn Fn(&[f64]) -> f64| sets.iter().map(|(values, weight)| weight * of(values)).sum::<f64>();
        middle = (0..size).map(|i| mean(&|values| values[i])).collect();
        let apart = |i: usize, j: usize| mean(&|values| (values[i] - middle[i]) * (values[j] - middle[j]));
        spread = (0..size).map(|i| (0..size).map(|j| apart(i, j)).collect()).collect();
    }
    None
}

/// Points of the lattice, as Student's law around `middle` has them, weighed by a density; weights sum to 1.
fn weighed(ln_density: &dyn Fn(&[f64]) -> f64, middle: &[f64], factor: &Factor, tried: usize) -> Vec<Set> {
    let mut sets = Vec::with_capacity(tried);
    for k in 0..tried {
        let z: Vec<f64> = lattice(k, middle.len()).into_iter().map(student).collect();
        let values: Vec<f64> = middle.iter().zip(factor.times(&z)).map(|(at, by)| at + by).collect();
        let ln = ln_density(&values) - z.iter().map(|z| ln_student(*z)).sum::<f64>();
        if ln.is_finite() {
            sets.push((values, ln));
        }
    }
    let top = sets.iter().map(|set| set.1).fold(f64::NEG_INFINITY, f64::max);
    for set in &mut sets {
        set.1 = libm::exp(set.1 - top);
    }
    sets.retain(|set| set.1 > NEGLIGIBLE);
    let all: f64 = sets.iter().map(|set| set.1).sum();
    for set in &mut sets {
        set.1 /= all;
    }
    sets
}

/// ln of the prior, in the logarithms of the process's parameters and of the exponent.
fn ln_prior(model: &Model, phi: &[f64], increments: &[Increment]) -> f64 {
    let process = model.process;
    let growth = increments.iter().filter(|one| one.is_growth());
    let spans: Vec<(f64, f64)> = growth.map(|one| (model.lambda(phi, one), one.wear)).collect();
    // Flat in the units' coefficient of variation itself: flat in its logarithm, all weight would lie on no difference.
    let of_units = if model.units_differ { phi[phi.len() - 1] } else { 0.0 };
    let known = process.flat_prior_power() * phi[0] + process.ln_matching_weight(phi[0], &spans) + of_units;
    // Root of the information on ln scatter, beside that of exact readings.
    known - libm::log1p(model.hidden(phi, increments).unwrap_or(0.0))
}

/// Point `k` of a lattice in the open unit cube, by powers of the root of x^(size + 1) = x + 1: its points fill the cube evenly,
/// however many there are (M. Roberts 2018, after R. M. Korobov).
fn lattice(k: usize, size: usize) -> Vec<f64> {
    let mut root: f64 = 1.5;
    for _ in 0..60 {
        root = libm::pow(1.0 + root, 1.0 / (size + 1) as f64);
    }
    (1..=size)
        .map(|power| {
            let at = 0.5 + (k + 1) as f64 / libm::pow(root, power as f64);
            // Never an end: half of what the last digit holds.
            (at - libm::floor(at)).clamp(1e-12, 1.0 - 1e-12)
        })
        .collect()
}

/// Quantile of Student's law with four degrees of freedom, in closed form (W. T. Shaw, J. Comput. Finance 9 (2006) 37).
fn student(p: f64) -> f64 {
    let four = libm::sqrt(4.0 * p * (1.0 - p));
    let q = libm::cos(libm::acos(four) / 3.0) / four;
    libm::copysign(2.0 * libm::sqrt((q - 1.0).max(0.0)), p - 0.5)
}

/// ln of its density, but for a constant.
fn ln_student(z: f64) -> f64 {
    -2.5 * libm::log1p(0.25 * z * z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::{Observations, Rounding};
    use crate::fit::estimate;
    use crate::inspection::{Posterior, Prior};
    use crate::life::{LifeMixture, Lifetime, OperatingState};
    use crate::process::{Gamma, PROCESSES, Process};
    use crate::random::Stream;

    /// Units of four increments of a process of mean 1.
    fn drawn(process: &dyn Process, logs: [f64; 2], count: usize) -> Observations {
        let mut stream = Stream::new(5, 0, 0);
        let increments = (0..count).map(|at| Increment {
            unit: at / 4,
            from: (at % 4) as f64,
            to: (at % 4) as f64 + 1.0,
            wear: process.draw(logs, 1.0, &mut stream),
            ln_covariates: vec![0.3 * (at % 3) as f64],
            row: 0,
            ..Increment::default()
        });
        let increments = increments.collect();
        Observations { units: (0..count.div_ceil(4)).map(|unit| unit.to_string()).collect(), increments }
    }

    fn sets(model: &Model, data: &Observations, tried: usize) -> Vec<Set> {
        let fit = estimate(data, model).unwrap();
        sets_of(model, &data.increments, (&fit.phi, &fit.covariance), tried).unwrap()
    }

    /// Ends of the interval of lives at 95 %.
    fn ends(life: &dyn Lifetime) -> [f64; 2] {
        [0.025, 0.975].map(|p| life.quantile(p).unwrap())
    }

    fn ends_of(model: &Model, data: &Observations, sets: Vec<Set>) -> [f64; 2] {
        let parameters = estimate(data, model).unwrap().parameters();
        let estimate =
            crate::life::Estimate::new(model.process, [parameters[0], parameters[1]], None).unwrap();
        let kept = |(values, weight): Set| crate::life::ParameterSet { logs: values[..2].to_vec(), weight };
        let sets: Vec<_> = sets.into_iter().map(kept).collect();
        ends(&LifeMixture::of_sets(&estimate, &OperatingState::new(20.0).unwrap(), &sets).unwrap())
    }

    #[test]
    fn exact_increments_give_the_interval_of_the_exact_posterior() {
        for process in PROCESSES {
            for count in [8, 40] {
                let data = drawn(process, [0.0, 0.4], count);
                let model = Model { process, ..Model::default() };
                let found = ends_of(&model, &data, sets(&model, &data, TRIED[0]));
                let rows: Vec<[f64; 3]> =
                    data.increments.iter().map(|one| [one.from, one.to, one.wear]).collect();
                let prior = Prior::Matching { process, power_law: false };
                let now = OperatingState::new(20.0).unwrap();
                let exact = ends(&Posterior::of_increments(&rows, &prior, &now).unwrap());
                for k in 0..2 {
                    // Of the distance of the ends: a coverage of 95 % changes by up to half a percent.
                    let off = (found[k] - exact[k]).abs() / (exact[1] - exact[0]);
                    assert!(off < 0.03, "{process:?} {count}: {found:?} {exact:?}");
                }
            }
        }
    }

    #[test]
    fn more_sets_do_not_move_the_interval() {
        let data = drawn(&Gamma, [0.7, 0.7], 12);
        let model = Model { covariates: 1, ..Model::default() };
        let [few, many] = [1, 4].map(|times| ends_of(&model, &data, sets(&model, &data, times * TRIED[1])));
        for k in 0..2 {
            // Of the distance of the ends: a coverage of 95 % changes by up to half a percent.
            assert!((few[k] - many[k]).abs() < 0.04 * (many[1] - many[0]), "{few:?} {many:?}");
        }
    }

    #[test]
    fn a_fine_gauge_leaves_open_what_exact_readings_do() {
        let mut data = drawn(&Gamma, [0.7, 0.7], 12);
        let step = 1e-3;
        for one in &mut data.increments {
            one.wear = libm::round(one.wear / step) * step;
        }
        let exact = Model::default();
        let rounded = Model { resolution: Some(Rounding::to(step)), ..exact };
        let [a, b] = [exact, rounded].map(|model| ends_of(&model, &data, sets(&model, &data, TRIED[0])));
        for k in 0..2 {
            // The likelihoods differ by the square of the step.
            assert!((a[k] / b[k] - 1.0).abs() < 1e-4, "{a:?} {b:?}");
        }
    }
}
