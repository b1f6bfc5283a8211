//! Differences between units: public data against independent optimisers, the boundary, the law of the test.

use super::super::*;
use super::{close, lasers};
use crate::data::{Increment, Observations, Rounding};
use crate::fit::maximise::maximise;
use crate::process::{Gamma, InverseGaussian, PROCESSES, Process, Wiener};

#[test]
fn lasers_differ_as_independent_optimisers_found() {
    let of = |process: &'static dyn Process| {
        estimate_units(&lasers(), &Model { process, ..Model::default() }).unwrap()
    };
    // Figures of independent optimisers, to all digits that they gave.
    let found = of(&Gamma);
    let [alpha, rate, cv] = found.fit.parameters()[..] else { panic!() };
    close(found.fit.log_likelihood, 93.738_929, 6e-9);
    close(alpha, 39.030_9, 2e-6);
    close(rate, 19.871, 2e-5);
    close(1.0 / (cv * cv), 28.878_6, 2e-6);
    close(1.0 / (cv * cv * rate), 1.453_31, 4e-6);
    assert!(!found.boundary && found.test.p_value < 1e-10);
    let found = of(&InverseGaussian);
    let [drift, spread, cv] = found.fit.parameters()[..] else { panic!() };
    close(found.fit.log_likelihood, 95.326_768, 6e-9);
    close(1.0 / drift, 0.508_633, 1e-6);
    close(cv / drift, 0.089_558, 6e-6);
    close(spread, 71.876_7, 1e-6);
    // The last digit is cut off.
    close(of(&Wiener).fit.log_likelihood, 69.188_413, 1.5e-8);
}

#[test]
fn the_interval_of_a_variation_ends_where_the_likelihood_has_fallen() {
    let found = estimate_units(&lasers(), &Model::default()).unwrap();
    let Interval { low, high } = found.cv_interval(&lasers(), 0.95).unwrap();
    let wide = found.fit.model;
    for end in [low, high] {
        let mut from = found.fit.phi.clone();
        from[2] = end.ln();
        let (_, point) = maximise(&wide, &lasers().increments, &from, Some(2)).unwrap();
        // By the law of fifteen units: more than the 3.84 of chi-square.
        let critical = found.critical(&lasers(), 0.95).unwrap()(end);
        close(2.0 * (found.fit.log_likelihood - point.value), critical, 1e-8);
        assert!(critical > 4.2 && critical < 4.5, "{critical}");
    }
    assert!(low < found.fit.cv().unwrap() && found.fit.cv().unwrap() < high);
}

#[test]
fn no_difference_is_an_answer() {
    // Units whose increments are a permutation of the same numbers wear alike, more than chance would have it.
    let wears = [0.8, 1.3, 0.6, 1.1, 1.5, 0.7];
    let one = |at: usize| Increment {
        unit: at / 6,
        from: (at % 6) as f64,
        to: (at % 6) as f64 + 1.0,
        wear: wears[(at + at / 6) % 6],
        ln_covariates: vec![],
        row: 0,
        ..Increment::default()
    };
    let units = (0..5).map(|unit| unit.to_string()).collect();
    let data = Observations { units, increments: (0..30).map(one).collect() };
    for process in PROCESSES {
        let found = estimate_units(&data, &Model { process, ..Model::default() }).unwrap();
        assert!(found.boundary && found.fit == found.plain, "{process:?}");
        assert_eq!((found.test.statistic, found.test.p_value, found.test.asymptotic_p), (0.0, 1.0, 1.0));
        close(found.aic(), found.plain.aic() + 2.0, 1e-15);
        let Interval { low, high } = found.cv_interval(&data, 0.95).unwrap();
        assert!(low == 0.0 && high > 0.01 && high < 1.0, "{process:?}: {high}");
    }
    let one_unit = Observations { units: vec!["a".into()], increments: data.increments[..6].to_vec() };
    assert_eq!(estimate_units(&one_unit, &Model::default()).unwrap_err(), FitError::OneUnit);
    // Read to tenths, which they are, they wear alike as well.
    let rounded = Model { resolution: Some(Rounding::to(0.1)), ..Model::default() };
    let found = estimate_units(&data, &rounded).unwrap();
    assert!(found.boundary && found.fit == found.plain);
}

#[test]
fn the_law_of_the_test_is_that_of_the_ratio_of_variances() {
    // A Wiener process of 5 units, 4 readings each: the statistic by its definition from the squares between and within units, and
    // the p-value of F by the tables of its law.
    let wears = [
        [1.0, 1.4, 0.9, 1.2],
        [2.0, 1.7, 2.2, 1.6],
        [0.7, 1.1, 0.8, 0.4],
        [1.5, 1.1, 1.3, 1.8],
        [1.9, 1.2, 1.6, 1.5],
    ];
    let one = |at: usize| Increment {
        unit: at / 4,
        from: (at % 4) as f64,
        to: (at % 4) as f64 + 1.0,
        wear: wears[at / 4][at % 4],
        ln_covariates: vec![],
        row: 0,
        ..Increment::default()
    };
    let units = (0..5).map(|unit| unit.to_string()).collect();
    let data = Observations { units, increments: (0..20).map(one).collect() };
    let found = estimate_units(&data, &Model { process: &Wiener, ..Model::default() }).unwrap();
    let means = wears.map(|unit| unit.iter().sum::<f64>() / 4.0);
    let mean = means.iter().sum::<f64>() / 5.0;
    let between: f64 = means.iter().map(|own| 4.0 * (own - mean).powi(2)).sum();
    let within: f64 =
        wears.iter().zip(means).flat_map(|(unit, own)| unit.map(|wear| (wear - own).powi(2))).sum();
    let statistic =
        20.0 * ((between + within) / 20.0).ln() - 15.0 * (within / 15.0).ln() - 5.0 * (between / 5.0).ln();
    // The maximum is found to 1e-13 of the log-likelihood.
    close(found.test.statistic, statistic, 1e-9);
    close(found.test.p_value, crate::special::f_above(4.0, 15.0, between / 4.0 / (within / 15.0)), 1e-8);
}
