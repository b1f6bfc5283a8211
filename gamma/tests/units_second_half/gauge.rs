//! The last reading of each unit by a Gamma process that is read with an error, from the first half of it and all of the other units.

use linkwear_gamma::data::{Gauge, Increment, Observations, Rounding};
use linkwear_gamma::fit::{Fit, Model, estimate};
use linkwear_gamma::process::Gamma;
use linkwear_gamma::random::{StandardNormal, Stream};
use rand::RngExt;

use super::{Set, readings};

/// Readings are taken to this, ten times as coarse as the table: far below the error.
const STEP: f64 = 0.01;
/// Errors that are tried.
const ERRORS: [f64; 7] = [0.03, 0.06, 0.1, 0.15, 0.2, 0.3, 0.45];
/// Parameters drawn from the normal law of the estimates, and wear at which the density is taken.
const DRAWN: u64 = 60;
const POINTS: usize = 100;

fn model(error: f64) -> Model {
    let resolution = Some(Rounding { step: STEP, error });
    Model { process: &Gamma, power_law: true, covariates: 1, resolution, ..Model::default() }
}

fn observed(set: &Set, error: f64) -> Observations {
    let mut rows = readings(set);
    for row in &mut rows {
        row.wear = (row.wear / STEP).round() * STEP;
    }
    let gauge = Gauge::Resolution(Rounding { step: STEP, error });
    Observations::new(&rows, set.from_zero, gauge).expect("readings")
}

/// The increments of a unit in two halves.
fn halves(data: &Observations, unit: usize) -> (Vec<Increment>, Vec<Increment>) {
    let mut own: Vec<Increment> = data.increments.iter().filter(|one| one.unit == unit).cloned().collect();
    let later = own.split_off(own.len() / 2);
    (own, later)
}

/// The error that explains the first halves of all units best: second halves are not looked at.
pub fn error_of_first_halves(set: &Set) -> f64 {
    let rated = ERRORS.map(|error| {
        let data = observed(set, error);
        let increments = (0..data.units.len()).flat_map(|unit| halves(&data, unit).0).collect();
        let fit = estimate(&Observations { increments, ..data }, &model(error));
        (fit.map_or(f64::NEG_INFINITY, |fit| fit.log_likelihood), error)
    });
    rated.into_iter().max_by(|a, b| a.0.total_cmp(&b.0)).expect("errors").1
}

/// Logarithms of alpha and beta, exponent and power of the load, drawn by the covariance of the estimates.
fn drawn(fit: &Fit, draw: u64) -> Vec<f64> {
    let (centre, covariance) = (fit.parameters(), fit.covariance());
    let size = centre.len();
    let scale = |i: usize| if i < 2 { centre[i] } else { 1.0 };
    let mut lower = vec![vec![0.0; size]; size];
    for i in 0..size {
        for j in 0..=i {
            let inner: f64 = (0..j).map(|k| lower[i][k] * lower[j][k]).sum();
            let rest: f64 = covariance[i][j] / (scale(i) * scale(j)) - inner;
            lower[i][j] = if i == j { rest.sqrt() } else { rest / lower[j][j] };
        }
    }
    let mut stream = Stream::new(6, draw, 0);
    let z: Vec<f64> = (0..size).map(|_| stream.sample(StandardNormal)).collect();
    let natural = |i: usize| if i < 2 { centre[i].ln() } else { centre[i] };
    (0..size).map(|i| natural(i) + lower[i].iter().zip(&z).map(|(a, b)| a * b).sum::<f64>()).collect()
}

/// Probability integral transform, minus ln density, CRPS of the last reading of every unit.
pub fn course(set: &Set, error: f64) -> Vec<[f64; 3]> {
    let data = observed(set, error);
    let model = model(error);
    let of_unit = |unit: usize| {
        let (first, later) = halves(&data, unit);
        let known = data.increments.iter().filter(|one| one.unit != unit).chain(&first).cloned().collect();
        let known = Observations { units: data.units.clone(), increments: known };
        let fit = estimate(&known, &model).expect("a maximum");
        let last = &later[later.len() - 1];
        let growth: f64 = later.iter().map(|one| one.wear).sum();
        let (from, to) = (later[0].from, last.to);
        // From a fall of four errors to eight standard deviations above the mean.
        let [alpha, beta, exponent, power] = fit.parameters()[..] else { panic!("parameters") };
        let shape = alpha * (to.powf(exponent) - from.powf(exponent)) * (power * last.ln_covariates[0]).exp();
        let (mean, spread) = (shape / beta, (shape / (beta * beta) + 2.0 * error * error).sqrt());
        let (low, high) = ((-5.0 * error).min(growth - error), (mean + 8.0 * spread).max(growth + error));
        let wears: Vec<f64> =
            (0..POINTS).map(|at| low + (high - low) * at as f64 / (POINTS - 1) as f64).collect();
        let with = |wear: f64| {
            let wear = (wear / STEP).round() * STEP;
            let one = Increment { from, to, wear, ..last.clone() };
            first.iter().cloned().chain([one]).collect::<Vec<_>>()
        };
        let mut densities = vec![0.0; POINTS];
        let mut of_truth = 0.0;
        for draw in 0..DRAWN {
            let phi = drawn(&fit, draw);
            let before = model.value(&phi, &first);
            let density = |wear: f64| (model.value(&phi, &with(wear)) - before).exp() / DRAWN as f64;
            densities.iter_mut().zip(&wears).for_each(|(sum, wear)| *sum += density(*wear));
            of_truth += density(growth);
        }
        let width = (high - low) / (POINTS - 1) as f64;
        let all: f64 = densities.iter().sum::<f64>() * width;
        // The rule of trapezia, over what the density sums to.
        let mut below = vec![0.0];
        for pair in densities.windows(2) {
            below.push(below[below.len() - 1] + 0.5 * width * (pair[0] + pair[1]) / all);
        }
        let place = ((growth - low) / width).clamp(0.0, (POINTS - 1) as f64 - 1e-9);
        let (at, part) = (place as usize, place.fract());
        let transform = below[at] + part * (below[at + 1] - below[at]);
        let miss = |at: usize| below[at] - f64::from(u8::from(wears[at] >= growth));
        let crps: f64 = (0..POINTS - 1).map(|k| 0.5 * width * (miss(k).powi(2) + miss(k + 1).powi(2))).sum();
        [transform, -of_truth.ln(), crps]
    };
    (0..data.units.len()).map(of_unit).collect()
}
