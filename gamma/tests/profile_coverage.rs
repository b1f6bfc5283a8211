//! How often intervals by profile likelihood hold the parameters that few increments were drawn with.

#![allow(clippy::disallowed_methods, reason = "nothing here has to have the same bits on every machine")]

mod runs;

use linkwear_gamma::data::{Increment, Observations};
use linkwear_gamma::fit::{Interval, Model, estimate, interval, profile_interval};
use linkwear_gamma::process::{Gamma, InverseGaussian, Process, Wiener};
use linkwear_gamma::random::Stream;
use runs::runs_or;

const EXPONENT: f64 = 1.3;

/// Units of three increments from new over exposure 1 each; with a power law over exposure^1.3.
fn drawn(process: &dyn Process, logs: [f64; 2], power_law: bool, count: usize, run: u64) -> Observations {
    let mut stream = Stream::new(77, run, 0);
    let of_unit = 3;
    let exponent = if power_law { EXPONENT } else { 1.0 };
    let one = |at: usize| {
        let from = (at % of_unit) as f64;
        let lambda = (from + 1.0).powf(exponent) - from.powf(exponent);
        let wear = process.draw(logs, lambda, &mut stream);
        let wear = if process.is_increasing() { wear.max(f64::MIN_POSITIVE) } else { wear };
        Increment { unit: at / of_unit, from, to: from + 1.0, wear, ..Increment::default() }
    };
    let increments = (0..count).map(one).collect();
    Observations { units: (0..count.div_ceil(of_unit)).map(|unit| unit.to_string()).collect(), increments }
}

/// Per cent of intervals that hold each parameter, corrected and by chi-square.
fn held(
    process: &'static dyn Process,
    logs: [f64; 2],
    power_law: bool,
    count: usize,
    runs: u64,
) -> [[f64; 3]; 2] {
    let model = Model { process, power_law, ..Model::default() };
    let truth = [logs[0].exp(), logs[1].exp(), EXPONENT];
    let mut held = [[0.0; 3]; 2];
    for run in 0..runs {
        let data = drawn(process, logs, power_law, count, run);
        let fit = estimate(&data, &model).expect("a fit");
        for at in 0..model.parameters() {
            let found = [interval(&fit, &data, at, 0.95), profile_interval(&fit, &data, at, 0.95)];
            for (held, found) in held.iter_mut().zip(found) {
                // One that cannot be found holds nothing.
                let is_held = found.is_ok_and(|found: Interval| found.contains(truth[at]));
                held[at] += 100.0 * f64::from(u8::from(is_held)) / runs as f64;
            }
        }
    }
    held
}

#[test]
fn the_interval_of_the_drift_of_few_increments_is_students() {
    for (count, student) in [(6, 2.5706), (9, 2.3060), (15, 2.1448)] {
        let data = drawn(&Wiener, [0.0, 0.3_f64.ln()], false, count, 4);
        let fit = estimate(&data, &Model { process: &Wiener, ..Model::default() }).expect("a fit");
        let found = interval(&fit, &data, 0, 0.95).expect("an interval");
        let (drift, spread) = (fit.parameters()[0], fit.parameters()[1]);
        // Of equal spans, with the variance divided by the degrees of freedom.
        let half = student * spread / ((count - 1) as f64).sqrt();
        // 500 drawn data tell the mean fall to 6 %, and this to half of it, twice; by chi-square six increments have 0.82 of it.
        let [low, high] = [drift - found.low, found.high - drift].map(|end| end / half);
        assert!((low - 1.0).abs() < 0.06 && (high - 1.0).abs() < 0.06, "{count}: {low} {high}");
    }
}

/// `COUNT=9` does nine increments alone.
#[test]
#[ignore = "minutes; run with --release --ignored --nocapture"]
fn table_of_coverages_of_few_increments() {
    let runs = runs_or(2000);
    let laws: [(&str, &'static dyn Process, [f64; 2]); 5] = [
        ("gamma, shape 0.3", &Gamma, [0.3_f64.ln(); 2]),
        ("gamma, shape 2", &Gamma, [2.0_f64.ln(); 2]),
        ("gamma, shape 20", &Gamma, [20.0_f64.ln(); 2]),
        ("wiener, variation 0.5", &Wiener, [0.0, 0.5_f64.ln()]),
        ("inverse Gaussian, variation 0.5", &InverseGaussian, [0.0, 4.0_f64.ln()]),
    ];
    let asked = std::env::var("COUNT").ok().and_then(|count| count.parse::<usize>().ok());
    for count in [6, 9, 15, 24].into_iter().filter(|count| asked.is_none_or(|asked| asked == *count)) {
        for power_law in [true, false] {
            for (name, process, logs) in laws {
                let told = held(process, logs, power_law, count, runs).map(|all| {
                    let kept = if power_law { 3 } else { 2 };
                    all[..kept].iter().map(|part| format!("{part:.1}")).collect::<Vec<_>>().join(", ")
                });
                println!("| {count} | {name} | {power_law} | {} | {} |", told[0], told[1]);
            }
        }
    }
}
