//! A bar on a pivot against its closed form, with and without a driver, and what a run reports.

mod common;

use common::Dense;
use common::bars::{At, Bar, Bars};
use linkwear_runtime::{Integrator, Run, RunError, Settings, SetupError, Span, Watch, simulate};
use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::ControlFlow;
use std::sync::Mutex;

const GRAVITY: f64 = 9.81;

fn pendulum(bar: Bar) -> Dense<Bars> {
    Dense::new(Bars { bars: vec![bar], ..Bars::default() }, &[("gravity", GRAVITY)])
}

fn dopri5(tolerance: f64) -> Integrator {
    Integrator::Dopri5 { tolerance, max_step: None }
}

fn run(system: &Dense<Bars>, integrator: Integrator, time: f64, samples: usize) -> Run {
    let settings = Settings::new(integrator, Span::Time(time), samples);
    let run = simulate(system, &system.description, &system.parameters(), &settings, Watch::NONE);
    run.expect("the pendulum can start")
}

/// Jacobi's sn, cn, dn by descending Landen transformation (Abramowitz & Stegun 16.4).
fn jacobi(u: f64, k: f64) -> (f64, f64, f64) {
    let (mut a, mut b) = (vec![1.0_f64], (1.0 - k * k).sqrt());
    let mut c = vec![k];
    while c[c.len() - 1].abs() > 1e-17 {
        let last = a[a.len() - 1];
        c.push(0.5 * (last - b));
        a.push(0.5 * (last + b));
        b = (last * b).sqrt();
    }
    let n = a.len() - 1;
    let mut phase = 2.0_f64.powi(n as i32) * a[n] * u;
    for i in (1..=n).rev() {
        phase = 0.5 * (phase + (c[i] / a[i] * phase.sin()).asin());
    }
    let (sn, cn) = phase.sin_cos();
    (sn, cn, (1.0 - k * k * sn * sn).sqrt())
}

/// Angle from +x of the bar released at rest `swing` from hanging: sin(psi/2) = k cd(omega t).
fn exact(swing: f64, t: f64) -> f64 {
    let k = (0.5 * swing).sin();
    let (_, cn, dn) = jacobi((1.5 * GRAVITY).sqrt() * t, k);
    2.0 * (k * cn / dn).asin() - FRAC_PI_2
}

fn released(swing: f64) -> Dense<Bars> {
    pendulum(Bar::unit(At::Ground(0.0, 0.0), swing - FRAC_PI_2, 0.0))
}

fn worst(run: &Run, swing: f64) -> f64 {
    run.times.iter().zip(&run.rows).fold(0.0, |most, (t, row)| most.max((row[0] - exact(swing, *t)).abs()))
}

#[test]
fn adaptive_run_follows_the_elliptic_function() {
    let result = run(&released(2.0), dopri5(1e-12), 10.0, 101);
    // Error per step 1e-12, a thousand steps; phase errors grow with time: 1e-11 is the promise.
    let error = worst(&result, 2.0);
    assert!(error < 1e-11, "{error}");
    assert_eq!((result.times.len(), result.times[0], result.times[100]), (101, 0.0, 10.0));
    assert_eq!(result.stopped, None);
}

#[test]
fn fixed_step_run_follows_the_elliptic_function_with_order_four() {
    let error = |step| worst(&run(&released(2.0), Integrator::Rk4 { step }, 5.0, 26), 2.0);
    let (coarse, fine) = (error(4e-3), error(2e-3));
    // 16, asymptotic up to a tenth of an order.
    assert!((14.5..17.5).contains(&(coarse / fine)), "{coarse} {fine}");
}

#[test]
fn energy_drift_is_far_below_the_throughput() {
    let statistics = run(&released(3.0), dopri5(1e-10), 10.0, 11).statistics;
    assert!(statistics.energy_throughput_J > 50.0);
    // The promise for tolerance 1e-10 over 10 s.
    assert!(statistics.energy_error_J < 1e-8 * statistics.energy_throughput_J, "{statistics:?}");
    assert!(statistics.energy_error_J > 0.0);
}

#[test]
fn damping_shows_as_dissipated_work() {
    let bar = Bar { damping: 0.3, ..Bar::unit(At::Ground(0.0, 0.0), 0.0, 0.0) };
    let statistics = run(&pendulum(bar), dopri5(1e-10), 10.0, 11).statistics;
    assert!(statistics.energy_error_J < 1e-8 * statistics.energy_throughput_J, "{statistics:?}");
}

#[test]
fn passing_the_top_unwraps_the_angle_even_between_samples() {
    // Enough speed to turn over and over; fewer samples than turns.
    let system = pendulum(Bar::unit(At::Ground(0.0, 0.0), -FRAC_PI_2, 30.0));
    let sparse = run(&system, dopri5(1e-9), 10.0, 3);
    let dense = run(&system, dopri5(1e-9), 10.0, 2001);
    let (a, b) = (sparse.rows[2][0], dense.rows[2000][0]);
    assert!(b > 200.0, "{b}");
    // Same steps: the samples do not influence them, so not even rounding differs by more than unwrapping.
    assert!((a - b).abs() < 1e-12);
}

#[test]
fn samples_do_not_change_the_steps() {
    let few = run(&released(2.0), dopri5(1e-8), 3.0, 2).statistics.steps;
    assert_eq!(run(&released(2.0), dopri5(1e-8), 3.0, 301).statistics.steps, few);
}

#[test]
fn two_runs_agree_in_every_bit() {
    let rows = || run(&released(2.5), dopri5(1e-9), 4.0, 41).rows;
    assert_eq!(rows(), rows());
}

/// Crank at 2 turns per second with an oscillation on top.
fn law(t: f64) -> [f64; 3] {
    let (s, c) = (3.0 * t).sin_cos();
    [4.0 * PI * t + 0.2 * s, 4.0 * PI + 0.6 * c, -1.8 * s]
}

#[test]
fn drive_torque_of_a_driven_bar_is_inertia_plus_weight() {
    let bar = Bar { law: Some(law), damping: 0.7, ..Bar::unit(At::Ground(0.0, 0.0), 0.0, 0.0) };
    let system = pendulum(bar);
    let result = run(&system, dopri5(1e-10), 2.0, 21);
    for (t, row) in result.times.iter().zip(&result.rows) {
        let [q, v, a] = law(*t);
        let torque = a / 3.0 + 0.5 * GRAVITY * q.cos() + 0.7 * v;
        // Everything is a function of time here; cos of an angle up to 25.
        assert!((row[4] - torque).abs() < 1e-12, "{t}");
    }
    let statistics = result.statistics;
    assert!(statistics.energy_error_J < 1e-8 * statistics.energy_throughput_J, "{statistics:?}");
}

#[test]
fn a_double_pendulum_on_a_driven_crank_keeps_its_balance() {
    let bars = vec![
        Bar { law: Some(law), ..Bar::unit(At::Ground(0.0, 0.0), 0.0, 0.0) },
        Bar { damping: 0.1, ..Bar::unit(At::End(0), -1.0, 0.0) },
        Bar::unit(At::End(1), -2.0, 1.0),
    ];
    let system = Dense::new(Bars { bars, ..Bars::default() }, &[("gravity", GRAVITY)]);
    let statistics = run(&system, dopri5(1e-10), 10.0, 11).statistics;
    assert!(statistics.energy_error_J < 1e-8 * statistics.energy_throughput_J, "{statistics:?}");
}

#[test]
fn turns_end_where_the_driver_closes_them() {
    let bar =
        Bar { law: Some(|t| [4.0 * PI * t, 4.0 * PI, 0.0]), ..Bar::unit(At::Ground(0.0, 0.0), 0.0, 0.0) };
    let system = pendulum(bar);
    let settings = Settings { settle: Span::Turns(1.0), ..Settings::new(dopri5(1e-8), Span::Turns(2.5), 6) };
    let result =
        simulate(&system, &system.description, &[GRAVITY], &settings, Watch::NONE).expect("it turns");
    // A turn takes half a second; the root is found to the last bits.
    assert!((result.times[0] - 0.5).abs() < 1e-15 && (result.times[5] - 1.75).abs() < 1e-15);
}

#[test]
fn turns_without_a_turning_driver_are_an_error() {
    let system = released(1.0);
    let settings = Settings::new(dopri5(1e-8), Span::Turns(1.0), 2);
    let outcome = simulate(&system, &system.description, &[GRAVITY], &settings, Watch::NONE);
    assert_eq!(outcome, Err(RunError::NoTurns));
}

#[test]
fn a_driver_that_only_swings_never_makes_a_turn() {
    let bar =
        Bar { law: Some(|t| [t.sin(), t.cos(), -t.sin()]), ..Bar::unit(At::Ground(0.0, 0.0), 0.0, 0.0) };
    let system = pendulum(bar);
    let settings = Settings::new(dopri5(1e-8), Span::Turns(1.0), 2);
    let outcome = simulate(&system, &system.description, &[GRAVITY], &settings, Watch::NONE);
    let Err(RunError::TurnsNotReached { reached, .. }) = outcome else { panic!("{outcome:?}") };
    assert!((reached - 0.5 / PI).abs() < 1e-3);
}

#[test]
fn senseless_settings_and_parameters_are_named() {
    let system = released(1.0);
    let go = |settings: Settings, parameters: &[f64]| {
        simulate(&system, &system.description, parameters, &settings, Watch::NONE).expect_err("senseless")
    };
    let good = Settings::new(dopri5(1e-8), Span::Time(1.0), 2);
    for (settings, wanted) in [
        (Settings { span: Span::Time(0.0), ..good }, "span"),
        (Settings { span: Span::Time(f64::NAN), ..good }, "span"),
        (Settings { samples: 1, ..good }, "samples"),
        (Settings { settle: Span::Time(-1.0), ..good }, "settle"),
        (Settings { integrator: dopri5(0.0), ..good }, "tolerance"),
        (Settings { integrator: Integrator::Rk4 { step: -1.0 }, ..good }, "step"),
        (Settings { integrator: Integrator::GeneralizedAlpha { step: 1e-3, rho: 1.5 }, ..good }, "rho"),
        (Settings { singular_pivot: 1.0, ..good }, "singular_pivot"),
    ] {
        let error = go(settings, &[GRAVITY]);
        let RunError::Setup(SetupError::Setting { name, .. }) = &error else { panic!("{error}") };
        assert_eq!(*name, wanted);
    }
    assert_eq!(
        go(good, &[]),
        RunError::Setup(SetupError::Length { what: "parameters", expected: 1, found: 0 })
    );
    let error = go(good, &[f64::INFINITY]);
    assert!(error.to_string().contains("`gravity` is inf"), "{error}");
}

#[test]
fn a_request_to_stop_keeps_the_samples() {
    let system = released(1.0);
    let settings = Settings::new(dopri5(1e-10), Span::Time(10.0), 1001);
    let fractions = Mutex::new(Vec::new());
    let hear = |fraction: f64| {
        fractions.lock().expect("one thread").push(fraction);
        if fraction < 0.5 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    };
    let result = simulate(&system, &system.description, &[GRAVITY], &settings, Watch::new(&hear));
    let result = result.expect("it starts");
    let Some(RunError::Interrupted { t }) = result.stopped else { panic!("{:?}", result.stopped) };
    assert!((5.0..6.0).contains(&t));
    assert_eq!(result.rows.len(), result.times.len());
    assert!((500..=600).contains(&result.rows.len()));
    assert!(fractions.into_inner().expect("one thread").is_sorted());
}

#[test]
fn no_samples_still_give_statistics() {
    let result = run(&released(1.0), dopri5(1e-8), 1.0, 0);
    assert!(result.rows.is_empty() && result.statistics.steps > 0);
    assert!(result.statistics.evaluations > 6 * result.statistics.steps);
}

#[test]
fn a_force_that_loses_its_value_names_it_and_keeps_the_samples() {
    // The driver's law has no value after one second.
    let bar = Bar {
        law: Some(|t| if t < 1.0 { [t, 1.0, 0.0] } else { [f64::NAN; 3] }),
        ..Bar::unit(At::Ground(0.0, 0.0), 0.0, 0.0)
    };
    let system = pendulum(bar);
    for integrator in [dopri5(1e-8), Integrator::Rk4 { step: 0.01 }] {
        let result = run(&system, integrator, 2.0, 21);
        let Some(RunError::NonFinite { t, what }) = &result.stopped else { panic!("{:?}", result.stopped) };
        assert!((*t - 1.0).abs() < 0.02 && what == "drive of driver0", "{t} {what}");
        assert!((9..=11).contains(&result.rows.len()));
    }
}
