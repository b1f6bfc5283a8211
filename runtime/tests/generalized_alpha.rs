//! The implicit method: order 2, loops closed, quaternions kept, and its failure.

mod common;

use common::bars::{At, Bar, Bars};
use common::body::Body;
use common::{Dense, Model};
use linkwear_runtime::{CLOSED, Integrator, Run, RunError, Settings, Span, Watch, simulate};
use nalgebra::Vector3;
use std::f64::consts::PI;

fn run<M: Model>(system: &Dense<M>, integrator: Integrator, time: f64, samples: usize) -> Run {
    let settings = Settings::new(integrator, Span::Time(time), samples);
    simulate(system, &system.description, &system.parameters(), &settings, Watch::NONE)
        .expect("the mechanism can start")
}

fn implicit(step: f64, rho: f64) -> Integrator {
    Integrator::GeneralizedAlpha { step, rho }
}

const EXACT: Integrator = Integrator::Dopri5 { tolerance: 1e-12, max_step: None };

/// Largest difference over all samples and channels.
fn difference(a: &Run, b: &Run) -> f64 {
    assert_eq!((&a.stopped, a.times.len()), (&None, b.times.len()));
    let pairs = a.rows.iter().flatten().zip(b.rows.iter().flatten());
    pairs.fold(0.0, |most, (a, b)| most.max((a - b).abs()))
}

fn order<M: Model>(system: &Dense<M>, rho: f64, step: f64) -> f64 {
    let exact = run(system, EXACT, 1.0, 11);
    let error = |step| difference(&run(system, implicit(step, rho), 1.0, 11), &exact);
    (error(step) / error(0.5 * step)).log2()
}

fn damped_four_bar() -> Dense<Bars> {
    let bar = |from, length, angle| Bar { length, ..Bar::unit(from, angle, 0.0) };
    let crank = Bar { damping: 0.2, speed: (8.0, true), ..bar(At::Ground(0.0, 0.0), 0.3, 0.3) };
    let bars = vec![crank, bar(At::End(0), 1.0, 0.7), bar(At::Ground(0.9, 0.0), 0.8, 1.4)];
    Dense::new(
        Bars { bars, loops: vec![(1, At::End(2))], redundant: Some(0.0), bearing: None },
        &[("gravity", 9.81)],
    )
}

fn pinned_body() -> Dense<Body> {
    let body = Body {
        mass: 2.0,
        inertia: [0.1, 0.2, 0.3],
        pin: Some((Vector3::new(0.0, 0.0, 0.5), Vector3::zeros())),
        start: [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, -0.5],
        speed: [1.0, 2.0, 4.0, 0.0, 0.0, 0.0],
        held: [false; 7],
    };
    Dense::new(body, &[("gravity", 9.81)])
}

#[test]
fn a_loop_with_damping_converges_with_order_two() {
    for rho in [0.0, 0.8, 0.95] {
        // Multipliers and accelerations among the channels; asymptotic up to a tenth.
        let order = order(&damped_four_bar(), rho, 4e-3);
        assert!((1.8..2.2).contains(&order), "rho {rho}: {order}");
    }
}

#[test]
fn a_body_on_a_pin_converges_with_order_two_on_its_group() {
    let order = order(&pinned_body(), 0.8, 4e-3);
    assert!((1.8..2.2).contains(&order), "{order}");
}

#[test]
fn loops_stay_closed_and_quaternions_unit() {
    let result = run(&damped_four_bar(), implicit(2e-3, 0.8), 2.0, 21);
    assert!(result.statistics.max_loop_error_m < CLOSED, "{:?}", result.statistics);
    let result = run(&pinned_body(), implicit(2e-3, 0.8), 2.0, 21);
    assert!(result.statistics.max_loop_error_m < CLOSED, "{:?}", result.statistics);
    for row in &result.rows {
        let length: f64 = row[..4].iter().map(|x| x * x).sum();
        // Normalised at every step: one rounding per component.
        assert!((length - 1.0).abs() < 1e-15);
    }
}

#[test]
fn a_step_takes_few_iterations_and_keeps_its_matrix() {
    let Run { statistics, .. } = run(&damped_four_bar(), implicit(2e-3, 0.8), 2.0, 21);
    let (steps, iterations) = (statistics.steps, statistics.newton_iterations);
    // Two corrections tell the rate; a third where a matrix has become old.
    assert!(2 * steps <= iterations && iterations < 3 * steps, "{statistics:?}");
    // One evaluation an iteration and one of the state reached, and less than one for new matrices.
    assert!(statistics.evaluations < iterations + 2 * steps, "{statistics:?}");
}

#[test]
fn equations_are_solved_far_beyond_the_error_of_the_step() {
    // What is left open goes by the step's error, and that by its cube: two steps of one motion differ by their errors alone.
    let exact = run(&damped_four_bar(), EXACT, 1.0, 11);
    let [coarse, fine] = [2e-3, 1e-3].map(|step| {
        let run = run(&damped_four_bar(), implicit(step, 0.8), 1.0, 11);
        (difference(&run, &exact), run.statistics.max_loop_error_m)
    });
    // A thousandth of the error of the columns, among them accelerations; and a hundredth of what counts as closed.
    for (error, open) in [coarse, fine] {
        assert!(open < 1e-3 * error && open < 1e-2 * CLOSED, "{error:e} {open:e}");
    }
}

#[test]
fn energy_balance_includes_drive_and_damping_to_second_order() {
    let law = |t: f64| [4.0 * PI * t, 4.0 * PI, 0.0];
    let bars = vec![
        Bar { law: Some(law), ..Bar::unit(At::Ground(0.0, 0.0), 0.0, 0.0) },
        Bar { damping: 0.5, ..Bar::unit(At::End(0), -1.0, 0.0) },
    ];
    let system = Dense::new(Bars { bars, ..Bars::default() }, &[("gravity", 9.81)]);
    let error = |step| {
        let statistics = run(&system, implicit(step, 0.9), 1.0, 2).statistics;
        assert!(
            statistics.newton_iterations >= statistics.steps && statistics.evaluations > statistics.steps
        );
        statistics.energy_error_J / statistics.energy_throughput_J
    };
    let (coarse, fine) = (error(2e-3), error(1e-3));
    // 4, asymptotic up to a tenth of an order.
    assert!((3.7..4.3).contains(&(coarse / fine)), "{coarse} {fine}");
}

#[test]
fn a_driver_past_the_dead_point_is_named_and_the_samples_kept() {
    let bar = |from, length, angle| Bar { length, ..Bar::unit(from, angle, 0.0) };
    let driven = Bar { law: Some(|t| [1.8 + t, 1.0, 0.0]), ..bar(At::Ground(0.9, 0.0), 0.8, 1.8) };
    let bars = vec![bar(At::Ground(0.0, 0.0), 0.3, 0.3), bar(At::End(0), 1.0, 0.7), driven];
    let system = Dense::new(
        Bars { bars, loops: vec![(1, At::End(2))], redundant: None, bearing: None },
        &[("gravity", 9.81)],
    );
    let result = run(&system, implicit(1e-3, 0.8), 3.0, 301);
    let Some(RunError::DeadPoint { t, joint, .. }) = result.stopped else { panic!("{:?}", result.stopped) };
    // Bars of 0.3 and 1 folded are 0.7 long: cos = (0.9² + 0.8² - 0.7²) / (2 · 0.9 · 0.8) = 2/3 at the ground.
    let dead = PI - (2.0_f64 / 3.0).acos() - 1.8;
    assert!((t - dead).abs() < 1e-6 && joint == "driver0", "{t} {dead} {joint}");
    assert!(result.rows.len() > 10);
}
