//! Steps as long as their errors allow, by any method that estimates them. In: a problem, a [`Method`].
//! Out: accepted steps, and states anywhere within the last one. Never knows how a step is made.
//!
//! The choice of the first step: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, 2nd ed., II.4 (code
//! DOPRI5). The error norm is the largest component, not the mean, so that idle ones hide nothing.

use super::problem::Problem;
use super::step_control::{self, StepControl, floored};
use crate::error::RunError;
use crate::linear::{combine, largest_of};
use crate::scalar::Scalar;

/// What is left of a step that failed, however large its error.
const AFTER_TROUBLE: f64 = 0.25;
/// What is left of a step that had better not end where it would: the next one, of its full length, has that in its middle.
const SHUNNING: f64 = 0.5;

/// Where a step begins.
#[derive(Clone, Copy)]
pub struct Step<'y> {
    /// Time [s].
    pub t: f64,
    /// State.
    pub y: &'y [f64],
    /// Its length [s].
    pub length: f64,
    /// Time at its end [s], to the last place.
    pub end: f64,
}

/// How a step is made.
pub trait Method {
    /// Order of the error estimate, plus one.
    const ORDER: f64;
    /// Part of the tolerance that the estimated error of a step may take.
    const SHARE: f64;

    /// Storage for states of `dimension` numbers.
    fn new(dimension: usize) -> Self;

    /// Evaluates the start.
    ///
    /// # Errors
    /// What the problem reports.
    fn begin(&mut self, problem: &mut dyn Problem, t: f64, y: &[f64]) -> Result<(), RunError>;

    /// Slope at the beginning of the next step.
    fn slope(&self) -> &[f64];

    /// Takes a step: writes its end, put onto the constraints, and an error per second (to be multiplied by the length).
    ///
    /// # Errors
    /// What the problem reports.
    fn attempt(
        &mut self,
        problem: &mut dyn Problem,
        step: Step<'_>,
        next_and_error: (&mut [f64], &mut [f64]),
    ) -> Result<(), RunError>;

    /// How much of the error of the last step tried may be rounding of its slopes, per second.
    fn noise(&mut self, problem: &mut dyn Problem, step: Step<'_>, next: &[f64]) -> f64 {
        let _ = (problem, step, next);
        0.0
    }

    /// By how much the next step may be longer: from the error of the step before and that of the last one.
    fn growth(last_error: f64, error: f64) -> f64 {
        step_control::growth(Self::ORDER, last_error, error)
    }

    /// The step that was tried last counts: the next one begins at its end.
    fn accept(&mut self, step: Step<'_>, next: &[f64]);

    /// The last accepted step is taken back: what belongs to its beginning counts again.
    fn take_back(&mut self);

    /// States at parts `s` of the last accepted step, side by side.
    fn interpolate<const N: usize>(&self, s: [f64; N], y: &mut [[f64; N]]);

    /// Steps that an implicit method took, where there is one besides.
    fn implicit_steps(&self) -> u64 {
        0
    }

    /// Shows every number that it stands on between two steps, in one order, to be read or put back.
    fn visit_memory(&mut self, visit: &mut dyn FnMut(&mut f64));
}

/// A method whose steps can be made elsewhere: it needs no more of them than the slopes at their ends.
pub(crate) trait MadeElsewhere: Method {
    /// Takes over the slopes at both ends of a step, which then counts.
    fn know(&mut self, slopes: [&[f64]; 2]);
}

/// Error of one number, 1 just accepted: from its values at both ends and its natural size, from the length of the step and the
/// error per second.
#[inline(always)]
pub(crate) fn relative_error<T: Scalar>(
    (y, next, scale): (T, T, T),
    (step, error): (T, T),
    tolerance: T,
) -> T {
    let size = y.abs().max(next.abs()).max(scale);
    (step * error / (tolerance * size)).abs()
}

/// What is known of the error of a step.
#[derive(Clone, Copy)]
struct Estimate {
    /// Largest error; 1 is just accepted.
    error: f64,
    /// The component it belongs to.
    worst: usize,
    /// The estimate shows rounding errors of the slopes: a shorter step would show the same, a longer one might hide more.
    noisy: bool,
}

/// State of an adaptive integration.
#[derive(Clone, Debug)]
pub struct Adaptive<M> {
    method: M,
    tolerance: f64,
    control: StepControl,
    y: Vec<f64>,
    next: Vec<f64>,
    error: Vec<f64>,
    scales: Vec<f64>,
    /// Why a longer step failed, and where: the reason to give if steps get too short before that.
    trouble: Option<(f64, RunError)>,
}

impl<M: Method> Adaptive<M> {
    /// Starts at (`t`, `y`), to go to `end`; `longest_step` limits every step. Chooses the first step.
    ///
    /// # Errors
    /// What the problem reports for the start.
    pub fn start(
        problem: &mut dyn Problem,
        (t, end): (f64, f64),
        y: &[f64],
        tolerance: f64,
        longest_step: f64,
    ) -> Result<Self, RunError> {
        let zero = || vec![0.0; y.len()];
        let mut adaptive = Self {
            method: M::new(y.len()),
            tolerance: M::SHARE * tolerance,
            control: StepControl::new((M::ORDER, M::growth), (t, end), longest_step),
            y: y.to_vec(),
            next: zero(),
            error: zero(),
            scales: zero(),
            trouble: None,
        };
        adaptive.method.begin(problem, t, &adaptive.y)?;
        problem.reached(t, &adaptive.y, adaptive.method.slope());
        let step = adaptive.first_step(problem);
        adaptive.control.set_step(step);
        Ok(adaptive)
    }

    /// Time reached.
    pub fn t(&self) -> f64 {
        self.control.t()
    }

    /// Time at the beginning of the last accepted step.
    pub fn before(&self) -> f64 {
        self.control.before()
    }

    /// State reached.
    pub fn y(&self) -> &[f64] {
        &self.y
    }

    /// Steps tried and not accepted.
    pub fn rejected(&self) -> u64 {
        self.control.rejected()
    }

    /// See [`Method::implicit_steps`].
    pub fn implicit_steps(&self) -> u64 {
        self.method.implicit_steps()
    }

    /// Goes one accepted step further, never beyond `end` and onto it exactly.
    ///
    /// # Errors
    /// [`RunError::StepTooSmall`], or what the problem reports however short the step.
    pub fn step(&mut self, problem: &mut dyn Problem, end: f64) -> Result<(), RunError> {
        // Length of the step that is to lead across what this one would have ended in.
        let mut across = None;
        loop {
            let (step, next_t) = self.control.propose(end);
            let outcome = self.attempt(problem, step, next_t);
            let is_smallest = self.control.is_smallest(step);
            match outcome {
                Ok(estimate)
                    if estimate.error <= 1.0 && across.is_none() && next_t < end && problem.shuns_end() =>
                {
                    across = Some(step);
                    self.control.shorten(step, SHUNNING);
                }
                Ok(estimate) if estimate.error <= 1.0 => {
                    self.accept(problem, (step, next_t), estimate);
                    if let Some(step) = across {
                        self.control.set_step(step);
                    }
                    return Ok(());
                }
                Ok(Estimate { error, worst, .. }) => {
                    if is_smallest {
                        let variable = problem.name(worst);
                        return Err(RunError::StepTooSmall { t: self.t(), step, variable });
                    }
                    self.control.reject(step, error);
                }
                Err(reason) => {
                    if is_smallest {
                        return Err(reason);
                    }
                    self.trouble = Some((next_t, reason));
                    self.control.shorten(step, AFTER_TROUBLE);
                }
            }
        }
    }

    /// Takes the last accepted step again, only up to `t` within it: something happens there that the steps
    /// before and after must not be mixed with. It ends earlier where its error asks for that: the longer step may have
    /// looked past what lies before `t`.
    ///
    /// # Errors
    /// As [`Self::step`].
    pub fn retake(&mut self, problem: &mut dyn Problem, t: f64) -> Result<(), RunError> {
        core::mem::swap(&mut self.y, &mut self.next);
        self.method.take_back();
        let longest = self.control.take_back();
        self.control.set_step(t - self.t());
        self.step(problem, t)?;
        self.control.limit(longest);
        Ok(())
    }

    /// Goes on from (`t`, `y`), which no step ended in: laws have changed there. Steps stay as long as they were.
    ///
    /// # Errors
    /// What the problem reports.
    pub fn go_on_from(&mut self, problem: &mut dyn Problem, t: f64, y: &[f64]) -> Result<(), RunError> {
        self.method.begin(problem, t, y)?;
        problem.reached(t, y, self.method.slope());
        self.y.copy_from_slice(y);
        self.control.go_on_from(t);
        self.trouble = None;
        Ok(())
    }

    /// Shows every number that it stands on between two steps, in one order, to be read or put back.
    pub fn visit_memory(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        self.y.iter_mut().chain(&mut self.next).for_each(&mut *visit);
        self.method.visit_memory(visit);
        self.control.visit_memory(visit);
    }

    /// Takes a step and estimates its error.
    fn attempt(&mut self, problem: &mut dyn Problem, length: f64, end: f64) -> Result<Estimate, RunError> {
        let step = Step { t: self.control.t(), y: &self.y, length, end };
        self.method.attempt(problem, step, (&mut self.next, &mut self.error))?;
        problem.write_scales(&mut self.scales);
        let mut estimate = self.estimate(length, 0.0);
        if estimate.is_ok_and(|estimate| estimate.error > 1.0) {
            let noise = self.method.noise(problem, step, &self.next);
            if noise > 0.0 {
                estimate = self.estimate(length, noise);
            }
        }
        estimate.map_err(|worst| RunError::NonFinite { t: end, what: problem.name(worst) })
    }

    /// Error of the last step tried, with `noise` in the estimate; the component, if one is not a number.
    fn estimate(&self, step: f64, noise: f64) -> Result<Estimate, usize> {
        let ends = self.y.iter().zip(&self.next).zip(self.scales.iter().zip(&self.error));
        let errors = ends.map(|((y, next), (scale, error))| {
            relative_error((*y, *next, *scale), (step, *error), self.tolerance)
        });
        // Most steps count, and nobody asks which component was nearest to forbid it.
        let error = largest_of(errors.clone());
        let mut most = Estimate { error: 0.0, worst: 0, noisy: false };
        if error <= 1.0 {
            return Ok(Estimate { error, ..most });
        }
        for (i, error) in errors.enumerate() {
            if error.is_nan() {
                return Err(i);
            }
            let noisy = error > 1.0 && self.error[i].abs() <= noise;
            let error = if noisy { 1.0 } else { error };
            if error > most.error {
                most = Estimate { error, worst: i, noisy };
            }
        }
        Ok(most)
    }

    fn accept(&mut self, problem: &mut dyn Problem, (length, end): (f64, f64), estimate: Estimate) {
        self.method.accept(Step { t: self.t(), y: &self.y, length, end }, &self.next);
        problem.reached(end, &self.next, self.method.slope());
        if self.trouble.as_ref().is_some_and(|(t, _)| end >= *t) {
            self.trouble = None;
        }
        core::mem::swap(&mut self.y, &mut self.next);
        self.control.accept((length, end), estimate.error, estimate.noisy);
    }

    /// The state at a time within the last accepted step.
    pub fn interpolate(&self, t: f64, y: &mut [f64]) {
        self.interpolate_several([t], y.as_chunks_mut().0);
    }

    /// The same at several times, side by side.
    pub(crate) fn interpolate_several<const N: usize>(&self, times: [f64; N], y: &mut [[f64; N]]) {
        self.method.interpolate(times.map(|t| (t - self.before()) / self.control.last_step()), y);
    }

    /// Part of the sizes that the error of a step may have.
    pub(crate) fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// Lengths of its steps, for who makes them elsewhere.
    pub(crate) fn control(&mut self) -> &mut StepControl {
        &mut self.control
    }

    /// The state that the last step began with, and room for the end of the next one.
    pub(crate) fn ends(&mut self) -> (&[f64], &mut [f64]) {
        (&self.y, &mut self.next)
    }

    /// Room for the state reached, where steps were made elsewhere.
    pub(crate) fn y_mut(&mut self) -> &mut [f64] {
        &mut self.y
    }

    /// A step that was made elsewhere counts, its end in the room for it. [`Self::slope`], [`Self::interpolate`] and
    /// [`Self::retake`] have to be told of its slopes first, by [`Self::know`].
    ///
    /// `growth`: [`Method::growth`] of the last error and this one.
    pub(crate) fn accept_end(&mut self, step: (f64, f64), error: f64, growth: f64) {
        core::mem::swap(&mut self.y, &mut self.next);
        self.pass(step, error, growth);
    }

    /// The same of a step whose end stays elsewhere: [`Self::y_mut`] is to be told of it before anything is asked for.
    pub(crate) fn pass(&mut self, step: (f64, f64), error: f64, growth: f64) {
        self.control.accept_grown(step, floored(error), growth);
    }

    /// Slope at the state reached.
    pub(crate) fn slope(&self) -> &[f64] {
        self.method.slope()
    }

    /// Hairer's choice: one explicit Euler step tells the second derivative.
    fn first_step(&mut self, problem: &mut dyn Problem) -> f64 {
        let weigh = |problem: &dyn Problem, values: &[f64], y: &[f64]| {
            let weighed = values.iter().zip(y).enumerate();
            weighed.fold(0.0_f64, |most, (i, (x, y))| most.max(x.abs() / y.abs().max(problem.scale(i))))
        };
        let first = self.method.slope();
        let slope = weigh(problem, first, &self.y);
        let size = weigh(problem, &self.y, &self.y);
        let trial = if slope < 1e-10 || size < 1e-10 { 1e-6 } else { 0.01 * size / slope };
        let trial = trial.min(self.control.longest_step());
        combine(&mut self.next, &self.y, trial, first);
        let mut bend = vec![0.0; self.y.len()];
        if problem.derivative(self.t() + trial, &self.next, &mut bend).is_err() {
            // Too far already: the step control finds its way from here.
            return 1e-3 * trial;
        }
        for (bend, before) in bend.iter_mut().zip(first) {
            *bend = (*bend - before) / trial;
        }
        let steepest = slope.max(weigh(problem, &bend, &self.y));
        let step = if steepest <= 1e-15 {
            (1e-3 * trial).max(1e-6)
        } else {
            libm::pow(0.01 * self.tolerance / steepest, 1.0 / M::ORDER)
        };
        step.min(100.0 * trial)
    }
}

#[allow(private_bounds, reason = "methods of this crate alone")]
impl<M: MadeElsewhere> Adaptive<M> {
    /// Takes over the slopes at both ends of the last step, which was made elsewhere.
    pub(crate) fn know(&mut self, slopes: [&[f64]; 2]) {
        let (t, end) = (self.before(), self.t());
        self.method.know(slopes);
        self.method.accept(Step { t, y: &self.next, length: self.control.last_step(), end }, &self.y);
    }
}
