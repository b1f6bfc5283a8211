//! Impacts and rest: what bounces return, energy, where a start lies.

use std::f64::consts::PI;

use linkwear_runtime::contact::Restitution;
use linkwear_runtime::{ContactInfo, RunWarning, Settings, Span, Watch, simulate};

use crate::common::journal::{Journal, coulomb, smooth};
use crate::journals::{CLEARANCE, column, dopri5, every_method, flyer, rk4, run};

#[test]
fn bounces_return_their_restitution() {
    for (law, e) in
        [(Restitution::Exact, 0.9), (Restitution::Exact, 0.4), (Restitution::LankaraniNikravesh, 0.9)]
    {
        let contact = ContactInfo { law, restitution: e, ..smooth() };
        let system = flyer(contact);
        // Across 10 µm takes 0.1 ms, the impact about as long: 0.35 ms see one bounce.
        let after = run(&system, 0.0, dopri5(1e-10), Span::Time(3.5e-4), 36);
        let x = column(&after, "R.x");
        // Flying back freely: the last two samples, 1e-5 s apart.
        let speed = (x[34] - x[35]) / 1e-5 / 0.1;
        // Exact returns e; Lankarani-Nikravesh 0.9132 for 0.9 (known to 4 digits).
        let (expected, accuracy) = if law == Restitution::Exact { (e, 1e-6) } else { (0.9132, 5e-5) };
        assert!((speed - expected).abs() < accuracy, "{law:?} {e}: {speed}");
    }
}

#[test]
fn energy_is_balanced_with_and_without_losses() {
    let friction = coulomb(0.2);
    let lossless = smooth();
    let rough = ContactInfo { restitution: 0.7, friction, ..smooth() };
    let printed = ContactInfo { law: Restitution::LankaraniNikravesh, restitution: 1.0, ..smooth() };
    for (contact, gives_losses) in [(lossless, false), (rough, true), (printed, false)] {
        let mut system = Journal::new(contact).held([3e-6, -2e-6], [0.1, 0.07]);
        system.turning = 5.0;
        // Steps of 0.1 µs: a hundredth of a radian of a contact of 10 kHz; kinks at each onset.
        for method in [dopri5(1e-11), rk4(1e-7)] {
            let result = run(&system, 9.81, method, Span::Time(0.01), 101);
            let statistics = result.statistics;
            assert!(
                statistics.energy_error_J < 1e-8 * statistics.energy_throughput_J,
                "{method:?} {statistics:?}"
            );
            let forces = column(&result, "R.Fn");
            assert!(forces.iter().any(|force| *force > 1.0), "it bounced");
            let energy = 0.5 * (0.01 + 0.0049) + 0.5 * 1e-3 * 25.0;
            let expected_losses = if gives_losses { 1e-3 * energy } else { 0.0 };
            assert!(statistics.energy_throughput_J > expected_losses);
        }
    }
}

#[test]
fn a_dropped_journal_comes_to_rest_at_its_resting_penetration() {
    let contact = ContactInfo { restitution: 0.3, ..smooth() };
    let mut system = Journal::new(contact).held([0.0, 0.0], [0.0, 0.0]);
    system.damping = 200.0;
    let result = run(&system, 9.81, dopri5(1e-9), Span::Time(0.3), 31);
    let gap = column(&result, "R.gap");
    // K = 4/3 E* sqrt(R_eff), R_eff = (r + c) r / c.
    let stiffness = 4.0 / 3.0 * 115e9 * ((0.01 + CLEARANCE) * 0.01 / CLEARANCE).sqrt();
    let expected = (9.81 / stiffness).powf(2.0 / 3.0);
    // Step control holds offsets to 1e-9 of the clearance.
    assert!((-gap[30] - expected).abs() < 1e-6 * expected, "{} {expected}", -gap[30]);
    let angle = column(&result, "R.contact_angle");
    assert!((angle[30] + 0.5 * PI).abs() < 1e-6);
}

#[test]
fn a_start_without_offsets_rests_where_the_load_presses() {
    let mut system = Journal::new(smooth()).driven(4.0 * PI);
    system.load = |_| [30.0, 40.0 + 9.81];
    let result = run(&system, 9.81, dopri5(1e-10), Span::Time(1e-3), 11);
    for force in column(&result, "R.Fn") {
        // It rests: rounding of the penetration, 1e-21 m of 2e-7, and the tolerance.
        assert!((force - 50.0).abs() < 1e-6, "{force}");
    }
    for angle in column(&result, "R.contact_angle") {
        assert!((angle - (40.0_f64 / 30.0).atan()).abs() < 1e-9, "{angle}");
    }
}

#[test]
fn a_mechanism_at_rest_balances_whatever_rounding_says() {
    // The load carries the journal in the middle of its bearing, free of any force that is left.
    let mut system = Journal::new(smooth()).held([0.0, 0.0], [0.0, 0.0]);
    system.load = |_| [0.0, 9.81];
    for integrator in every_method(1e-3) {
        let settings = Settings::new(integrator, Span::Time(1.0), 2);
        let run = simulate(&system, &system.description, &[9.81, CLEARANCE], &settings, Watch::NONE)
            .expect("it starts");
        assert!(run.stopped.is_none(), "{:?}", run.stopped);
        assert!(!run.warnings.iter().any(|warning| matches!(warning, RunWarning::EnergyOff { .. })));
    }
}
