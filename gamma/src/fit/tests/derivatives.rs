//! The derivatives of the likelihood are those of its values.

use crate::data::Increment;
use crate::fit::Model;
use crate::process::{PROCESSES, Process};

fn sample(wear: f64, from: f64, to: f64, ln_load: f64) -> Increment {
    Increment { unit: 0, from, to, wear, ln_covariates: vec![ln_load; 2], row: 0, ..Increment::default() }
}

#[test]
fn derivatives_are_those_of_the_value() {
    for process in PROCESSES {
        derivatives_of(process);
    }
}

fn derivatives_of(process: &'static dyn Process) {
    for (units_differ, sizes) in [(false, 0), (true, 0), (false, 1)] {
        let model =
            Model { process, power_law: true, covariates: 1, sizes, units_differ, ..Model::default() };
        derivatives_of_model(&model, &[0.7, 0.9, 0.8, 0.5, -0.9][..model.parameters()]);
    }
}

fn derivatives_of_model(model: &Model, phi: &[f64]) {
    let process = model.process;
    let data = [sample(0.8, 0.0, 2.0, 0.3), sample(1.7, 2.0, 5.0, -0.4)];
    let here = model.point(phi, &data, None);
    assert!((here.value - model.value(phi, &data)).abs() < 1e-14);
    let step = 1e-5;
    for i in 0..phi.len() {
        let moved = |by: f64| {
            let mut phi = phi.to_vec();
            phi[i] += by;
            model.point(&phi, &data, None)
        };
        let (up, down) = (moved(step), moved(-step));
        // Central differences: error step^2 and eps / step, both about 1e-10; the censored term's curvature 1e-6.
        let slope = (up.value - down.value) / (2.0 * step);
        assert!((slope - here.gradient[i]).abs() < 1e-8, "{process:?} {i}: {slope} {}", here.gradient[i]);
        for j in 0..phi.len() {
            let bend = -(up.gradient[j] - down.gradient[j]) / (2.0 * step);
            assert!(
                (bend - here.information[i][j]).abs() < 2e-6,
                "{i} {j}: {bend} {}",
                here.information[i][j]
            );
        }
    }
}
