//! What a process that the crate does not know has to bring to be fitted and predicted from: this file.

use linkwear_gamma::FitFile;
use linkwear_gamma::data::{Gauge, Observations, Reading};
use linkwear_gamma::fit::{Model, estimate};
use linkwear_gamma::inspection::{self, Effort, History, Prior};
use linkwear_gamma::life::{Method, OperatingState};
use linkwear_gamma::process::{Process, Slice, Term, Wiener};
use linkwear_gamma::random::Stream;
use linkwear_gamma::{Prediction, Questions};

/// The Wiener process by drift and precision, 1 / spread²: another process to the crate, the same numbers to the world.
#[derive(Clone, Copy, Debug)]
struct ByPrecision;

fn by_spread([drift, precision]: [f64; 2]) -> [f64; 2] {
    [drift, -0.5 * precision]
}

impl Process for ByPrecision {
    fn name(&self) -> &'static str {
        "wiener-by-precision"
    }

    fn title(&self) -> &'static str {
        "Wiener by precision"
    }

    fn parameters(&self) -> [&'static str; 2] {
        ["drift", "precision"]
    }

    fn exposure_powers(&self) -> [f64; 2] {
        [1.0, -1.0]
    }

    fn is_increasing(&self) -> bool {
        false
    }

    fn maximum(&self, exposures: &[f64], wears: &[f64]) -> Option<[f64; 2]> {
        Wiener.maximum(exposures, wears).map(|[drift, spread]| [drift, -2.0 * spread])
    }

    fn density(&self, logs: [f64; 2], wear: f64) -> Term {
        let Term { value, gradient: [a, b], hessian: [aa, ab, bb] } = Wiener.density(by_spread(logs), wear);
        Term { value, gradient: [a, -0.5 * b], hessian: [aa, -0.5 * ab, 0.25 * bb] }
    }

    fn ln_mean(&self, logs: [f64; 2]) -> f64 {
        logs[0]
    }

    fn variance(&self, logs: [f64; 2]) -> f64 {
        Wiener.variance(by_spread(logs))
    }

    fn slice(&self, first: f64, increments: &[(f64, f64)]) -> Slice {
        let slice = Wiener.slice(first, increments);
        Slice { slope: -0.5 * slice.slope, power: 1.0, ..slice }
    }

    fn flat_prior_power(&self) -> f64 {
        1.0
    }

    fn increments_for_variance(&self) -> Option<usize> {
        None
    }

    fn draw(&self, logs: [f64; 2], exposure: f64, stream: &mut Stream) -> f64 {
        Wiener.draw(by_spread(logs), exposure, stream)
    }

    fn cumulative(&self, logs: [f64; 2], exposure: f64, wear: f64) -> f64 {
        Wiener.cumulative(by_spread(logs), exposure, wear)
    }

    fn quantile(&self, logs: [f64; 2], exposure: f64, p: f64) -> f64 {
        Wiener.quantile(by_spread(logs), exposure, p)
    }

    fn survival(&self, logs: [f64; 2], exposure: f64, left: f64) -> f64 {
        Wiener.survival(by_spread(logs), exposure, left)
    }

    fn failure(&self, logs: [f64; 2], exposure: f64, left: f64) -> f64 {
        Wiener.failure(by_spread(logs), exposure, left)
    }

    fn hazard(&self, logs: [f64; 2], exposure: f64, left: f64) -> f64 {
        Wiener.hazard(by_spread(logs), exposure, left)
    }

    fn mean_exposure(&self, logs: [f64; 2], left: f64) -> f64 {
        Wiener.mean_exposure(by_spread(logs), left)
    }
}

/// The GaAs lasers (Meeker & Escobar 1998, table C.17), exposure in thousands of hours.
fn lasers() -> Observations {
    let table = include_str!("data/gaas_lasers.csv");
    let lines = table.lines().enumerate().filter(|(_, line)| !line.starts_with('#')).skip(1);
    let reading = |(at, line): (usize, &str)| {
        let cells: Vec<&str> = line.split(',').collect();
        let number = |at: usize| cells[at].parse::<f64>().expect("a number");
        Reading {
            unit: cells[0].to_owned(),
            exposure: 1e-3 * number(1),
            wear: number(2),
            covariates: Vec::new(),
            row: at + 1,
            ..Reading::default()
        }
    };
    let readings: Vec<Reading> = lines.map(reading).collect();
    Observations::new(&readings, false, Gauge::Exact).expect("growing wear")
}

/// What is told about a laser at 10 percent: by the fit, after exact readings, without a prior, after readings with errors.
fn predictions(process: &'static dyn Process) -> Vec<Prediction> {
    let data = lasers();
    let fit = estimate(&data, &Model { process, power_law: true, ..Model::default() }).expect("a maximum");
    let file = FitFile::new(&fit, &data, &[], ("percent", "kh"), false);
    let estimate = file.estimate(&[]).expect("no covariates");
    let state = OperatingState::new(10.0).expect("positive");
    let readings: Vec<inspection::Reading> = [(0.0, 0.0), (0.5, 1.2), (1.0, 1.9), (1.5, 3.2), (2.0, 4.1)]
        .map(|(time, wear)| inspection::Reading { time, wear })
        .to_vec();
    let history = History::exact(process, readings.clone()).expect("rising");
    let flat = Prior::Flat { process, power_law: false };
    let noisy = History::noisy(readings[1..].to_vec()).expect("numbers");
    let (effort, asked) = (Effort { count: 5000, seed: 1 }, Questions::default());
    vec![
        Prediction::by_fit(&estimate, &state, Method::Delta, &asked).expect("a life"),
        Prediction::after(&history, &Prior::Fit(estimate.clone()), &state, &asked).expect("a life"),
        Prediction::after(&history, &flat, &state, &asked).expect("a life"),
        Prediction::after_gauge(&noisy, &estimate, &state, 0.3, effort, &asked).expect("a life"),
    ]
}

#[test]
fn a_process_outside_the_crate_is_fitted_and_predicted_from() {
    for (ours, theirs) in predictions(&ByPrecision).iter().zip(predictions(&Wiener)) {
        assert_eq!(ours.from, theirs.from);
        // Fits agree to 1e-9, nested rules with other nodes to 1e-6; particles are drawn to the other side.
        let tolerance = if ours.from.contains("gauge") { 1e-2 } else { 1e-5 };
        for (a, b) in ours.quantiles.iter().zip(theirs.quantiles) {
            assert!((a.value / b.value - 1.0).abs() < tolerance, "{}: {a:?} {b:?}", ours.from);
            // Ends of credible intervals are nodes.
            assert!((a.lower / b.lower - 1.0).abs() < 1e-2, "{}: {a:?} {b:?}", ours.from);
        }
        assert_eq!(ours.moments.is_some(), theirs.moments.is_some(), "{}", ours.from);
    }
}
