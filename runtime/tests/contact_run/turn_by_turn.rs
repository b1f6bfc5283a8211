//! Turns one by one: the same run, stopped, with wear between them.

use std::ops::ControlFlow;

use linkwear_runtime::wear::{Area, Profile};
use linkwear_runtime::{ContactInfo, RunError, SetupError, Span, Watch};

use crate::common::journal::{smooth, wear};
use crate::journals::{CLEARANCE, TURN, loaded, rk4, run, runner, steady, swinging};

#[test]
fn turn_by_turn_is_the_same_run_and_goes_on_from_a_kept_state() {
    // Without friction, under a load that keeps its direction, both begin alike: a runner begins as under way.
    let pulsing = |t: f64| {
        let size = 45.0 + 5.0 * (std::f64::consts::TAU * t / TURN).sin();
        [0.6 * size, 0.8 * size]
    };
    let system = loaded(ContactInfo { restitution: 0.5, ..smooth() }, pulsing);
    let whole = run(&system, 0.0, rk4(TURN / 3600.0), Span::Turns(3.0), 0);
    let mut runner = runner(&system);
    runner.turns(1, Watch::NONE).expect("it turns");
    let kept = runner.state();
    let second = runner.measure(Watch::NONE).expect("it turns");
    let expected = &whole.turns[1][0];
    // Ends of turns are found from different begins: some last places of the time.
    let close = |a: f64, b: f64| (a - b).abs() < 1e-9 * b.abs();
    assert!(close(second.joints[0].wear_integral, expected.wear_integral), "{second:?} {expected:?}");
    assert!(close(second.joints[0].mean_force, expected.mean_force));
    assert!(second.statistics.energy_error_J < 1e-8 * second.statistics.energy_throughput_J);
    assert_eq!(second.statistics.evaluations, 3600 * 4 + 1);
    let after = runner.state();
    runner.restore(&kept).expect("it is its own");
    let again = runner.measure(Watch::NONE).expect("it turns");
    assert_eq!((again, runner.state()), (second, after), "to the last bit");
}

#[test]
fn a_stopped_turn_leaves_the_runner_where_it_was() {
    let system = loaded(ContactInfo { restitution: 0.5, ..smooth() }, swinging);
    let mut runner = runner(&system);
    let before = runner.state();
    let hear = |part: f64| if part > 0.3 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
    let error = runner.measure(Watch::new(&hear)).expect_err("it was stopped");
    assert!(matches!(error, RunError::Interrupted { .. }));
    assert_eq!(runner.state(), before);
}

#[test]
fn wear_is_set_between_turns_and_the_journal_follows() {
    let system = loaded(ContactInfo { wear: wear(Area::Projected, true), ..smooth() }, steady);
    let mut runner = runner(&system);
    runner.set_worn(0, 5e-6, None).expect("it fits");
    assert_eq!(runner.clearances(), [CLEARANCE + 5e-6]);
    let scalar = runner.measure(Watch::NONE).expect("it turns").joints.remove(0);
    // It follows the surface, only a softer contact goes a little deeper: no crossing, no separation.
    assert_eq!(scalar.losses, 0.0);
    let even = Profile::try_from(vec![5e-6; 72]).expect("a profile");
    runner.set_worn(0, 0.0, Some(even)).expect("it fits");
    let profile = runner.measure(Watch::NONE).expect("it turns").joints.remove(0);
    // An even profile is the same clearance; forces ring a little from the change before.
    assert!((profile.wear_integral - scalar.wear_integral).abs() < 1e-3 * scalar.wear_integral);
    let error = runner.set_worn(0, -2e-5, None).expect_err("less than nothing");
    assert!(matches!(&error, SetupError::Clearance { joint, .. } if joint == "R"), "{error}");
    // The mean of 72 equal depths rounds 72 times.
    assert!((runner.clearances()[0] - CLEARANCE - 5e-6).abs() < 1e-19, "nothing has changed");
}
