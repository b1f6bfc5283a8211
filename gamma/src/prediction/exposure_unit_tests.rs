//! Predictions by a power law, told in other units of exposure.

use super::*;
use crate::data::{Gauge, Observations, Reading as Datum};
use crate::error::LifeError;
use crate::fit::{Model, estimate};
use crate::fit_file::FitFile;
use crate::inspection::{InspectionError, Reading};
use crate::process::{Gamma, PROCESSES, Process, Wiener};
use crate::random::Stream;

/// Wear over the power 0.7 of exposure, which is counted in units of 1 / `unit`, in two environments.
fn readings(process: &dyn Process, units: usize, unit: f64) -> Vec<Datum> {
    let mut readings = Vec::new();
    for part in 0..units {
        let (mut stream, mut wear) = (Stream::new(11, part as u64, 0), 0.0);
        for step in 0..7_u8 {
            let at = |step: u8| f64::from(step).powf(0.7);
            if step > 0 {
                wear += process.draw([0.9, 0.4], at(step) - at(step - 1), &mut stream);
            }
            readings.push(Datum {
                unit: part.to_string(),
                exposure: f64::from(step) * unit,
                wear,
                covariates: vec![[0.5, 2.0][part % 2]],
                row: readings.len() + 2,
                ..Datum::default()
            });
        }
    }
    readings
}

fn fitted(process: &'static dyn Process, (units, covariates): (usize, usize), unit: f64) -> FitFile {
    let gauge = if process.is_increasing() { Gauge::Exact } else { Gauge::Noisy };
    let mut readings = readings(process, units, unit);
    readings.iter_mut().for_each(|one| one.covariates.truncate(covariates));
    let data = Observations::new(&readings, false, gauge).expect("wear");
    let model = Model { process, power_law: true, covariates, ..Model::default() };
    let fit = estimate(&data, &model).expect("a maximum");
    let names = ["load".to_owned()];
    FitFile::new(&fit, &data, &names[..covariates], ("um", "h"), false)
}

/// Times that are told, in the first unit of exposure.
fn told(process: &'static dyn Process, (units, covariates): (usize, usize), unit: f64) -> Vec<f64> {
    let values = [("load".to_owned(), 2.0)];
    let file = fitted(process, (units, covariates), unit);
    let fit = file.informed(&values[..covariates]).expect("its data");
    let state = OperatingState::new(40.0).expect("positive");
    let questions = Questions::default();
    let mut times = Vec::new();
    let mut add = |told: Prediction| {
        for band in told.quantiles {
            times.extend([band.lower, band.value, band.upper]);
        }
        times.extend([told.interval.0, told.interval.1]);
    };
    for method in [Method::Delta, Method::Draws { count: 100, seed: 3 }] {
        add(Prediction::by_fit(&fit, &state, method, &questions).expect("a law"));
    }
    let log = [(0.0, 0.0), (1.0, 2.0), (2.0, 4.5), (3.5, 6.0), (4.0, 6.5), (6.0, 8.1)];
    let log = log.map(|(time, wear)| Reading { time: time * unit, wear }).to_vec();
    let exact = History::exact(process, log.clone()).expect("rising");
    for prior in [Prior::Fit(fit.clone()), Prior::Flat { process, power_law: true }] {
        // Of few readings and an exponent that may be near zero the later lives have no number, in any unit.
        match Prediction::after(&exact, &prior, &state, &questions) {
            Err(InspectionError::Life(LifeError::Endless { .. })) => {}
            told => add(told.expect("explained")),
        }
    }
    // Particles take seconds: of one process.
    if process.name() == Gamma.name() {
        let effort = Effort { count: 4000, seed: 1 };
        let noisy = History::noisy(log).expect("numbers");
        add(Prediction::after_gauge(&noisy, &fit, &state, 0.5, effort, &questions).expect("explained"));
    }
    let lives = Prediction::possible_lives(&fit, &state, 40).expect("laws");
    times.extend(lives.as_slice().iter().map(Lifetime::typical));
    // With one answer left out, in one unit alone, there would be fewer.
    times.iter().map(|time| time / unit).collect()
}

#[test]
fn predictions_by_a_power_law_are_the_same_in_every_unit_of_exposure() {
    // Integrated over the parameters, by sets of them, by the normal law of their logarithms.
    let mut cases: Vec<_> = PROCESSES.into_iter().map(|process| (process, (10, 0))).collect();
    cases.extend([(&Wiener as &dyn Process, (10, 1)), (&Wiener, (70, 0))]);
    for (process, data) in cases {
        let plain = told(process, data, 1.0);
        for unit in [1e-6, 1e9] {
            let other = told(process, data, unit);
            assert_eq!(plain.len(), other.len());
            for (at, (a, b)) in plain.iter().zip(other).enumerate() {
                // The maximum is found to 1e-10, and what is drawn around it goes with it.
                assert!((b / a - 1.0).abs() < 1e-6, "{process:?} {data:?} {unit} {at}: {a} {b}");
            }
        }
    }
}
