//! Likelihoods of bounds and of units that were selected, against sums and quadrature.

use crate::data::{Increment, Known, Observations};
use crate::fit::{Model, estimate, estimate_units};
use crate::process::{Gamma, InverseGaussian, PROCESSES, Process, RandomEffect, Wiener};
use crate::random::Stream;

fn one(unit: usize, span: [f64; 2], wear: f64, known: Known) -> Increment {
    Increment { unit, from: span[0], to: span[1], wear, known, ..Increment::default() }
}

/// Mean of a chance over a unit's own parameter, by a fine trapezoid of its law.
fn over_units(effect: &dyn RandomEffect, logs: [f64; 2], cv: f64, chance: &dyn Fn([f64; 2]) -> f64) -> f64 {
    let (mut sum, mut all) = (0.0, 0.0);
    for k in -4000..4000 {
        let Some((own, ln)) = effect.place(logs, cv, f64::from(k) * 0.005) else {
            panic!("a law of positive numbers")
        };
        if ln > f64::NEG_INFINITY {
            sum += ln.exp() * chance(own);
            all += ln.exp();
        }
    }
    // The places carry a density: it integrates to 1.
    assert!((all * 0.005 - 1.0).abs() < 1e-6, "{all}");
    sum / all
}

#[test]
fn bounds_and_entries_of_units_that_differ_are_the_means_over_their_law() {
    for process in [&Gamma as &'static dyn Process, &InverseGaussian] {
        let effect = process.random_effect().expect("a law");
        let (phi, cv) = ([0.7, 0.4, 0.2_f64.ln()], 0.2);
        let unit = [
            one(0, [0.0, 1.0], 2.5, Known::Entered { from_new: false }),
            one(0, [1.0, 2.0], 1.2, Known::Exact),
            one(0, [2.0, 3.5], 1.9, Known::Exact),
            one(0, [3.5, 4.0], 1.0, Known::AtLeast),
        ];
        let model = Model { process, units_differ: true, ..Model::default() };
        for picked in [vec![1, 2], vec![1, 2, 3], vec![0, 1, 2], vec![0, 1, 2, 3], vec![3]] {
            let data: Vec<Increment> = picked.iter().map(|at| unit[*at].clone()).collect();
            let chance = |own: [f64; 2]| -> f64 {
                let of = |one: &Increment| {
                    let span = one.to - one.from;
                    let powers = process.exposure_powers();
                    let logs = [own[0] + powers[0] * span.ln(), own[1] + powers[1] * span.ln()];
                    match one.known {
                        Known::Exact => process.ln_density(logs, one.wear).exp(),
                        Known::AtLeast => process.failure(own, span, one.wear),
                        _ => process.cumulative(own, span, one.wear),
                    }
                };
                data.iter().map(of).product()
            };
            let entering = |own: [f64; 2]| process.cumulative(own, 1.0, 2.5);
            let mut expected = over_units(effect, [phi[0], phi[1]], cv, &chance).ln();
            if picked.contains(&0) {
                expected -= over_units(effect, [phi[0], phi[1]], cv, &entering).ln();
            }
            let found = model.value(&phi, &data);
            // The trapezoid's steps are smooth to rounding; the hump's own rule is good to 1e-9.
            assert!((found - expected).abs() < 1e-7, "{process:?} {picked:?}: {found} {expected}");
        }
    }
}

#[test]
fn what_passed_below_a_bound_has_the_chance_of_a_sum_over_its_way() {
    for process in [&Gamma as &'static dyn Process, &Wiener] {
        let (phi, at, below, total) = ([0.9, 0.3], 1.0, 0.8, 2.2);
        let data = [one(0, [0.0, 3.0], total, Known::Through { at, below })];
        let found = Model { process, ..Model::default() }.value(&phi, &data).exp();
        let density = |span: f64, wear: f64| {
            let powers = process.exposure_powers();
            process.ln_density([phi[0] + powers[0] * span.ln(), phi[1] + powers[1] * span.ln()], wear).exp()
        };
        let low = if process.is_increasing() { 0.0 } else { -30.0 };
        let parts = 40_000;
        let width = (below - low) / f64::from(parts);
        let sum: f64 = (0..parts)
            .map(|k| low + (f64::from(k) + 0.5) * width)
            .map(|wear| density(1.0, wear) * density(2.0, total - wear) * width)
            .sum();
        // The middle rule, 2e-5 or 8e-4 wide.
        assert!((found / sum - 1.0).abs() < 1e-6, "{process:?}: {found} {sum}");
    }
}

/// Units read at 1, 2, .. from new, drawn until their wear at 1 is below the limit.
fn selected(limit: f64, cv: f64, units: usize, seed: u64, from_new: bool) -> Observations {
    let logs = [4.0_f64.ln(), 4.0_f64.ln()];
    let effect = Gamma.random_effect().expect("a law");
    let mut increments = Vec::new();
    for unit in 0..units {
        let mut stream = Stream::new(seed, unit as u64, 0);
        let (own, first) = loop {
            let own = if cv > 0.0 { effect.draw(logs, cv, &mut stream) } else { logs };
            let first = Gamma.draw(own, 1.0, &mut stream);
            if first < limit {
                break (own, first);
            }
        };
        increments.push(one(unit, [0.0, 1.0], limit, Known::Entered { from_new }));
        if from_new {
            increments.push(one(unit, [0.0, 1.0], first, Known::Exact));
        }
        for at in 1..4 {
            let wear = Gamma.draw(own, 1.0, &mut stream);
            increments.push(one(unit, [f64::from(at), f64::from(at + 1)], wear, Known::Exact));
        }
    }
    Observations { units: (0..units).map(|unit| unit.to_string()).collect(), increments }
}

fn without_entries(data: &Observations) -> Observations {
    let increments = data.increments.iter().filter(|one| one.is_growth()).cloned().collect();
    Observations { increments, ..data.clone() }
}

#[test]
fn the_bias_of_units_that_entered_below_a_limit_is_taken_out() {
    // Rates of mean 4 over shapes of 4: wear of 1 per unit of exposure; half of all units enter.
    for (cv, from_new) in [(0.0, true), (0.5, true), (0.5, false)] {
        let data = selected(0.9, cv, 400, 3, from_new);
        // Of ln alpha / beta, in standard errors.
        let off = |data: &Observations| {
            let fit = match cv > 0.0 {
                true => estimate_units(data, &Model::default()).expect("a maximum").fit,
                false => estimate(data, &Model::default()).expect("a maximum"),
            };
            let c = &fit.covariance;
            (fit.phi[0] - fit.phi[1]) / (c[0][0] + c[1][1] - 2.0 * c[0][1]).sqrt()
        };
        let (with, without) = (off(&data), off(&without_entries(&data)));
        // Without, wear comes out too slow.
        assert!(with.abs() < 3.0, "{cv} {from_new}: {with}");
        assert!(without < -4.0, "{cv} {from_new}: {without}");
    }
}

#[test]
fn readings_beyond_the_gauge_are_no_loss_of_slow_units() {
    // Units are read up to 6 and leave the gauge's range at 4: what is left of their last increments is a bound.
    let mut increments = Vec::new();
    for unit in 0..300 {
        let (mut level, mut stream) = (0.0, Stream::new(8, unit as u64, 0));
        for at in 0..6 {
            let wear = Gamma.draw([2.0_f64.ln(), 2.0_f64.ln()], 1.0, &mut stream);
            let is_beyond = level + wear >= 4.0;
            let (wear, known) = if is_beyond { (4.0 - level, Known::AtLeast) } else { (wear, Known::Exact) };
            increments.push(one(unit, [f64::from(at), f64::from(at + 1)], wear, known));
            level += wear;
            if is_beyond {
                break;
            }
        }
    }
    let data = Observations { units: (0..300).map(|unit| unit.to_string()).collect(), increments };
    let beta = |data: &Observations| {
        let fit = estimate(data, &Model::default()).expect("a maximum");
        (fit.parameters()[1] - 2.0) / fit.standard_errors()[1]
    };
    let exact = data.increments.iter().filter(|one| one.is_exact()).cloned().collect();
    let dropped = beta(&Observations { increments: exact, ..data.clone() });
    // In standard errors; the increments that were cut off are the large ones.
    assert!(beta(&data).abs() < 3.0 && dropped > 4.0, "{} {dropped}", beta(&data));
}

#[test]
fn what_no_process_takes_is_refused() {
    let through = |unit: usize| one(unit, [0.0, 3.0], 2.0, Known::Through { at: 1.0, below: 0.5 });
    let increments: Vec<Increment> = (0..6).map(through).collect();
    let data = Observations { units: (0..6).map(|unit| unit.to_string()).collect(), increments };
    for process in PROCESSES {
        let found = estimate(&data, &Model { process, ..Model::default() });
        assert_eq!(found == Err(crate::fit::FitError::NoBridge), process.name() == "inverse-gaussian");
    }
    let bound = |unit: usize| one(unit, [0.0, 3.0], 2.0, Known::AtLeast);
    let increments: Vec<Increment> = (0..6).map(bound).collect();
    let bounds = estimate(&Observations { increments, ..data }, &Model::default());
    assert_eq!(bounds, Err(crate::fit::FitError::TooFewExact { increments: 0 }));
}
