//! Rounded readings of units that differ: the likelihood against quadrature and against that of exact readings, intervals of drawn data.

use super::super::bootstrap::draw;
use super::super::maximise::maximise;
use super::super::*;
use super::lasers;
use crate::data::{Increment, Observations, Rounding};

/// Units of `readings` increments over exposure 1 from new.
fn even(units: usize, readings: usize) -> Observations {
    let one = |at: usize| {
        let from = (at % readings) as f64;
        Increment { unit: at / readings, from, to: from + 1.0, wear: 1.0, ..Increment::default() }
    };
    let increments = (0..units * readings).map(one).collect();
    Observations { units: (0..units).map(|unit| unit.to_string()).collect(), increments }
}

fn rounded(rounding: Rounding) -> Model {
    Model { resolution: Some(rounding), units_differ: true, ..Model::default() }
}

#[test]
fn the_likelihood_is_the_mean_over_the_law_of_the_rates() {
    let wears = [[1.0, 0.0, 2.0], [3.0, 1.0, 1.0], [0.0, 0.0, 0.0]];
    for rounding in [Rounding::to(1.0), Rounding { step: 0.5, error: 0.3 }] {
        for (alpha, beta, cv) in [(2.0_f64, 1.5_f64, 0.5_f64), (0.3, 0.4, 1.5), (8.0, 7.0, 0.02)] {
            let mut data = even(3, 3);
            for (one, wear) in data.increments.iter_mut().zip(wears.as_flattened()) {
                one.wear = *wear;
            }
            let model = rounded(rounding);
            let alike = Model { units_differ: false, ..model };
            let found = model.value(&[alpha.ln(), beta.ln(), cv.ln()], &data.increments);
            // By the rule of rectangles over the logarithm of the rate, whose density is written out.
            let (shape, step) = (1.0 / (cv * cv), 0.02 * cv.min(0.5));
            let constant = shape * shape.ln() - crate::special::ln_gamma(shape);
            let of_unit = |unit: &[Increment]| {
                let term = |at: i32| {
                    let s = step * f64::from(at);
                    let density = constant + shape * (s - s.exp());
                    // Readings of no wear are the rarer the smaller the rate; they end no tail.
                    if density < -80.0 {
                        return 0.0;
                    }
                    (density + alike.value(&[alpha.ln(), beta.ln() + s], unit)).exp()
                };
                let reach = (if cv > 1.0 { 30.0 } else { 12.0 * cv } / step) as i32;
                (step * (-reach..=reach).map(term).sum::<f64>()).ln()
            };
            let expected: f64 = data.increments.chunks(3).map(of_unit).sum();
            // 2e-9 of the largest term and less are left out at either end, a few of them for each unit.
            assert!((found - expected).abs() < 1e-7, "{rounding:?} {alpha} {cv}: {found} {expected}");
        }
    }
}

#[test]
fn a_fine_gauge_gives_the_closed_likelihood_of_exact_readings() {
    let mut data = lasers();
    let exact = Model { units_differ: true, ..Model::default() };
    for (step, error) in [(1e-3, 0.0), (1e-3, 2e-3)] {
        for one in &mut data.increments {
            one.wear = libm::round(one.wear / step) * step;
        }
        for phi in [[3.6, 3.0, -1.7], [3.4, 2.9, -0.5], [3.7, 3.1, -5.0]] {
            let found = rounded(Rounding { step, error }).value(&phi, &data.increments);
            let expected = exact.value(&phi, &data.increments);
            // An increment of shape 9.8 and rate 20 has a second derivative of some hundred: 240 times 100 times half the variance of
            // both readings, step^2 / 12 + error^2 each, is 0.02 with the error and 0.002 without.
            let allowed = 240.0 * 100.0 * (step * step / 12.0 + error * error);
            assert!((found - expected).abs() < allowed, "{step} {error} {phi:?}: {found} {expected}");
        }
    }
}

#[test]
fn lasers_read_to_a_tenth_of_a_percent_differ_as_much() {
    let exact = estimate_units(&lasers(), &Model::default()).unwrap();
    let mut data = lasers();
    let step = 0.1;
    // Readings are rounded, not increments.
    let mut level = 0.0;
    for one in &mut data.increments {
        level = if one.from == 0.0 { 0.0 } else { level };
        let read = |wear: f64| libm::round(wear / step);
        let next = level + one.wear;
        one.wear = step * (read(next) - read(level));
        level = next;
    }
    let model = Model { resolution: Some(Rounding::to(step)), ..Model::default() };
    let found = estimate_units(&data, &model).unwrap();
    assert!(!found.boundary && found.test.p_value < 1e-8, "{:?}", found.test);
    let errors = exact.fit.standard_errors();
    let pairs = found.fit.parameters().into_iter().zip(exact.fit.parameters());
    for ((found, exact), error) in pairs.zip(errors) {
        // Rounding adds a twentieth to the variance of an increment, and takes as much from what the data tell.
        assert!((found - exact).abs() < 0.4 * error, "{found} {exact} +- {error}");
    }
    let seen = goodness(&found.fit, &data.increments, 1);
    assert_eq!(seen.in_order.len(), data.increments.len());
    assert!(seen.in_order.iter().all(|u| *u > 0.0 && *u < 1.0));
}

#[test]
fn transforms_of_a_fine_gauge_are_those_of_exact_readings() {
    let mut data = lasers();
    let step = 1e-4;
    for one in &mut data.increments {
        one.wear = libm::round(one.wear / step) * step;
    }
    let phi = vec![3.66, 2.99, -1.68];
    let fit = |model: Model| Fit {
        model,
        phi: phi.clone(),
        covariance: vec![],
        log_likelihood: 0.0,
        increments: 240,
    };
    let found = goodness(&fit(rounded(Rounding::to(step))), &data.increments, 1).in_order;
    let exact =
        goodness(&fit(Model { units_differ: true, ..Model::default() }), &data.increments, 1).in_order;
    for (found, exact) in found.iter().zip(exact) {
        // Densities of increments are below 3.
        assert!((found - exact).abs() < 3.0 * step, "{found} {exact}");
    }
}

/// How often likelihood-ratio intervals at 95 %, that of cv by the law of few units, hold alpha, beta and cv of drawn data, and how many
/// data have a maximum inside.
fn coverage(
    (units, readings): (usize, usize),
    truth: [f64; 3],
    rounding: Rounding,
    samples: std::ops::Range<u64>,
) -> ([u64; 3], u64) {
    let like = even(units, readings);
    let phi: Vec<f64> = truth.iter().map(|value| value.ln()).collect();
    let model = rounded(rounding);
    let known = Fit {
        model,
        phi: phi.clone(),
        covariance: vec![],
        log_likelihood: 0.0,
        increments: units * readings,
    };
    let (mut held, mut fitted) = ([0; 3], 0);
    for sample in samples {
        let increments = draw(&known, &like.increments, 91, sample);
        let data = Observations { increments, ..like.clone() };
        let Ok(found) = estimate_units(&data, &model) else { continue };
        let below = |at: usize| {
            // No difference found: cv from a small one, and the others' intervals are those of the plain fit.
            let (own, mut from) = (found.fit.model, found.fit.phi.clone());
            let own = if at == 2 { model } else { own };
            from.resize(own.parameters(), 0.1_f64.ln());
            let covariance = &found.fit.covariance;
            if at < covariance.len() {
                // The others as the estimates go together, so that few steps are left.
                let by = (phi[at] - from[at]) / covariance[at][at];
                covariance[at].iter().zip(&mut from).for_each(|(entry, from)| *from += by * entry);
            }
            from[at] = phi[at];
            let (_, point) = maximise(&own, &data.increments, &from, Some(at)).ok()?;
            let critical = match at {
                2 => found.critical(&data, 0.95).ok()?(truth[2]),
                // chi-square at 95 %, 1 degree.
                _ => 3.841_458_820_694_124,
            };
            Some(2.0 * (found.fit.log_likelihood - point.value) < critical)
        };
        let [Some(first), Some(second), Some(third)] = [0, 1, 2].map(below) else { continue };
        fitted += 1;
        for (held, is_held) in held.iter_mut().zip([first, second, third]) {
            *held += u64::from(is_held);
        }
    }
    (held, fitted)
}

#[test]
fn intervals_of_rounded_units_hold_the_truth() {
    let samples = 40;
    let (held, fitted) = coverage((12, 5), [2.0, 2.0, 0.5], Rounding::to(0.5), 0..samples);
    assert!(fitted >= samples - 1, "{fitted}");
    for held in held {
        let part = held as f64 / fitted as f64;
        // Three standard errors, and 2 % of the interval's own error of order 1/n.
        assert!((part - 0.95).abs() < 3.0 * (0.0475_f64 / samples as f64).sqrt() + 0.02, "{part}");
    }
}

/// `RUNS=1000 cargo test --release -p linkwear-gamma --lib table_of_coverages_of_rounded_units -- --ignored --nocapture`; `ROW=2` does
/// one row alone, `FROM=500` leaves out the first 500 samples.
#[test]
#[ignore = "half an hour: the table of docs/units-that-differ.md"]
fn table_of_coverages_of_rounded_units() {
    let asked = |name: &str| std::env::var(name).ok().and_then(|value| value.parse::<u64>().ok());
    let runs = asked("RUNS").unwrap_or(1000);
    println!("| units x readings | shape, cv | step, error | alpha | beta | cv | with a maximum | samples |");
    println!("|---|---|---|---|---|---|---|---|");
    for (row, (size, truth, step, error)) in [
        ((20, 6), [2.0, 2.0, 0.5], 0.5, 0.0),
        ((20, 6), [2.0, 2.0, 0.5], 1.0, 0.0),
        ((20, 6), [4.0, 4.0, 0.3], 0.5, 0.0),
        ((20, 6), [2.0, 2.0, 0.5], 0.5, 0.25),
    ]
    .into_iter()
    .enumerate()
    {
        if asked("ROW").is_some_and(|asked| asked != row as u64) {
            continue;
        }
        let rounding = Rounding { step, error };
        let (mut held, mut fitted) = ([0; 3], 0);
        let first = asked("FROM").unwrap_or(0);
        for from in (first..runs).step_by(100) {
            let until = (from + 100).min(runs);
            let (more, of) = coverage(size, truth, rounding, from..until);
            held.iter_mut().zip(more).for_each(|(held, more)| *held += more);
            fitted += of;
            eprintln!("{row}: {held:?} of {fitted} of {first} to {until}");
        }
        let [alpha, beta, cv] = held.map(|held| {
            // With the standard error of a part.
            let part = held as f64 / fitted as f64;
            let error = (part * (1.0 - part) / fitted as f64).sqrt();
            format!("{:.1} +- {:.1}", 100.0 * part, 100.0 * error)
        });
        println!(
            "| {} x {} | {}, {} | {step}, {error} | {alpha} | {beta} | {cv} | {:.1} | {} |",
            size.0,
            size.1,
            truth[0],
            truth[2],
            100.0 * fitted as f64 / (runs - first) as f64,
            runs - first
        );
    }
}
