//! Wear coefficients that go with pressure, speed and parameters.

use linkwear_runtime::wear::{Area, Profile, Step};
use linkwear_runtime::{ContactInfo, RunError, SINGULAR_PIVOT, TurnRunner, Watch};

use crate::common::journal::{smooth, wear};
use crate::journals::{CLEARANCE, SPEED, TURN, breathing, loaded, rk4, runner, steady};

/// (1 + (pressure/1e5)^2) sqrt(sliding speed) (1 + the parameter), as steps.
fn by_pressure_and_speed() -> Vec<Step> {
    vec![
        Step::Given(0),
        Step::Number(1e5),
        Step::Div(0, 1),
        Step::Mul(2, 2),
        Step::Number(1.0),
        Step::Add(4, 3),
        Step::Given(1),
        Step::Sqrt(6),
        Step::Mul(5, 7),
        Step::Given(2),
        Step::Add(4, 9),
        Step::Mul(8, 10),
    ]
}

#[test]
fn a_coefficient_by_pressure_speed_and_a_parameter_wears_as_quadrature_says() {
    let contact = || ContactInfo { wear: wear(Area::Projected, true), ..smooth() };
    let by_hand = |force: f64, parameter: f64| {
        let (pressure, speed) = (force / (2.0 * 0.01 * 0.02), SPEED * 0.01);
        let factor = (1.0 + (pressure / 1e5).powi(2)) * speed.sqrt() * (1.0 + parameter);
        factor * 1e-8 / 3.5e9 * pressure * speed
    };
    let turn = |load, parameter: f64| {
        let mut system = loaded(contact(), load).wearing_by(by_pressure_and_speed()).wearing(0.5);
        // The parameter is gravity too: it shall not press.
        system.mass = 1.0;
        let method = rk4(TURN / 3600.0);
        let parameters = [parameter, CLEARANCE];
        let mut runner = TurnRunner::new(&system, &system.description, &parameters, method, SINGULAR_PIVOT)
            .expect("it starts");
        runner.turns(2, Watch::NONE).expect("it turns");
        runner.measure(Watch::NONE).expect("it turns").joints.remove(0)
    };
    let integral = |depths: &Profile| depths.depths().iter().sum::<f64>() * depths.bin_angle();
    for parameter in [0.0, 0.5] {
        // 30 N and 40 N less the weight, which the parameter gives.
        let force = 30.0_f64.hypot(40.0 - parameter);
        let turn = turn(steady, parameter);
        let depth = TURN * by_hand(force, parameter);
        // It rings by 1e-8 of itself, as above.
        assert!((turn.depth / depth - 1.0).abs() < 1e-7, "{:e} {depth:e}", turn.depth);
        // Volume over 2 r L is the depth of the projected area: bush and journal have that of the depth.
        let volume = turn.depth * 2.0 * 0.01 * 0.02;
        let (bush, journal) = (turn.deposit.expect("a profile"), turn.journal.expect("a profile"));
        assert!((integral(&bush) * (0.01 + CLEARANCE) * 0.02 / volume - 1.0).abs() < 1e-7);
        assert!((integral(&journal) * 0.01 * 0.02 / (0.5 * volume) - 1.0).abs() < 1e-7);
    }
    // A force that swells and ebbs along one direction, by Simpson's rule.
    let turn = turn(breathing, 0.0);
    let force = |t: f64| breathing(t)[0].hypot(breathing(t)[1]);
    let parts = 2000;
    let simpson: f64 = (0..=parts)
        .map(|at| {
            let weight = if at == 0 || at == parts { 1.0 } else { f64::from(2 + 2 * (at % 2)) };
            weight * by_hand(force(TURN * f64::from(at) / f64::from(parts)), 0.0)
        })
        .sum();
    let depth = simpson * TURN / f64::from(3 * parts);
    // The journal's own acceleration is (200/3e4)^2 = 4e-5 of what moves it, and cubes of the force count.
    assert!((turn.depth / depth - 1.0).abs() < 3e-4, "{:e} {depth:e}", turn.depth);
    // What is spread is taken between the ends of steps: second order, 3600 a turn.
    let spread = integral(&turn.deposit.expect("a profile")) * (0.01 + CLEARANCE) * 0.02;
    assert!((spread / (turn.depth * 2.0 * 0.01 * 0.02) - 1.0).abs() < 1e-5, "{spread:e}");
}

#[test]
fn a_coefficient_below_zero_stops_the_run() {
    let contact = ContactInfo { wear: wear(Area::Projected, false), ..smooth() };
    let steps = vec![Step::Number(-1.0)];
    let system = loaded(contact, steady).wearing_by(steps);
    let error = runner(&system).measure(Watch::NONE).expect_err("no wear backwards");
    assert!(matches!(&error, RunError::NonFinite { .. }), "{error}");
}
