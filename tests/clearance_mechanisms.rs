//! Shipped mechanisms with clearance run: contact resolved, energy accounted for, wear positive.

mod support;

use linkwear_runtime::{Integrator, Settings, Span};
use support::{compiled, run_with};

/// A few turns at a tolerance that resolves every impact.
fn check(name: &str, turns: f64) {
    let compiled = compiled(name, &[], None);
    let method = Integrator::Dopri5 { tolerance: 1e-10, max_step: None };
    let run = run_with(&compiled, &Settings::new(method, Span::Turns(turns), 11)).run;
    let statistics = &run.statistics;
    println!("{name}: {statistics:?}\n{:?}\n{:?}", run.turns, run.warnings);
    assert!(run.rows.iter().flatten().all(|value| value.is_finite()));
    // Friction, damping of the contacts and of the joints included.
    assert!(
        statistics.energy_error_J < 1e-8 * statistics.energy_throughput_J,
        "{name}: {:e} J of {:e} J",
        statistics.energy_error_J,
        statistics.energy_throughput_J
    );
    assert_eq!(run.turns.len(), turns as usize);
    let contacts = &compiled.description().contacts;
    for (contact, turn) in run.turns.iter().flat_map(|turn| contacts.iter().zip(turn)) {
        let wears = contact.wear.is_some();
        assert!(turn.wear_integral > 0.0 && (turn.depth > 0.0) == wears, "{name}: {turn:?}");
    }
}

#[test]
fn a_loose_pin_flies_and_hits_at_5000_rpm() {
    check("slider_crank_clearance", 3.0);
}

#[test]
fn a_four_bar_wears_at_two_bearings() {
    check("four_bar_wear", 2.0);
}

#[test]
fn a_loose_ball_wears() {
    check("rssr_ball_wear", 1.0);
}
