//! How often the interval of lives of `predict` holds the life, over samples of a known process, with a fixed seed.
//!
//! The whole table (docs/remaining-life.md):
//! `cargo test --release -p linkwear-gamma --test coverage -- --ignored --nocapture`.

#![allow(missing_docs)]
#![allow(clippy::disallowed_methods)]

use linkwear_gamma::data::{Gauge, Observations, Reading};
use linkwear_gamma::fit::{Model, estimate};
use linkwear_gamma::life::{Clock, FirstPassage, Law, Lifetime, OperatingState};
use linkwear_gamma::process::{Gamma, Process};
use linkwear_gamma::random::Stream;
use linkwear_gamma::{FitFile, IntervalKind, Prediction};

const SEED: u64 = 20_261_122;

/// Thresholds in mean increments, each from new and from half of it.
const STATES: [(f64, f64); 4] = [(5.0, 0.0), (5.0, 2.5), (20.0, 0.0), (20.0, 10.0)];

/// Units of four increments of exposure 1 each, of mean 1.
fn sample(shape: f64, count: usize, replicate: u64) -> Observations {
    let mut stream = Stream::new(SEED, replicate, 0);
    let mut readings = Vec::new();
    for unit in 0..count / 4 {
        let mut wear = 0.0;
        for step in 0..=4 {
            if step > 0 {
                let at = (4 * unit + step) as u64;
                wear += Gamma.draw([shape.ln(), shape.ln()], 1.0, stream.at(at)).max(1e-12);
            }
            let (unit, covariates, row) = (unit.to_string(), vec![], readings.len() + 1);
            readings.push(Reading { unit, exposure: step as f64, wear, covariates, row });
        }
    }
    Observations::new(&readings, false, Gauge::Exact).expect("rising wear")
}

/// Part of the lives that the interval holds and parts below and above, in per cent, for each of [`STATES`]: the mean over
/// samples of the true probabilities.
fn coverage(shape: f64, count: usize, repetitions: u64) -> [[f64; 3]; 4] {
    let law = Law::new(&Gamma, [shape, shape]).expect("positive");
    let mut sums = [[0.0; 3]; 4];
    for replicate in 0..repetitions {
        let data = sample(shape, count, replicate);
        let fit = estimate(&data, &Model::default()).expect("a maximum");
        let fit = FitFile::new(&fit, &data, &[], ("um", "h"), false).estimate(&[]).expect("its own fit");
        for (sum, (threshold, current)) in sums.iter_mut().zip(STATES) {
            let state = OperatingState::new(threshold).and_then(|new| new.worn(current, 0.0)).expect("left");
            let ((lower, upper), kind) = Prediction::predictive_interval(&fit, &state).expect("an interval");
            assert_eq!(kind, IntervalKind::Predictive);
            let clock = Clock::linear(1.0).expect("positive");
            let truth = FirstPassage::from(law, clock, threshold, current, 0.0).expect("left");
            let (early, late) = (truth.failed(lower), truth.reliability(upper));
            for (sum, part) in sum.iter_mut().zip([1.0 - early - late, early, late]) {
                *sum += 100.0 * part / repetitions as f64;
            }
        }
    }
    sums
}

#[test]
fn nineteen_of_twenty_lives_end_within_the_interval_after_few_increments() {
    for (shape, count) in [(2.0, 4), (20.0, 12)] {
        for [within, ..] in coverage(shape, count, 150) {
            // Two per cent; 150 samples add about 0.6.
            assert!((within - 95.0).abs() < 2.0 + 0.6, "shape {shape}, {count} increments: {within}");
        }
    }
}

#[test]
#[ignore = "some minutes: the table of the docs"]
fn table_of_coverages() {
    println!(
        "| increments | shape | 5 mean increments | 5, half worn | 20 | 20, half worn |\n|---|---|---|---|---|---|"
    );
    for count in [4, 12, 40] {
        for shape in [0.3, 2.0, 20.0] {
            let cells = coverage(shape, count, 2000);
            let text = cells.map(|[within, early, late]| format!("{within:.1} ({early:.1}, {late:.1})"));
            println!("| {count} | {shape} | {} |", text.join(" | "));
            for [within, ..] in cells {
                assert!((within - 95.0).abs() < 2.0, "shape {shape}, {count} increments: {within}");
            }
        }
    }
}
