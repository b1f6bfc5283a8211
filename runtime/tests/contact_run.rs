//! Runs of joints with clearance: impacts, balance of energy, wear integrals and their order, located onsets,
//! turns, default start.

mod common;

use std::f64::consts::PI;
use std::ops::ControlFlow;

use common::journal::{Journal, coulomb, smooth, wear};
use linkwear_runtime::contact::{Restitution, Stiffness};
use linkwear_runtime::wear::{Area, Profile};
use linkwear_runtime::{
    AssemblyError, ContactInfo, Integrator, Run, RunError, RunWarning, SINGULAR_PIVOT, Settings, SetupError,
    Span, TurnRunner, simulate, write_csv,
};

const CLEARANCE: f64 = 1e-5;

fn run(system: &Journal, gravity: f64, integrator: Integrator, span: Span, samples: usize) -> Run {
    let settings = Settings::new(integrator, span, samples);
    let result = simulate(system, &system.description, &[gravity, CLEARANCE], &settings, &mut |_| {
        ControlFlow::Continue(())
    })
    .expect("it starts");
    assert_eq!(result.stopped, None);
    result
}

fn dopri5(tolerance: f64) -> Integrator {
    Integrator::Dopri5 { tolerance, max_step: None }
}

/// Dopri5 with steps short enough that none flies over the bearing.
fn rk4(step: f64) -> Integrator {
    Integrator::Rk4 { step }
}

/// Column of a quantity of the contact: x is generated, y and the rest follow.
fn column(system: &Journal, run: &Run, name: &str) -> Vec<f64> {
    let mut text = Vec::new();
    write_csv(&mut text, &system.description, run).expect("a vector takes every byte");
    let text = String::from_utf8(text).expect("ASCII");
    let header: Vec<&str> = text.lines().next().expect("a header").split(',').collect();
    assert_eq!(
        header,
        ["t [s]", "R.x [m]", "R.y [m]", "R.gap [m]", "R.Fn [N]", "R.vt [m/s]", "R.contact_angle [rad]"]
    );
    let at = header.iter().position(|column| column.starts_with(name)).expect("a column") - 1;
    run.rows.iter().map(|row| row[at]).collect()
}

/// A journal of 1 kg that flies across its bearing at 0.1 m/s, no gravity.
fn flyer(contact: ContactInfo) -> Journal {
    Journal::new(contact).held([0.0, 0.0], [0.1, 0.0])
}

#[test]
fn bounces_return_their_restitution() {
    for (law, e) in
        [(Restitution::Exact, 0.9), (Restitution::Exact, 0.4), (Restitution::LankaraniNikravesh, 0.9)]
    {
        let contact = ContactInfo { law, restitution: e, ..smooth() };
        let system = flyer(contact);
        // Across 10 µm takes 0.1 ms, the impact about as long: 0.35 ms see one bounce.
        let after = run(&system, 0.0, dopri5(1e-10), Span::Time(3.5e-4), 36);
        let x = column(&system, &after, "R.x");
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
            let forces = column(&system, &result, "R.Fn");
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
    let gap = column(&system, &result, "R.gap");
    // K = 4/3 E* sqrt(R_eff), R_eff = (r + c) r / c.
    let stiffness = 4.0 / 3.0 * 115e9 * ((0.01 + CLEARANCE) * 0.01 / CLEARANCE).sqrt();
    let expected = (9.81 / stiffness).powf(2.0 / 3.0);
    // Step control holds offsets to 1e-9 of the clearance.
    assert!((-gap[30] - expected).abs() < 1e-6 * expected, "{} {expected}", -gap[30]);
    let angle = column(&system, &result, "R.contact_angle");
    assert!((angle[30] + 0.5 * PI).abs() < 1e-6);
}

#[test]
fn a_start_without_offsets_rests_where_the_load_presses() {
    let mut system = Journal::new(smooth()).driven(4.0 * PI);
    system.load = |_| [30.0, 40.0 + 9.81];
    let result = run(&system, 9.81, dopri5(1e-10), Span::Time(1e-3), 11);
    for force in column(&system, &result, "R.Fn") {
        // It rests: rounding of the penetration, 1e-21 m of 2e-7, and the tolerance.
        assert!((force - 50.0).abs() < 1e-6, "{force}");
    }
    for angle in column(&system, &result, "R.contact_angle") {
        assert!((angle - (40.0_f64 / 30.0).atan()).abs() < 1e-9, "{angle}");
    }
}

/// A driven journal under a load that turns with 3/10 of its speed and swells.
fn loaded(contact: ContactInfo) -> Journal {
    let mut system = Journal::new(contact).driven(200.0);
    system.load = |t| {
        let size = 40.0 + 10.0 * (400.0 * t).sin();
        [size * (60.0 * t).cos(), size * (60.0 * t).sin()]
    };
    // Against the free oscillation of the start.
    system.damping = 2e3;
    system
}

#[test]
fn wear_integral_has_order_four_under_runge_kutta() {
    let contact = ContactInfo { restitution: 0.9, friction: coulomb(0.05), ..smooth() };
    let system = loaded(contact);
    let integral = |step: f64| {
        let result = run(&system, 0.0, rk4(step), Span::Turns(1.0), 0);
        assert_eq!(result.turns.len(), 1);
        result.turns[0].wear_integral_J
    };
    let turn = 2.0 * PI / 200.0;
    let [coarse, middle, fine] = [800.0, 1600.0, 3200.0].map(|steps| integral(turn / steps));
    let ratio = (coarse - middle) / (middle - fine);
    // 16 asymptotically; order 3 would give 8, order 5 32.
    assert!((11.0..23.0).contains(&ratio), "{ratio}: {coarse} {middle} {fine}");
}
