//! Spinning bodies: unit quaternions, energy and momentum, a body on a pin.

mod common;

use common::Dense;
use common::body::Body;
use linkwear_runtime::{CLOSED, Integrator, Run, Settings, Span, Watch, simulate};
use nalgebra::Vector3;

fn run(system: &Dense<Body>, integrator: Integrator, time: f64) -> Run {
    let settings = Settings::new(integrator, Span::Time(time), 51);
    let result = simulate(system, &system.description, &system.parameters(), &settings, Watch::NONE)
        .expect("it starts");
    assert_eq!(result.stopped, None);
    result
}

const DOPRI5: Integrator = Integrator::Dopri5 { tolerance: 1e-10, max_step: None };

/// Spins about its middle axis, so it tumbles.
fn tumbler(gravity: f64, pin: Option<(Vector3<f64>, Vector3<f64>)>) -> Dense<Body> {
    let body = Body {
        mass: 2.0,
        inertia: [0.1, 0.2, 0.3],
        pin,
        start: [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, -0.5],
        speed: [0.05, 6.0, 0.05, 1.0, 0.0, 0.5],
        held: [false; 7],
    };
    Dense::new(body, &[("gravity", gravity)])
}

#[test]
fn a_free_tumbling_body_keeps_momentum_energy_and_unit_quaternion() {
    for integrator in [DOPRI5, Integrator::Rk4 { step: 1e-3 }] {
        let result = run(&tumbler(0.0, None), integrator, 10.0);
        let first = result.rows[0].clone();
        for row in &result.rows {
            let length: f64 = row[..4].iter().map(|x| x * x).sum();
            // Normalised at every step: one rounding per component.
            assert!((length - 1.0).abs() < 1e-15);
            for i in 7..13 {
                // A hundred radians turned at tolerance 1e-10 per step (RK4: about 1e-9 as well).
                assert!((row[i] - first[i]).abs() < 3e-8, "{i}: {} {}", row[i], first[i]);
            }
        }
        // It did tumble: the middle axis turned over.
        assert!(result.rows.iter().any(|row| row[1].abs() > 0.5 || row[3].abs() > 0.5));
        assert!(result.statistics.energy_error_J < 1e-8, "{:?}", result.statistics);
    }
}

#[test]
fn a_body_on_a_pin_keeps_energy_vertical_momentum_and_the_pin() {
    let result = run(&tumbler(9.81, Some((Vector3::new(0.0, 0.0, 0.5), Vector3::zeros()))), DOPRI5, 10.0);
    let vertical = |row: &[f64]| row[9] + (row[4] * row[11] - row[5] * row[10]);
    let first = vertical(&result.rows[0]);
    for row in &result.rows {
        // Momentum of order 1 at tolerance 1e-10 per step, a few thousand steps.
        assert!((vertical(row) - first).abs() < 1e-8);
        let length: f64 = row[..4].iter().map(|x| x * x).sum();
        assert!((length - 1.0).abs() < 1e-15);
    }
    let statistics = result.statistics;
    assert!(statistics.energy_error_J < 1e-8 * statistics.energy_throughput_J, "{statistics:?}");
    assert!(statistics.max_loop_error_m < CLOSED && statistics.projections > 0);
}
