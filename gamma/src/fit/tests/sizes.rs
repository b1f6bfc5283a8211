//! Numbers so large or so small that their products are none.

use super::*;

/// The lasers with wear and exposure in other units.
fn scaled(wear: f64, exposure: f64) -> Observations {
    let mut readings = readings(GAAS, [0, 1, 2], None, 1e-3);
    for reading in &mut readings {
        reading.wear *= wear;
        reading.exposure *= exposure;
    }
    Observations::new(&readings, false, Gauge::Noisy).unwrap()
}

#[test]
fn numbers_that_cannot_be_computed_with_are_not_called_wear_without_scatter() {
    let fitted = |process: &'static dyn Process, power_law: bool, data: &Observations| {
        estimate(data, &Model { process, power_law, ..Model::default() })
    };
    for (process, wear, exposure) in [
        (&Gamma as &'static dyn Process, 1e300, 1.0),
        (&Gamma, 1.0, 1e200),
        (&InverseGaussian, 1e150, 1.0),
        (&Wiener, 1.0, 1e200),
    ] {
        let found = fitted(process, false, &scaled(wear, exposure));
        assert_eq!(found, Err(FitError::OutOfRange), "{process:?}");
    }
    let found = fitted(&InverseGaussian, true, &scaled(1e150, 1.0));
    assert_eq!(found, Err(FitError::OutOfRange));
    // What was found before is found still.
    close(fitted(&Gamma, false, &scaled(1e150, 1.0)).unwrap().parameters()[1], 14.114_459_33e-150, 1e-8);
}
