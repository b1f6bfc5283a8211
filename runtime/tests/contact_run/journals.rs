//! The journals that most of the tests run, and how.

use std::f64::consts::PI;

use linkwear_runtime::{
    ContactInfo, Integrator, Run, SINGULAR_PIVOT, Settings, Span, TurnRunner, Watch, simulate,
};

use crate::common::journal::{Journal, Load};

pub const CLEARANCE: f64 = 1e-5;

pub fn run(system: &Journal, gravity: f64, integrator: Integrator, span: Span, samples: usize) -> Run {
    let settings = Settings::new(integrator, span, samples);
    let result = simulate(system, &system.description, &[gravity, CLEARANCE], &settings, Watch::NONE)
        .expect("it starts");
    assert_eq!(result.stopped, None);
    result
}

pub fn dopri5(tolerance: f64) -> Integrator {
    Integrator::Dopri5 { tolerance, max_step: None }
}

pub fn rk4(step: f64) -> Integrator {
    Integrator::Rk4 { step }
}

/// Column of a quantity of the contact: x is generated, y and the rest follow.
pub fn column(run: &Run, name: &str) -> Vec<f64> {
    let names: Vec<&str> = run.channels.iter().map(|channel| channel.name.as_ref()).collect();
    assert_eq!(names, ["R.x", "R.y", "R.gap", "R.Fn", "R.vt", "R.contact_angle"]);
    run.column(name).expect("a column")
}

/// A journal of 1 kg that flies across its bearing at 0.1 m/s, no gravity.
pub fn flyer(contact: ContactInfo) -> Journal {
    Journal::new(contact).held([0.0, 0.0], [0.1, 0.0])
}

/// A driven journal under a load that turns with 3/10 of its speed.
pub fn loaded(contact: ContactInfo, load: Load) -> Journal {
    let mut system = Journal::new(contact).driven(SPEED);
    system.load = load;
    // Against the free oscillation of the start.
    system.damping = 200.0;
    system
}

pub const SPEED: f64 = 200.0;
pub const TURN: f64 = 2.0 * PI / SPEED;

pub fn swelling(t: f64) -> [f64; 2] {
    let size = 40.0 + 10.0 * (3000.0 * t).sin();
    [size * (60.0 * t).cos(), size * (60.0 * t).sin()]
}

/// Swells and ebbs along one direction.
pub fn breathing(t: f64) -> [f64; 2] {
    let size = 1.0 + 0.3 * (SPEED * t).sin();
    [30.0 * size, 40.0 * size]
}

/// Once around per turn of the driver.
pub fn circling(t: f64) -> [f64; 2] {
    [40.0 * (SPEED * t).cos(), 40.0 * (SPEED * t).sin()]
}

/// Presses to +x and to -x in every turn.
pub fn swinging(t: f64) -> [f64; 2] {
    [40.0 * (SPEED * t).cos(), 0.0]
}

pub fn steady(_: f64) -> [f64; 2] {
    [30.0, 40.0]
}

pub fn runner(system: &Journal) -> TurnRunner<'_> {
    let method = rk4(TURN / 3600.0);
    TurnRunner::new(system, &system.description, &[0.0, CLEARANCE], method, SINGULAR_PIVOT)
        .expect("it starts")
}

pub fn every_method(step: f64) -> [Integrator; 3] {
    [dopri5(1e-9), rk4(step), Integrator::GeneralizedAlpha { step, rho: 0.8 }]
}
