//! Steps as long as their errors allow, by any method that estimates them. In: a problem, a [`Method`].
//! Out: accepted steps, and states anywhere within the last one. Never knows how a step is made.
//!
//! PI control of the step and the choice of the first one: Hairer, Norsett, Wanner, Solving Ordinary Differential
//! Equations I, 2nd ed., II.4 (code DOPRI5). The error norm is the largest component, not the mean, so that idle ones hide
//! nothing.

use super::problem::Problem;
use crate::error::RunError;
use crate::linear::combine;

const SAFETY: f64 = 0.9;
const SHRINK_MOST: f64 = 0.2;
const GROW_MOST: f64 = 10.0;
/// Weight of the previous error in the step control.
const PI_WEIGHT: f64 = 0.04;
/// Steps below this part of the time (or of the whole span) are at the limit of rounding.
const SMALLEST_STEP: f64 = 16.0 * f64::EPSILON;

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

    /// The step that was tried last counts: the next one begins at its end.
    fn accept(&mut self, step: Step<'_>, next: &[f64]);

    /// The last accepted step is taken back: what belongs to its beginning counts again.
    fn take_back(&mut self);

    /// State at part `s` of the last accepted step.
    fn interpolate(&self, s: f64, y: &mut [f64]);
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
    longest_step: f64,
    span: f64,
    /// Beginning of the last accepted step.
    before: f64,
    t: f64,
    step: f64,
    last_step: f64,
    last_error: f64,
    y: Vec<f64>,
    next: Vec<f64>,
    error: Vec<f64>,
    rejected: u64,
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
            longest_step: longest_step.min(end - t),
            span: end - t,
            before: t,
            t,
            step: 0.0,
            last_step: 0.0,
            last_error: 1e-4,
            y: y.to_vec(),
            next: zero(),
            error: zero(),
            rejected: 0,
            trouble: None,
        };
        adaptive.method.begin(problem, t, &adaptive.y)?;
        problem.reached(t, adaptive.method.slope());
        adaptive.step = adaptive.first_step(problem);
        Ok(adaptive)
    }

    /// Time reached.
    pub fn t(&self) -> f64 {
        self.t
    }

    /// Time at the beginning of the last accepted step.
    pub fn before(&self) -> f64 {
        self.before
    }

    /// State reached.
    pub fn y(&self) -> &[f64] {
        &self.y
    }

    /// Steps tried and not accepted.
    pub fn rejected(&self) -> u64 {
        self.rejected
    }

    /// Goes one accepted step further, never beyond `end` and onto it exactly.
    ///
    /// # Errors
    /// [`RunError::StepTooSmall`], or what the problem reports however short the step.
    pub fn step(&mut self, problem: &mut dyn Problem, end: f64) -> Result<(), RunError> {
        let mut just_rejected = false;
        loop {
            let left = end - self.t;
            // A last crumb of a step would be all rounding: stretch this one.
            let last = 1.01 * self.step >= left;
            let step = if last { left } else { self.step };
            let next_t = if last { end } else { self.t + step };
            let outcome = self.attempt(problem, step, next_t);
            let smallest = SMALLEST_STEP * self.span.max(self.t.abs());
            match outcome {
                Ok(estimate) if estimate.error <= 1.0 => {
                    self.accept(problem, (step, next_t), estimate, just_rejected);
                    return Ok(());
                }
                Ok(Estimate { error, worst, .. }) => {
                    if step <= smallest {
                        return Err(RunError::StepTooSmall {
                            t: self.t,
                            step,
                            variable: problem.name(worst),
                        });
                    }
                    self.step = step * (SAFETY * libm::pow(error, -1.0 / M::ORDER)).max(SHRINK_MOST);
                }
                Err(reason) => {
                    if step <= smallest {
                        return Err(reason);
                    }
                    self.trouble = Some((next_t, reason));
                    self.step = 0.25 * step;
                }
            }
            just_rejected = true;
            self.rejected += 1;
        }
    }

    /// Takes the last accepted step again, only up to `t` within it: something happens there that the steps
    /// before and after must not be mixed with. Once per accepted step.
    ///
    /// # Errors
    /// What the problem reports.
    pub fn retake(&mut self, problem: &mut dyn Problem, t: f64) -> Result<(), RunError> {
        core::mem::swap(&mut self.y, &mut self.next);
        self.method.take_back();
        let (before, longer) = (self.before, self.step);
        self.t = before;
        // A part of a step that was accepted is accepted, whatever its own estimate says.
        let estimate = self.attempt(problem, t - before, t)?;
        self.accept(problem, (t - before, t), Estimate { error: estimate.error.min(1.0), ..estimate }, true);
        self.step = self.step.min(longer);
        Ok(())
    }

    /// Takes a step and estimates its error.
    fn attempt(&mut self, problem: &mut dyn Problem, length: f64, end: f64) -> Result<Estimate, RunError> {
        let step = Step { t: self.t, y: &self.y, length, end };
        self.method.attempt(problem, step, (&mut self.next, &mut self.error))?;
        let mut estimate = self.estimate(problem, length, 0.0);
        if estimate.is_ok_and(|estimate| estimate.error > 1.0) {
            let noise = self.method.noise(problem, step, &self.next);
            if noise > 0.0 {
                estimate = self.estimate(problem, length, noise);
            }
        }
        estimate.map_err(|worst| RunError::NonFinite { t: end, what: problem.name(worst) })
    }

    /// Error of the last step tried, with `noise` in the estimate; the component, if one is not a number.
    fn estimate(&self, problem: &dyn Problem, step: f64, noise: f64) -> Result<Estimate, usize> {
        let mut most = Estimate { error: 0.0, worst: 0, noisy: false };
        for i in 0..self.y.len() {
            let size = self.y[i].abs().max(self.next[i].abs()).max(problem.scale(i));
            let error = (step * self.error[i] / (self.tolerance * size)).abs();
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

    fn accept(
        &mut self,
        problem: &mut dyn Problem,
        (length, end): (f64, f64),
        estimate: Estimate,
        just_rejected: bool,
    ) {
        self.method.accept(Step { t: self.t, y: &self.y, length, end }, &self.next);
        problem.reached(end, self.method.slope());
        if self.trouble.as_ref().is_some_and(|(t, _)| end >= *t) {
            self.trouble = None;
        }
        core::mem::swap(&mut self.y, &mut self.next);
        (self.before, self.t, self.last_step) = (self.t, end, length);
        let error = estimate.error.max(1e-10);
        let growth = if estimate.noisy {
            1.0
        } else {
            SAFETY * libm::pow(self.last_error, PI_WEIGHT)
                / libm::pow(error, 1.0 / M::ORDER - 0.75 * PI_WEIGHT)
        };
        let most = if just_rejected { 1.0 } else { GROW_MOST };
        self.step = (length * growth.clamp(SHRINK_MOST, most)).min(self.longest_step);
        self.last_error = error.max(1e-4);
    }

    /// The state at a time within the last accepted step.
    pub fn interpolate(&self, t: f64, y: &mut [f64]) {
        self.method.interpolate((t - self.before) / self.last_step, y);
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
        let trial = trial.min(self.longest_step);
        combine(&mut self.next, &self.y, trial, first);
        let mut bend = vec![0.0; self.y.len()];
        if problem.derivative(self.t + trial, &self.next, &mut bend).is_err() {
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
        step.min(100.0 * trial).min(self.longest_step)
    }
}
