//! Consistent starts: closeness to the guess, held values, and every way to fail.

mod common;

use common::Dense;
use common::bars::{At, Bar, Bars};
use common::body::Body;
use linkwear_runtime::{AssemblyError, State, assemble};
use nalgebra::Vector3;

/// Crank 0.3, coupler 1.0, rocker 0.8, ground 0.9; start values as (value, held).
fn four_bar(angles: [(f64, bool); 3], speeds: [(f64, bool); 3], redundant: Option<f64>) -> Dense<Bars> {
    let froms = [At::Ground(0.0, 0.0), At::End(0), At::Ground(0.9, 0.0)];
    let bars = (0..3)
        .map(|i| Bar {
            length: [0.3, 1.0, 0.8][i],
            start: angles[i],
            speed: speeds[i],
            ..Bar::unit(froms[i], 0.0, 0.0)
        })
        .collect();
    Dense::new(Bars { bars, loops: vec![(1, At::End(2))], redundant, bearing: None }, &[("gravity", 9.81)])
}

fn start<M: common::Model>(system: &Dense<M>) -> Result<State, AssemblyError> {
    assemble(system, &system.description, &system.parameters(), 0.0)
}

fn open(system: &Dense<Bars>, q: &[f64]) -> f64 {
    let bars = &system.model;
    let (a, b) = (bars.position(At::End(1), q), bars.position(At::End(2), q));
    (a[0] - b[0]).abs().max((a[1] - b[1]).abs())
}

const GUESS: [(f64, bool); 3] = [(0.3, false), (0.6, false), (1.3, false)];
const STILL: [(f64, bool); 3] = [(0.0, false); 3];

#[test]
fn loops_close_to_rounding_near_the_guess() {
    let system = four_bar(GUESS, STILL, None);
    let state = start(&system).expect("it closes");
    // Sums of numbers of order one.
    assert!(open(&system, &state.q) < 1e-15);
    for (q, (guess, _)) in state.q.iter().zip(GUESS) {
        assert!((q - guess).abs() < 0.2);
    }
}

#[test]
fn the_guess_chooses_the_branch() {
    let above = start(&four_bar(GUESS, STILL, None)).expect("it closes");
    let below = [(-0.3, false), (-0.6, false), (-1.3, false)];
    let below = start(&four_bar(below, STILL, None)).expect("it closes");
    for (a, b) in above.q.iter().zip(below.q) {
        // Mirror images through the same operations.
        assert!((a + b).abs() < 1e-14);
    }
}

#[test]
fn held_values_are_met_to_the_bit() {
    let guess = [(0.4, true), (0.6, false), (1.3, false)];
    let speeds = [(7.0, true), (0.0, false), (0.0, false)];
    let state = start(&four_bar(guess, speeds, None)).expect("it closes");
    assert_eq!((state.q[0], state.v[0]), (0.4, 7.0));
}

#[test]
fn speeds_are_the_nearest_to_the_wish() {
    let system = four_bar(GUESS, [(5.0, false), (1.0, false), (-2.0, false)], None);
    let State { q, v } = start(&system).expect("it closes");
    // The one direction of motion m: v = (wish . m / m . m) m.
    let [c, s] = [f64::cos, f64::sin];
    let mut motion = [1.0, 0.0, 0.0];
    let (a, b) = (-0.3 * s(q[0]), 0.3 * c(q[0]));
    let determinant = -s(q[1]) * -0.8 * c(q[2]) - 0.8 * s(q[2]) * c(q[1]);
    motion[1] = (-a * -0.8 * c(q[2]) + b * 0.8 * s(q[2])) / determinant;
    motion[2] = (-s(q[1]) * -b - c(q[1]) * -a) / determinant;
    let dot = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
    let amount = dot(&[5.0, 1.0, -2.0], &motion) / dot(&motion, &motion);
    for (v, m) in v.iter().zip(motion) {
        // Rounding of numbers of order 10 through a well-conditioned solve.
        assert!((v - amount * m).abs() < 1e-13);
    }
}

#[test]
fn a_far_guess_is_reached_in_limited_steps() {
    let guess = [(2.5, false), (-2.0, false), (-3.0, false)];
    let system = four_bar(guess, STILL, None);
    let state = start(&system).expect("it closes");
    assert!(open(&system, &state.q) < 1e-14);
}

#[test]
fn bars_too_short_say_how_far_the_loop_stays_open() {
    let bar = |from, length, angle| Bar { length, ..Bar::unit(from, angle, 0.0) };
    let bars = vec![
        bar(At::Ground(0.0, 0.0), 0.3, 0.1),
        bar(At::End(0), 0.2, 0.2),
        bar(At::Ground(0.9, 0.0), 0.1, 3.0),
    ];
    let system = Dense::new(
        Bars { bars, loops: vec![(1, At::End(2))], redundant: None, bearing: None },
        &[("gravity", 9.81)],
    );
    let error = start(&system).expect_err("0.3 m are missing");
    let AssemblyError::NoConvergence { ref joint, residual_m, .. } = error else { panic!("{error}") };
    assert_eq!(joint, "loop0");
    // 0.9 - 0.3 - 0.2 - 0.1, approached as far as least squares go.
    assert!((residual_m - 0.3).abs() < 1e-3, "{residual_m}");
    assert!(error.to_string().contains("check lengths and points"));
}

#[test]
fn held_positions_in_conflict_are_named() {
    let guess = [(0.3, true), (0.6, false), (2.9, true)];
    let error = start(&four_bar(guess, STILL, None)).expect_err("one freedom, two demands");
    let AssemblyError::HeldPositions { ref names, .. } = error else { panic!("{error}") };
    assert!(names.len() == 2 && names[0].starts_with("`q0`") && names[1].starts_with("`q2`"), "{names:?}");
}

#[test]
fn held_speeds_in_conflict_are_named() {
    let speeds = [(1.0, true), (0.0, false), (50.0, true)];
    let error = start(&four_bar(GUESS, speeds, None)).expect_err("one freedom, two demands");
    let AssemblyError::HeldSpeeds { ref names, .. } = error else { panic!("{error}") };
    assert!(names.len() == 2 && names[0].starts_with("`v0`") && names[1].starts_with("`v2`"), "{names:?}");
}

#[test]
fn a_driver_against_a_dead_point_is_told() {
    // A crank and a coupler in line with the ground: the driven end cannot move outwards.
    let bars = vec![
        Bar::unit(At::Ground(0.0, 0.0), 0.0, 0.0),
        Bar { law: Some(|t| [0.0 + t, 1.0, 0.0]), ..Bar::unit(At::Ground(3.0, 0.0), 0.0, 0.0) },
        Bar::unit(At::End(0), 0.0, 0.0),
        Bar::unit(At::End(2), 0.0, 0.0),
    ];
    let loops = vec![(3, At::Ground(3.0, 0.0)), (2, At::Ground(2.0, 0.0))];
    let mut system = Dense::new(Bars { bars, loops, redundant: None, bearing: None }, &[("gravity", 9.81)]);
    system.model.bars[1].from = At::Ground(3.0, 0.0);
    // The chain itself is rigid and consistent: it starts at rest.
    assert!(start(&system).is_ok());
    // Now the driven bar carries the end of the stretched chain: its speed across cannot be matched.
    system.model.loops = vec![(3, At::End(1)), (2, At::Ground(2.0, 0.0))];
    system.model.bars[1] = Bar {
        law: Some(|t| [std::f64::consts::FRAC_PI_2 + t, 1.0, 0.0]),
        ..Bar::unit(At::Ground(3.0, -1.0), 0.0, 0.0)
    };
    let error = start(&system).expect_err("the chain is stretched");
    assert!(matches!(error, AssemblyError::SpeedsImpossible { .. }), "{error}");
}

#[test]
fn dropped_rows_that_stay_open_are_no_success() {
    assert!(start(&four_bar(GUESS, STILL, Some(0.0))).is_ok());
    let error = start(&four_bar(GUESS, STILL, Some(1e-3))).expect_err("the dropped row contradicts");
    let AssemblyError::NoConvergence { residual_m, .. } = error else { panic!("{error}") };
    assert!(residual_m > 1e-4);
}

#[test]
fn undefined_start_values_are_named() {
    let guess = [(0.3, false), (f64::NAN, false), (1.3, false)];
    let error = start(&four_bar(guess, STILL, None)).expect_err("not a number");
    assert_eq!(error, AssemblyError::NonFinite { what: "start value of q1".to_owned() });
}

#[test]
fn a_pose_is_closed_on_the_manifold_with_held_components() {
    let body = Body {
        mass: 1.0,
        inertia: [0.1, 0.2, 0.3],
        pin: Some((Vector3::new(0.0, 0.0, 0.5), Vector3::zeros())),
        start: [0.9, 0.3, -0.2, 0.4, 0.1, 0.25, -0.2],
        speed: [1.0, 2.0, 3.0, 0.0, 0.0, 0.0],
        held: [false, false, false, false, false, true, false],
    };
    let system = Dense::new(body, &[("gravity", 9.81)]);
    let State { q, .. } = start(&system).expect("a held height within reach");
    assert_eq!(q[5], 0.25);
    // Unit length, and half a metre from the pin, to rounding.
    assert!((q[..4].iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 1e-15);
    assert!((q[4..].iter().map(|x| x * x).sum::<f64>() - 0.25).abs() < 1e-15);
}
