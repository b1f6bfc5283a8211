//! A fit's file written, read, and taken at covariates.

use super::*;
use crate::data::{Gauge, Observations, Reading};
use crate::fit::{Model, estimate};
use crate::life::Estimate;
use crate::process::{Gamma, PROCESSES, Process};

/// Two loads, ten units each, wear 1.5 times as fast at the second load, and some scatter.
fn readings(unit_of_load: f64) -> Vec<Reading> {
    let scatter = |unit: usize, step: usize| 1.0 + 0.3 * (((7 * unit + 5 * step) % 11) as f64 / 5.0 - 1.0);
    let mut readings = Vec::new();
    for unit in 0..20 {
        let (load, pace) = if unit % 2 == 0 { (2.0, 1.0) } else { (5.0, 1.5) };
        let mut wear = 0.0;
        for step in 0..6 {
            readings.push(Reading {
                unit: unit.to_string(),
                exposure: step as f64,
                wear,
                covariates: vec![load / unit_of_load],
                row: readings.len() + 2,
                ..Reading::default()
            });
            wear += pace * scatter(unit, step);
        }
    }
    readings
}

fn fitted(process: &'static dyn Process, unit_of_load: f64) -> FitFile {
    let data = Observations::new(&readings(unit_of_load), false, Gauge::Exact).expect("growing wear");
    let model = Model { process, covariates: 1, ..Model::default() };
    let fit = estimate(&data, &model).expect("a maximum");
    FitFile::new(&fit, &data, &["load".to_owned()], ("um", "h"), false)
}

fn at(file: &FitFile, load: f64) -> Estimate {
    file.estimate(&[("load".to_owned(), load)]).expect("one value")
}

#[test]
fn a_load_far_outside_those_of_the_data_is_told() {
    // Loads are 2 and 5, a factor of 2.5: outside by as much is 0.8 and 12.5.
    for process in PROCESSES {
        let file = fitted(process, 1.0);
        let told = |load: f64| file.far_covariates(&[("load".to_owned(), load)]);
        for near in [0.81, 2.0, 3.0, 5.0, 12.4] {
            assert_eq!(told(near), Vec::<String>::new(), "{process:?}");
        }
        for far in [0.79, 12.6, 500.0] {
            let warnings = told(far);
            assert!(warnings.len() == 1 && warnings[0].contains("from 2.0000 to 5.0000"), "{warnings:?}");
        }
        // A file without increments does not say which loads it saw.
        assert!(
            FitFile { increments: Vec::new(), ..file }
                .far_covariates(&[("load".to_owned(), 500.0)])
                .is_empty()
        );
    }
}

#[test]
fn a_fit_at_a_load_does_not_depend_on_the_unit_of_the_load() {
    for process in PROCESSES {
        // With the load counted in units of 3, a load of 3 is 1: there the parameters and their covariance hold.
        let (plain, scaled) = (at(&fitted(process, 1.0), 3.0), fitted(process, 3.0));
        let one = at(&scaled, 1.0);
        for k in 0..2 {
            let (a, b) = (plain.parameters()[k], one.parameters()[k]);
            assert!((a / b - 1.0).abs() < 1e-9, "{process:?}: {a} {b}");
            assert!((b / scaled.parameters[k] - 1.0).abs() < 1e-14);
        }
        for gradient in [[1.0, 0.0], [0.0, 1.0], [1.0, 1.0]] {
            let (a, b) = (plain.variance(&gradient), one.variance(&gradient));
            // Both maxima are found to 1e-10; the change of variables is linear in the logarithms, so exact.
            assert!((a / b - 1.0).abs() < 1e-7, "{process:?}: {a} {b}");
        }
    }
}

/// A fit whose load acts on the rate, on the size of increments, or on both.
fn sized(process: &'static dyn Process, data: &Observations, sizes: usize, covariates: usize) -> FitFile {
    let model = Model { process, covariates, sizes, ..Model::default() };
    let fit = estimate(data, &model).expect("a maximum");
    FitFile::new(&fit, data, &vec!["load".to_owned(); sizes + covariates], ("um", "h"), false)
}

#[test]
fn a_load_that_acts_on_sizes_takes_all_of_a_factor_on_wear() {
    // Load 2 or 5, as a logarithm beside each increment; wear times load to the power 0.7.
    let with_values = |copies: usize, power: f64| {
        let mut data = Observations::new(&readings(1.0), false, Gauge::Exact).expect("growing wear");
        for one in &mut data.increments {
            let ln = one.ln_covariates[0];
            one.ln_covariates = vec![ln; copies];
            one.wear *= libm::exp(power * ln);
        }
        data
    };
    for covariates in [0, 1] {
        let at_power = |power: f64| sized(&Gamma, &with_values(1 + covariates, power), 1, covariates);
        let (plain, more) = (at_power(0.0), at_power(0.7));
        let size = |file: &FitFile| file.covariates[covariates].coefficient;
        // The likelihood is the same but for a constant: both maxima are found to 1e-7.
        assert!((size(&more) - size(&plain) - 0.7).abs() < 1e-6, "{} {}", size(&more), size(&plain));
        assert!((more.parameters[0] / plain.parameters[0] - 1.0).abs() < 1e-6);
        // Once for both, however often the load counts.
        let [alpha, beta] = at(&more, 5.0).parameters();
        let rate = if covariates == 1 { more.covariates[0].coefficient } else { 0.0 };
        assert!((alpha / (more.parameters[0] * libm::pow(5.0, rate)) - 1.0).abs() < 1e-13);
        assert!((beta / (more.parameters[1] * libm::pow(5.0, -size(&more))) - 1.0).abs() < 1e-13);
        let read = FitFile::parse(&more.to_json().to_string()).expect("what was written");
        assert_eq!(FitFile { text: String::new(), ..read }, more);
        assert!(
            matches!(more.informed(&[("load".to_owned(), 5.0)]), Ok(estimate) if estimate.is_uncertain())
        );
    }
    for process in PROCESSES {
        // A drift, not the spread beside it.
        let file = sized(process, &with_values(1, 0.0), 1, 0);
        let (own, scales) = (at(&file, 5.0).parameters(), process.size_powers());
        for k in 0..2 {
            let factor = libm::pow(5.0, scales[k] * file.covariates[0].coefficient);
            assert!((own[k] / (file.parameters[k] * factor) - 1.0).abs() < 1e-13, "{process:?}");
        }
    }
}

#[test]
fn values_that_do_not_match_the_covariates_are_refused() {
    let text = r#"{ "alpha": 2.0, "beta": 1.0, "covariates": [{ "name": "load", "coefficient": 0.5 }] }"#;
    let fit = FitFile::parse(text).expect("a fit");
    assert!((at(&fit, 4.0).parameters()[0] - 4.0).abs() < 1e-14);
    let load = |value: f64| ("load".to_owned(), value);
    let cases = [
        vec![],
        vec![load(1.0), load(2.0)],
        vec![load(-1.0)],
        vec![load(f64::NAN)],
        vec![("mass".to_owned(), 1.0)],
    ];
    for values in cases {
        let error = fit.estimate(&values).expect_err("no match");
        assert!(error.line == Some(1) && !error.cure.is_empty(), "{values:?}: {error}");
    }
    let wrong = FitFile { covariance: vec![vec![1.0]], ..fit };
    assert!(wrong.estimate(&[load(1.0)]).is_err());
}

#[test]
fn a_fit_survives_its_file_bit_for_bit() {
    for process in PROCESSES {
        let file = fitted(process, 1.0);
        let read = FitFile::parse(&file.to_json().to_string()).expect("what was written");
        assert_eq!(FitFile { text: String::new(), ..read }, file);
    }
    let error = FitFile::parse("{\n\"process\": \"levy\", \"alpha\": 1, \"beta\": 1 }").expect_err("unknown");
    assert!(error.line == Some(2) && error.message.contains("gamma, wiener, inverse-gaussian"), "{error}");
}

#[test]
fn a_file_of_another_format_is_refused() {
    let of =
        |format: &str| FitFile::parse(&format!("{{\n\"format\": {format},\n\"alpha\": 1, \"beta\": 1 }}"));
    assert!(of("1").is_ok());
    for format in ["99", "0", "1.5", "\"1\""] {
        let error = of(format).expect_err("another format");
        let is_told = error.message == format!("`format` is {format}: this program reads fits of format 1");
        assert!(is_told && error.line == Some(2) && error.cure.contains("fit the data again"), "{error}");
    }
}
