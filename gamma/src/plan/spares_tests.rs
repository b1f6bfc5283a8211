//! Spares of a fleet against closed forms and drawn histories.

use rand::RngExt;
use rand::distr::Open01;

use super::*;
use crate::life::{Lifetime, Weibull};
use crate::random::Stream;

#[test]
fn replacements_of_exponential_lives_are_poisson() {
    let life = Weibull { scale: 2.0, shape: 1.0 };
    for (parts, time) in [(1, 4.0), (7, 3.0), (200, 1.0)] {
        let mean = parts as f64 * time / 2.0;
        let found =
            spares(&PlannedLife { life: &life, age: None }, Standstill::default(), (parts, time), 0.95)
                .expect("valid");
        assert!((found.mean / mean - 1.0).abs() < 1e-6, "{} {mean}", found.mean);
        let (mut p, mut sum, mut needed) = ((-mean).exp(), 0.0, 0);
        for k in 0.. {
            if let Some(count) = k_of(&found, k) {
                // The rule of trapezia at 2000 steps and more, over 200 parts.
                assert!((count - p).abs() < 1e-5, "{parts} {k}: {count} {p}");
            }
            sum += p;
            if sum < 0.95 {
                needed = k + 1;
            }
            if sum > 1.0 - 1e-9 {
                break;
            }
            p *= mean / (k as f64 + 1.0);
        }
        assert_eq!(found.needed, needed);
    }
}

fn k_of(found: &Spares, k: usize) -> Option<f64> {
    k.checked_sub(found.first).and_then(|at| found.counts.get(at).copied())
}

#[test]
fn parts_replaced_at_an_age_need_as_many_spares_as_ages_fit() {
    let life = Weibull { scale: 100.0, shape: 5.0 };
    let planned = PlannedLife { life: &life, age: Some(10.0) };
    let at_once = Standstill::default();
    let found = spares(&planned, at_once, (3, 35.0), 0.9).expect("valid");
    // 3 in 35, hardly a failure before.
    assert!((found.mean - 9.0).abs() < 1e-2, "{found:?}");
    assert_eq!(found.needed, 9);
    let plain = PlannedLife { life: &life, age: None };
    let without = spares(&plain, at_once, (3, 35.0), 0.9).expect("valid");
    assert!(without.mean < 0.1, "{without:?}");
    assert_eq!(spares(&plain, at_once, (0, 35.0), 0.9), Err(PlanError::NoParts));
    assert!(matches!(spares(&plain, at_once, (1, 1e6), 0.9), Err(PlanError::TooMany { .. })));
    assert!(spares(&plain, at_once, (1, 1.0), 1.0).is_err());
    let negative = Standstill { failure: -1.0, ..at_once };
    assert!(spares(&plain, negative, (1, 1.0), 0.9).is_err());
}

#[test]
fn standstills_come_between_replacements() {
    let none = Standstill::default();
    // Planned ones alone: at 10, 30, 50.
    let life = Weibull { scale: 1000.0, shape: 5.0 };
    let standstill = Standstill { preventive: 10.0, ..none };
    let found =
        spares(&PlannedLife { life: &life, age: Some(10.0) }, standstill, (3, 55.0), 0.9).expect("valid");
    assert!((found.mean - 9.0).abs() < 1e-2 && found.needed == 9, "{found:?}");
    // Exponential lives of mean 1: the k-th replacement comes after k of them and k - 1 standstills of 0.7.
    let life = Weibull { scale: 1.0, shape: 1.0 };
    let plain = PlannedLife { life: &life, age: None };
    let found = spares(&plain, Standstill { failure: 0.7, ..none }, (1, 4.0), 0.9).expect("valid");
    let erlang = |k: i32, t: f64| {
        let term = |i: i32| (1..=i).fold((-t).exp(), |product, j| product * t / f64::from(j));
        if t > 0.0 { 1.0 - (0..k).map(term).sum::<f64>() } else { 0.0 }
    };
    let mean: f64 = (1..=6).map(|k| erlang(k, 4.0 - 0.7 * f64::from(k - 1))).sum();
    assert!((found.mean - mean).abs() < 1e-5, "{} {mean}", found.mean);
    // Both kinds, the longer standstill after failures, beside drawn histories.
    let age = 1.2;
    let standstill = Standstill { preventive: 0.2, failure: 0.9 };
    let found =
        spares(&PlannedLife { life: &life, age: Some(age) }, standstill, (1, 6.0), 0.9).expect("valid");
    assert_as_drawn(&found, &life, (age, standstill), 6.0, 5);
}

#[test]
fn parts_replaced_at_an_age_are_counted_however_often_it_fits() {
    // Hardly a failure in all of them: as many as ages fit, a little more or less than a whole number of them.
    let life = Weibull { scale: 1e4, shape: 20.0 };
    for (age, standstill, ages) in
        [(98.31, 0.0, 10.0), (98.31, 0.0, 60.0), (7.77, 1.3, 90.0), (31.7, 400.0, 33.0)]
    {
        let planned = PlannedLife { life: &life, age: Some(age) };
        let at_ages = Standstill { preventive: standstill, ..Standstill::default() };
        let turn = age + standstill;
        for (more, counted) in [(-0.01, ages - 1.0), (0.0, ages), (0.01, ages)] {
            let time = ages * turn - standstill + more * turn;
            let found = spares(&planned, at_ages, (10, time), 0.95).expect("valid");
            // Failures before the age: 1e-38 of the parts.
            assert!((found.mean - 10.0 * counted).abs() < 1e-9, "{age} {ages} {more}: {found:?}");
            assert_eq!(found.needed as f64, 10.0 * counted);
        }
    }
}

#[test]
fn lives_narrower_than_any_step_are_counted_by_their_mean() {
    let life = Weibull { scale: 100.0, shape: 2000.0 };
    let mean = life.moments().expect("valid").mean;
    let plain = PlannedLife { life: &life, age: None };
    for (lives, ended) in [(60.2, 60.0), (59.8, 59.0), (90.2, 90.0)] {
        let found = spares(&plain, Standstill::default(), (1, lives * mean), 0.9).expect("valid");
        // Sums of so many lives scatter by 0.006 of one, shared between steps by 0.06.
        assert!((found.mean - ended).abs() < 1e-3, "{lives}: {found:?}");
    }
}

/// Some fail before, so that replacements come at ages and between them.
#[test]
fn ages_and_failures_together_are_those_of_drawn_histories() {
    let life = Weibull { scale: 3000.0, shape: 2.6 };
    let (age, time) = (874.7357, 20_000.0);
    let planned = PlannedLife { life: &life, age: Some(age) };
    let found = spares(&planned, Standstill::default(), (1, time), 0.9).expect("valid");
    assert_as_drawn(&found, &life, (age, Standstill::default()), time, 7);
}

/// The mean of one part beside that of drawn histories, within four standard errors.
fn assert_as_drawn(
    found: &Spares,
    life: &Weibull,
    (age, standstill): (f64, Standstill),
    end: f64,
    seed: u64,
) {
    let mut stream = Stream::new(seed, 0, 0);
    let (mut sum, mut squares, drawn) = (0.0, 0.0, 100_000);
    for _ in 0..drawn {
        let (mut time, mut count) = (0.0, 0.0);
        loop {
            let own = life.scale * (-stream.sample::<f64, _>(Open01).ln()).powf(1.0 / life.shape);
            time += own.min(age);
            if time > end {
                break;
            }
            count += 1.0;
            time += if own < age { standstill.failure } else { standstill.preventive };
        }
        sum += count;
        squares += count * count;
    }
    let mean = sum / f64::from(drawn);
    let error = ((squares / f64::from(drawn) - mean * mean) / f64::from(drawn)).sqrt();
    assert!((found.mean - mean).abs() < 4.0 * error, "{} {mean} +- {error}", found.mean);
}
