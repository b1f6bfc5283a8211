//! Parameters of which the readings say nothing: any value is as good, and none is an estimate.

use super::*;

/// Whether the model is refused, for whichever reason the rounding of its likelihood shows first.
fn is_refused(model: &Model, data: &Observations) -> bool {
    matches!(estimate(data, model), Err(FitError::NotTold | FitError::NotConverged))
}

#[test]
fn an_exponent_of_readings_long_after_the_start_is_refused() {
    for process in PROCESSES {
        let model = Model { process, power_law: true, ..Model::default() };
        // An exponent of 0.0608, where its search begins, was told with an error of 62 to 7000.
        for start in [1e6, 1e8, 1e9, 1e10] {
            let mut readings = readings(GAAS, [0, 1, 2], None, 1e-3);
            readings.iter_mut().for_each(|one| one.exposure += start);
            let data = Observations::new(&readings, false, Gauge::Exact).unwrap();
            assert!(is_refused(&model, &data), "{process:?} {start}");
        }
        // Late, but told: an error of 0.4.
        let mut readings = readings(GAAS, [0, 1, 2], None, 1e-3);
        readings.iter_mut().for_each(|one| one.exposure += 20.0);
        let data = Observations::new(&readings, false, Gauge::Exact).unwrap();
        assert!(estimate(&data, &model).is_ok(), "{process:?}");
    }
}

#[test]
fn covariates_that_are_powers_of_each_other_are_refused() {
    let loads = |power: f64| {
        let mut readings = readings(GAAS, [0, 1, 2], None, 1e-3);
        for one in &mut readings {
            let load = 1.5 + f64::from(one.unit.parse::<u32>().unwrap() % 3);
            one.covariates = vec![load, load.powf(power)];
        }
        Observations::new(&readings, false, Gauge::Exact).unwrap()
    };
    for process in PROCESSES {
        let model = Model { process, covariates: 2, ..Model::default() };
        // By 1.7 for the Gamma and by 0.3 for the Wiener process powers were told with an error of half a million and more.
        for power in [0.3, 0.5, 1.0, 1.7, 2.0] {
            assert!(is_refused(&model, &loads(power)), "{process:?} {power}");
        }
        assert!(estimate(&loads(1.7), &Model { covariates: 1, ..model }).is_ok(), "{process:?}");
    }
}
