//! Closed loops: drift, driven four-bars, singular positions, lost assembly.

mod common;

use common::Dense;
use common::bars::{At, Bar, Bars, Law};
use linkwear_runtime::{CLOSED, Integrator, Run, RunError, Settings, Span, Watch, simulate};
use std::f64::consts::{FRAC_PI_2, PI};

const GRAVITY: f64 = 9.81;

fn dopri5(tolerance: f64) -> Integrator {
    Integrator::Dopri5 { tolerance, max_step: None }
}

fn dense(bars: Bars) -> Dense<Bars> {
    Dense::new(bars, &[("gravity", GRAVITY)])
}

fn run(system: &Dense<Bars>, integrator: Integrator, time: f64, samples: usize) -> Run {
    let settings = Settings::new(integrator, Span::Time(time), samples);
    let run = simulate(system, &system.description, &system.parameters(), &settings, Watch::NONE);
    run.expect("the mechanism can start")
}

/// Crank 0.3, coupler 1.0, rocker 0.8, ground 0.9: Grashof, so the crank turns fully.
fn four_bar(law: Option<Law>) -> Dense<Bars> {
    let bar = |from, length, angle| Bar { length, ..Bar::unit(from, angle, 0.0) };
    let crank = Bar { law, start: (0.3, false), speed: (8.0, false), ..bar(At::Ground(0.0, 0.0), 0.3, 0.3) };
    let bars = vec![crank, bar(At::End(0), 1.0, 0.7), bar(At::Ground(0.9, 0.0), 0.8, 1.4)];
    dense(Bars { bars, loops: vec![(1, At::End(2))], redundant: Some(0.0), bearing: None })
}

/// Rocker angle of the four-bar in closed form (the assembly with the loop above ground).
fn rocker(crank: f64) -> f64 {
    let (x, y) = (0.3 * crank.cos() - 0.9, 0.3 * crank.sin());
    let reach = x.hypot(y);
    let inner = (reach * reach + 0.64 - 1.0) / (2.0 * 0.8 * reach);
    y.atan2(x) - inner.acos()
}

#[test]
fn a_driven_four_bar_follows_its_closed_form() {
    let system = four_bar(Some(|t| [4.0 * PI * t, 4.0 * PI, 0.0]));
    for integrator in [dopri5(1e-10), Integrator::Rk4 { step: 1e-3 }] {
        let result = run(&system, integrator, 1.0, 101);
        for (t, row) in result.times.iter().zip(&result.rows) {
            let wanted = rocker(4.0 * PI * t).rem_euclid(2.0 * PI);
            // Closed loops leave no freedom: only the projection's 1e-12 and the loop's amplification.
            assert!((row[8].rem_euclid(2.0 * PI) - wanted).abs() < 1e-10, "{t}");
        }
        let statistics = result.statistics;
        assert!(statistics.max_loop_error_m <= CLOSED && statistics.projections > 0, "{statistics:?}");
        assert_eq!(result.stopped, None);
    }
}

#[test]
fn a_free_four_bar_keeps_energy_and_its_loop() {
    let result = run(&four_bar(None), dopri5(1e-10), 10.0, 101);
    let statistics = result.statistics;
    // The promise for tolerance 1e-10 over 10 s.
    assert!(statistics.energy_error_J < 1e-8 * statistics.energy_throughput_J, "{statistics:?}");
    assert!(statistics.max_loop_error_m < CLOSED);
    assert_eq!(statistics.rank_revealing_solves, 0);
}

#[test]
fn a_pendulum_hung_in_a_loop_moves_like_the_pendulum_alone() {
    // Two parallel cranks and a coupler: the coupler translates, so theta'' follows from 2/3 + 1 bars.
    let parallel = |angle: f64| {
        let bars = vec![
            Bar::unit(At::Ground(0.0, 0.0), angle, 0.0),
            Bar::unit(At::End(0), 0.0, 0.0),
            Bar::unit(At::Ground(1.0, 0.0), angle, 0.0),
        ];
        dense(Bars { bars, loops: vec![(1, At::End(2))], redundant: None, bearing: None })
    };
    let result = run(&parallel(-0.5), dopri5(1e-12), 2.0, 21);
    let expected = parallel_reference(1.0, -0.5, 0.0, &result.times);
    for (row, (angle, speed)) in result.rows.iter().zip(expected) {
        // Tolerance 1e-12, a few hundred steps.
        assert!((row[0] - angle).abs() < 3e-11 && (row[1] - speed).abs() < 3e-10);
    }
}

/// Regular branch of the N four-bar: ((n + 1)/3 + n) theta'' = -((n + 1)/2 + n) g cos theta, theta from +x,
/// by Runge-Kutta with steps of 1e-5 s (error far below 1e-12).
fn parallel_reference(n: f64, angle: f64, speed: f64, times: &[f64]) -> Vec<(f64, f64)> {
    let ratio = ((n + 1.0) / 2.0 + n) / ((n + 1.0) / 3.0 + n) * GRAVITY;
    let slope = |(q, v): (f64, f64)| (v, -ratio * q.cos());
    let step = |(q, v): (f64, f64), h: f64| {
        let at = |k: (f64, f64), h: f64| (q + h * k.0, v + h * k.1);
        let a = slope((q, v));
        let b = slope(at(a, 0.5 * h));
        let c = slope(at(b, 0.5 * h));
        let d = slope(at(c, h));
        (q + h / 6.0 * (a.0 + 2.0 * (b.0 + c.0) + d.0), v + h / 6.0 * (a.1 + 2.0 * (b.1 + c.1) + d.1))
    };
    let (mut t, mut state) = (0.0, (angle, speed));
    times
        .iter()
        .map(|time| {
            let steps = ((time - t) / 1e-4).ceil();
            for _ in 0..steps as u32 {
                state = step(state, (time - t) / steps);
            }
            t = *time;
            state
        })
        .collect()
}

/// N windows of unit bars, upright, turning towards +x with unit speed: IFToMM benchmark A02.
fn n_four_bar(n: usize) -> Dense<Bars> {
    let mut bars = vec![Bar::unit(At::Ground(0.0, 0.0), FRAC_PI_2, -1.0)];
    let mut loops = Vec::new();
    for i in 0..n {
        bars.push(Bar::unit(At::End(i), 0.0, 0.0));
    }
    for i in 1..=n {
        bars.push(Bar::unit(At::Ground(i as f64, 0.0), FRAC_PI_2, -1.0));
        loops.push((i, At::End(n + i)));
    }
    dense(Bars { bars, loops, redundant: None, bearing: None })
}

#[test]
fn the_n_four_bar_stays_on_its_regular_branch_through_singular_positions() {
    // x, y, vx, vy of B0: exact solution of the regular branch by 30-digit integration (IFToMM A02, N = 2).
    let wanted = [
        (1.0, [-0.195_020_301_949_44, -0.980_799_205_662_17, -6.676_678_036_88, 1.327_578_325_15]),
        (5.0, [-0.811_310_461_005_11, -0.584_615_545_348_98, -3.569_117_397_19, 4.953_105_171_31]),
        (10.0, [0.328_458_111_540_82, 0.944_518_538_178_6, 1.423_051_470_21, -0.494_868_845_487]),
    ];
    let result = run(&n_four_bar(2), dopri5(1e-10), 10.0, 11);
    assert_eq!(result.stopped, None);
    for (t, [x, y, vx, vy]) in wanted {
        let row = &result.rows[t as usize];
        let (angle, speed) = (row[0], row[1]);
        let found = [row[2], row[3], -angle.sin() * speed, angle.cos() * speed];
        for (a, b) in found.iter().zip([x, y, vx, vy]) {
            // The benchmark asks for 1e-5.
            assert!((a - b).abs() < 1e-5, "{t}: {found:?}");
        }
    }
    let statistics = result.statistics;
    assert!(statistics.max_loop_error_m < CLOSED, "{statistics:?}");
    assert!(statistics.energy_error_J < 1e-7 * statistics.energy_throughput_J, "{statistics:?}");
}

#[test]
fn a_start_exactly_in_line_uses_the_rank_revealing_solve() {
    let bars = vec![
        Bar::unit(At::Ground(0.0, 0.0), 0.0, -2.0),
        Bar::unit(At::End(0), 0.0, 0.0),
        Bar::unit(At::Ground(1.0, 0.0), 0.0, -2.0),
    ];
    let system = dense(Bars { bars, loops: vec![(1, At::End(2))], redundant: None, bearing: None });
    let result = run(&system, dopri5(1e-9), 0.3, 4);
    assert_eq!(result.stopped, None);
    assert!(result.statistics.rank_revealing_solves > 0);
    let expected = parallel_reference(1.0, 0.0, -2.0, &result.times);
    for (row, (angle, _)) in result.rows.iter().zip(expected) {
        // In line the masses decide in the lost direction, which for one window is symmetric and right.
        assert!((row[0] - angle).abs() < 1e-6, "{} {angle}", row[0]);
    }
}

#[test]
fn a_driver_past_the_dead_point_is_named() {
    // The rocker is driven: it can swing only so far.
    let bar = |from, length, angle| Bar { length, ..Bar::unit(from, angle, 0.0) };
    let driven = Bar { law: Some(|t| [1.8 + t, 1.0, 0.0]), ..bar(At::Ground(0.9, 0.0), 0.8, 1.8) };
    let bars = vec![bar(At::Ground(0.0, 0.0), 0.3, 0.3), bar(At::End(0), 1.0, 0.7), driven];
    let system = dense(Bars { bars, loops: vec![(1, At::End(2))], redundant: None, bearing: None });
    for integrator in [dopri5(1e-8), Integrator::Rk4 { step: 1e-3 }] {
        let result = run(&system, integrator, 3.0, 301);
        let Some(RunError::DeadPoint { t, joint, position, .. }) = result.stopped else {
            panic!("{:?}", result.stopped)
        };
        // Crank folded back onto the coupler: the rocker's end at distance 0.7 from the origin.
        let limit = (0.9_f64.powi(2) + 0.64 - 0.7_f64.powi(2)) / (2.0 * 0.9 * 0.8);
        let dead = (PI - limit.acos()) - 1.8;
        // Loops count as closed up to 1e-8 beyond it.
        assert!((t - dead).abs() < 1e-6 && joint == "driver0", "{t} {dead} {joint}");
        assert!((position - (1.8 + t)).abs() < 1e-12 && result.rows.len() > 10);
    }
}

#[test]
fn a_step_too_long_for_its_loop_is_a_branch_change() {
    // More than two radians per step: closing the loop moves it by more than a tenth of the step.
    let system = four_bar(Some(|t| [4.0 * PI * t, 4.0 * PI, 0.0]));
    let result = run(&system, Integrator::Rk4 { step: 0.2 }, 1.0, 2);
    let Some(RunError::BranchChange { t, jump, .. }) = result.stopped else { panic!("{:?}", result.stopped) };
    assert!(t <= 1.0 && jump > 0.01, "{t} {jump}");
}

#[test]
fn a_driver_that_jumps_loses_the_assembly() {
    // The driven rocker leaps out of its range at half a second.
    let bar = |from, length, angle| Bar { length, ..Bar::unit(from, angle, 0.0) };
    let law: Law = |t| if t < 0.5 { [1.8, 0.0, 0.0] } else { [3.1, 0.0, 0.0] };
    let driven = Bar { law: Some(law), ..bar(At::Ground(0.9, 0.0), 0.8, 1.8) };
    let bars = vec![bar(At::Ground(0.0, 0.0), 0.3, 0.3), bar(At::End(0), 1.0, 0.7), driven];
    let system = dense(Bars { bars, loops: vec![(1, At::End(2))], redundant: None, bearing: None });
    for integrator in [dopri5(1e-8), Integrator::Rk4 { step: 1e-2 }] {
        let result = run(&system, integrator, 1.0, 11);
        let Some(RunError::LostAssembly { t, joint, residual_m, .. }) = result.stopped else {
            panic!("{:?}", result.stopped)
        };
        assert!((t - 0.5).abs() < 2e-2 && joint == "loop0" && residual_m > CLOSED, "{t} {residual_m}");
        assert!(result.rows.len() >= 5);
    }
}
