//! A loop with clearance.

use std::f64::consts::PI;

use linkwear_runtime::{ContactInfo, Integrator, Run, Settings, Span, Watch, simulate};

use crate::common::Dense;
use crate::common::bars::{At, Bar, Bars};
use crate::common::journal::{coulomb, smooth};
use crate::journals::{CLEARANCE, dopri5, rk4};

/// Crank, coupler, rocker; the crank turns four times a second in a bearing with clearance, the rocker is damped.
fn four_bar(contact: ContactInfo) -> Dense<Bars> {
    let bar = |from, length, angle, damping| Bar { length, damping, ..Bar::unit(from, angle, 0.0) };
    let crank = Bar {
        law: Some(|t| [8.0 * PI * t + 0.3, 8.0 * PI, 0.0]),
        mass: 0.5,
        ..bar(At::Ground(0.0, 0.0), 0.12, 0.3, 0.0)
    };
    let coupler = bar(At::End(0), 0.4, 0.5, 0.0);
    let rocker = bar(At::Ground(0.4, 0.0), 0.3, 1.6, 0.5);
    let bars = Bars {
        bars: vec![crank, coupler, rocker],
        loops: vec![(1, At::End(2))],
        bearing: Some(contact),
        ..Bars::default()
    };
    Dense::new(bars, &[("gravity", 9.81), ("clearance", CLEARANCE)])
}

fn turn_of(system: &Dense<Bars>, integrator: Integrator, span: Span, samples: usize) -> Run {
    let settings = Settings::new(integrator, span, samples);
    let result = simulate(system, &system.description, &system.parameters(), &settings, Watch::NONE)
        .expect("it starts");
    assert_eq!(result.stopped, None);
    result
}

#[test]
fn a_loop_starts_with_its_journal_at_rest_in_contact() {
    let system = four_bar(smooth());
    let result = turn_of(&system, rk4(5e-6), Span::Time(1e-3), 201);
    let force = result.rows[0].len() - 3;
    let first = result.rows[0][force];
    assert!(first > 1.0, "{first}");
    for (t, row) in result.times.iter().zip(&result.rows) {
        // Without the right side and depth it would ring between zero and twice the force. What is left is the
        // turn of the load, about 6 rad/s, over a millisecond, and the swing that this begins.
        assert!((row[force] - first).abs() < 0.05 * first, "{t} {} {first}", row[force]);
    }
}

#[test]
fn a_loop_with_clearance_balances_its_energy_and_wears_the_same_by_every_method() {
    let contact = ContactInfo { restitution: 0.9, friction: coulomb(0.05), ..smooth() };
    let system = four_bar(contact);
    let turn = |method, balanced: f64| {
        let result = turn_of(&system, method, Span::Turns(1.0), 0);
        let statistics = result.statistics;
        // Rounding of the loop, a few places of coordinates of a metre.
        assert!(statistics.max_loop_error_m < 1e-13, "{statistics:?}");
        assert!(statistics.energy_error_J < balanced * statistics.energy_throughput_J, "{statistics:?}");
        assert_eq!((result.turns.len(), &result.warnings[..]), (1, &[][..]));
        assert_eq!(result.turns[0][0].losses, 0.0);
        result.turns[0][0].wear_integral
    };
    let fixed = turn(rk4(1e-5), 1e-8);
    let adaptive = turn(dopri5(1e-9), 1e-8);
    // Half the step changes the first by 3e-10, a tenth of the tolerance the second by 5e-11.
    assert!((fixed - adaptive).abs() < 1e-9 * adaptive, "{fixed} {adaptive}");
    // Order 2: 1.6e-7 at 10 µs, four times that here.
    let implicit = turn(Integrator::GeneralizedAlpha { step: 2e-5, rho: 0.9 }, 1e-7);
    assert!((implicit - adaptive).abs() < 2e-6 * adaptive, "{implicit} {adaptive}");
}
