//! Order of convergence and step control, on problems with closed forms.

use linkwear_runtime::RunError;
use linkwear_runtime::integrate::{Adaptive, Dopri5, Method, Problem, Rk4, Rk43, Rodas5P, Switching};

/// y1' = y2 cos t, y2' = -y1 cos t: y1 = sin(sin t), y2 = cos(sin t).
struct Swing;

impl Problem for Swing {
    fn derivative(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), RunError> {
        (dy[0], dy[1]) = (y[1] * t.cos(), -y[0] * t.cos());
        Ok(())
    }
}

fn exact(t: f64) -> [f64; 2] {
    [t.sin().sin(), t.sin().cos()]
}

fn error(t: f64, y: &[f64]) -> f64 {
    exact(t).iter().zip(y).fold(0.0, |most, (a, b)| most.max((a - b).abs()))
}

fn rk4_error(steps: u32) -> f64 {
    let step = 3.0 / f64::from(steps);
    let (mut method, mut y) = (Rk4::new(2), exact(0.0));
    for i in 0..steps {
        method.step(&mut Swing, f64::from(i) * step, &mut y, step).expect("smooth");
    }
    error(3.0, &y)
}

#[test]
fn rk4_has_order_four() {
    let order = (rk4_error(60) / rk4_error(120)).log2();
    // Asymptotic up to a tenth at these steps (errors 1e-6 and 7e-8, far from rounding).
    assert!((3.8..4.3).contains(&order), "{order}");
}

/// Fixed steps: a tolerance so loose that only the longest step counts.
fn fixed_errors<M: Method>(steps: u32) -> (f64, f64) {
    let longest = 3.0 / f64::from(steps);
    let mut method =
        Adaptive::<M>::start(&mut Swing, (0.0, 3.0), &exact(0.0), 1e3, longest).expect("smooth at the start");
    let (mut between, mut dense) = ([0.0; 2], 0.0_f64);
    while method.t() < 3.0 {
        method.step(&mut Swing, 3.0).expect("smooth");
        for part in [0.25, 0.5, 0.75] {
            let t = method.before() + part * (method.t() - method.before());
            method.interpolate(t, &mut between);
            dense = dense.max(error(t, &between));
        }
    }
    (error(3.0, method.y()), dense)
}

#[test]
fn dopri5_has_order_five_and_its_dense_output_order_four() {
    let ((coarse, coarse_dense), (fine, fine_dense)) =
        (fixed_errors::<Dopri5>(60), fixed_errors::<Dopri5>(120));
    let (order, dense_order) = ((coarse / fine).log2(), (coarse_dense / fine_dense).log2());
    // Asymptotic up to a few tenths; the dense output's local error is of order 5, and so is what
    // shows here, because the steps' own error is smaller.
    assert!((4.7..6.0).contains(&order), "{order}");
    assert!((3.8..6.0).contains(&dense_order), "{dense_order}");
}

#[test]
fn rk43_has_order_four_and_its_dense_output_order_three() {
    let ((coarse, coarse_dense), (fine, fine_dense)) = (fixed_errors::<Rk43>(60), fixed_errors::<Rk43>(120));
    let (order, dense_order) = ((coarse / fine).log2(), (coarse_dense / fine_dense).log2());
    // As above; the local error of the cubic is of order 4.
    assert!((3.8..4.3).contains(&order), "{order}");
    assert!((2.8..4.3).contains(&dense_order), "{dense_order}");
}

#[test]
fn rodas5p_has_order_five_and_its_dense_output_order_four() {
    let ((coarse, coarse_dense), (fine, fine_dense)) =
        (fixed_errors::<Rodas5P>(30), fixed_errors::<Rodas5P>(60));
    let (order, dense_order) = ((coarse / fine).log2(), (coarse_dense / fine_dense).log2());
    // As for Dormand-Prince.
    assert!((4.7..6.0).contains(&order), "{order}");
    assert!((3.8..6.0).contains(&dense_order), "{dense_order}");
}

/// y1' = -1e6 (y1 - y2) + cos t with y2 = sin t, a problem of Prothero and Robinson, and y3, the integral of y1.
struct Follows;

impl Problem for Follows {
    fn derivative(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), RunError> {
        (dy[0], dy[1], dy[2]) = (-1e6 * (y[0] - y[1]) + t.cos(), t.cos(), y[0]);
        Ok(())
    }

    fn deciding(&self, _: usize) -> usize {
        2
    }
}

#[test]
fn rodas5p_goes_with_the_slow_motion_however_stiff_the_fast_one_is() {
    let mut method =
        Adaptive::<Rodas5P>::start(&mut Follows, (0.0, 3.0), &[0.0; 3], 1e-7, 3.0).expect("smooth");
    let mut steps = 0;
    while method.t() < 3.0 {
        method.step(&mut Follows, 3.0).expect("smooth");
        steps += 1;
    }
    // An explicit method takes a million. Here the motion alone decides.
    assert!(steps < 60, "{steps}");
    let [fast, slow, integral] = [method.y()[0], method.y()[1], method.y()[2]];
    let sine = 3.0_f64.sin();
    let errors = [fast - sine, slow - sine, integral - (1.0 - 3.0_f64.cos())];
    // The tolerance.
    assert!(errors.iter().all(|error| error.abs() < 1e-7), "{errors:?}");
}

/// A slow motion behind a spring that rings a thousand times as fast, damped a little: y1' = cos t, and y2 follows y1.
struct Stiff;

const RINGING: f64 = 1e3;

impl Problem for Stiff {
    fn derivative(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), RunError> {
        (dy[0], dy[1]) = (t.cos(), y[2]);
        dy[2] = RINGING * RINGING * (y[0] - y[1]) + 0.02 * RINGING * (y[0] - y[2]);
        Ok(())
    }

    fn scale(&self, index: usize) -> f64 {
        [1.0, 1.0, RINGING][index]
    }
}

/// Evaluations, near enough, and the error of the slow motion.
fn stiff<M: Method>(stages: u64) -> (u64, f64) {
    let mut method = Adaptive::<M>::start(&mut Stiff, (0.0, 3.0), &[0.0; 3], 1e-5, 3.0).expect("smooth");
    let mut steps = 0;
    while method.t() < 3.0 {
        method.step(&mut Stiff, 3.0).expect("smooth");
        steps += 1;
    }
    ((steps + method.rejected()) * stages, (method.y()[0] - 3.0_f64.sin()).abs())
}

#[test]
fn rk43_bears_ringing_with_less_work() {
    let ((explicit, _), (bearing, error)) = (stiff::<Dopri5>(6), stiff::<Rk43>(4));
    // 0.7 radians an evaluation are 4,300 of them, 0.6 with refused steps; Dormand-Prince bears a third of that.
    assert!(bearing < 6_000 && 2 * bearing < explicit, "{bearing} {explicit}");
    // The tolerance.
    assert!(error < 1e-5, "{error}");
}

/// A mass on a spring whose other end moves slowly, damped a little.
struct Vibration {
    frequency: f64,
}

impl Problem for Vibration {
    fn derivative(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), RunError> {
        dy[0] = y[1];
        dy[1] = self.frequency * self.frequency * (t.sin() - y[0]) - 0.02 * self.frequency * y[1];
        Ok(())
    }

    fn fastest(&self) -> f64 {
        self.frequency
    }

    fn follows(&self, index: usize) -> Option<usize> {
        (index == 0).then_some(1)
    }
}

/// Steps in all and those by the implicit method, to t = 3.
fn switched(frequency: f64, tolerance: f64) -> (u64, u64) {
    let mut problem = Vibration { frequency };
    let mut method =
        Adaptive::<Switching<true>>::start(&mut problem, (0.0, 3.0), &[0.0, 1.0], tolerance, 3.0)
            .expect("smooth");
    let mut steps = 0;
    while method.t() < 3.0 {
        method.step(&mut problem, 3.0).expect("smooth");
        steps += 1;
    }
    (steps, method.implicit_steps())
}

#[test]
fn steps_are_implicit_where_a_fast_vibration_would_hold_explicit_ones_short() {
    let (steps, implicit) = switched(1e5, 1e-5);
    // Explicit ones would be 3e5. At first the mass rings, and is followed.
    assert!(steps < 600 && implicit > 50, "{implicit} of {steps}");
}

#[test]
fn steps_are_explicit_where_the_vibration_itself_is_followed() {
    let (steps, implicit) = switched(20.0, 1e-9);
    // The first ones try the implicit method.
    assert!(steps > 100 && implicit < 20, "{implicit} of {steps}");
}

#[test]
fn dopri5_error_follows_the_tolerance() {
    for tolerance in [1e-6, 1e-9, 1e-12] {
        let mut method =
            Adaptive::<Dopri5>::start(&mut Swing, (0.0, 3.0), &exact(0.0), tolerance, 3.0).expect("smooth");
        while method.t() < 3.0 {
            method.step(&mut Swing, 3.0).expect("smooth");
        }
        // Some tens of steps, each within a tenth of the tolerance, no growth of errors in this problem.
        assert!(error(3.0, method.y()) < 3.0 * tolerance);
        assert_eq!(method.t(), 3.0);
    }
}

/// The slope jumps by 1e9 at t = 0.5.
struct Jump;

impl Problem for Jump {
    fn derivative(&mut self, t: f64, _: &[f64], dy: &mut [f64]) -> Result<(), RunError> {
        dy[0] = if t < 0.5 { 0.0 } else { 1e9 };
        Ok(())
    }
}

#[test]
fn step_size_underflow_names_time_and_variable() {
    let mut method =
        Adaptive::<Dopri5>::start(&mut Jump, (0.0, 1.0), &[1.0], 1e-12, 1.0).expect("smooth at the start");
    let stopped = loop {
        if let Err(stopped) = method.step(&mut Jump, 1.0) {
            break stopped;
        }
    };
    let RunError::StepTooSmall { t, step, variable } = stopped else { panic!("{stopped}") };
    // Steps end within the shortest step of the jump.
    assert!((t - 0.5).abs() < 1e-14 && step < 1e-14, "{t} {step}");
    assert_eq!(variable, "y0");
}

/// Has no value beyond t = 0.5.
struct Cliff;

impl Problem for Cliff {
    fn derivative(&mut self, t: f64, _: &[f64], dy: &mut [f64]) -> Result<(), RunError> {
        dy[0] = 1.0;
        if t <= 0.5 { Ok(()) } else { Err(RunError::NonFinite { t, what: "cliff".to_owned() }) }
    }
}

#[test]
fn a_problem_without_value_ends_at_the_edge_with_its_own_reason() {
    let mut method =
        Adaptive::<Dopri5>::start(&mut Cliff, (0.0, 1.0), &[0.0], 1e-9, 1.0).expect("smooth at the start");
    let stopped = loop {
        if let Err(stopped) = method.step(&mut Cliff, 1.0) {
            break stopped;
        }
    };
    assert!(matches!(stopped, RunError::NonFinite { .. }));
    assert!((method.t() - 0.5).abs() < 1e-12);
    let mut y = [0.0];
    let failed = Rk4::new(1).step(&mut Cliff, 0.45, &mut y, 0.1).expect_err("the step ends at 0.55");
    assert!(matches!(failed, RunError::NonFinite { .. }));
    assert_eq!(y, [0.0]);
}

/// One that dies out a million times faster than the other moves, along its own slow way.
struct Damped;

impl Problem for Damped {
    fn derivative(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), RunError> {
        (dy[0], dy[1]) = (-1e6 * (y[0] - t.cos()) - t.sin(), -y[1]);
        Ok(())
    }
}

#[test]
fn what_dies_out_at_once_is_taken_over_by_the_implicit_method() {
    let mut run = Adaptive::<Switching<false>>::start(&mut Damped, (0.0, 3.0), &[0.0, 1.0], 1e-6, 3.0)
        .expect("a start");
    let mut steps = 0;
    while run.t() < 3.0 {
        run.step(&mut Damped, 3.0).expect("a step");
        steps += 1;
    }
    // Dormand-Prince alone takes a million.
    assert!(steps < 400 && run.implicit_steps() > 0, "{steps}, {} implicit", run.implicit_steps());
    for (found, expected) in run.y().iter().zip([3.0_f64.cos(), (-3.0_f64).exp()]) {
        // The tolerance, of a few hundred steps.
        assert!((found - expected).abs() < 1e-5, "{found} {expected}");
    }
}
