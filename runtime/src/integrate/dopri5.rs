//! Dormand-Prince 5(4): adaptive, first same as last, dense output of order 4.
//! In: a problem and a start. Out: accepted steps, and states anywhere within the last one.
//!
//! Tableau: Dormand & Prince, J. Comp. Appl. Math. 6 (1980) 19-26. Dense output, starting step and PI
//! control of the step: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, 2nd ed., II.4-II.6
//! (code DOPRI5). The error norm is the largest component, not the mean, so that idle ones hide nothing.
//!
//! A projection comes before the last stage: the slope carried over to the next step belongs to the
//! projected state, and nothing is evaluated twice.

use super::problem::Problem;
use crate::error::RunError;
use crate::linear::add_scaled;

const C: [f64; 7] = [0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0];
const A: [[f64; 6]; 7] = [
    [0.0; 6],
    [0.2, 0.0, 0.0, 0.0, 0.0, 0.0],
    [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0],
    [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0],
    [19_372.0 / 6_561.0, -25_360.0 / 2_187.0, 64_448.0 / 6_561.0, -212.0 / 729.0, 0.0, 0.0],
    [9_017.0 / 3_168.0, -355.0 / 33.0, 46_732.0 / 5_247.0, 49.0 / 176.0, -5_103.0 / 18_656.0, 0.0],
    [35.0 / 384.0, 0.0, 500.0 / 1_113.0, 125.0 / 192.0, -2_187.0 / 6_784.0, 11.0 / 84.0],
];
/// Difference of the solutions of order 5 and 4.
const E: [f64; 7] = [
    71.0 / 57_600.0,
    0.0,
    -71.0 / 16_695.0,
    71.0 / 1_920.0,
    -17_253.0 / 339_200.0,
    22.0 / 525.0,
    -1.0 / 40.0,
];
/// Weights of the fifth coefficient of the dense output.
const D: [f64; 7] = [
    -12_715_105_075.0 / 11_282_082_432.0,
    0.0,
    87_487_479_700.0 / 32_700_410_799.0,
    -10_690_763_975.0 / 1_880_347_072.0,
    701_980_252_875.0 / 199_316_789_632.0,
    -1_453_857_185.0 / 822_651_844.0,
    69_997_945.0 / 29_380_423.0,
];

const SAFETY: f64 = 0.9;
const SHRINK_MOST: f64 = 0.2;
const GROW_MOST: f64 = 10.0;
/// Weight of the previous error in the step control.
const PI_WEIGHT: f64 = 0.04;
/// Part of the tolerance that the estimated error of a step may take: errors of thousands of steps add
/// up, and with a tenth the error of smooth runs over ten seconds stays near ten times the tolerance.
const SHARE: f64 = 0.1;
/// Steps below this part of the time (or of the whole span) are at the limit of rounding.
const SMALLEST_STEP: f64 = 16.0 * f64::EPSILON;

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
pub struct Dopri5 {
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
    slopes: [Vec<f64>; 7],
    /// Slopes in which rounding may show.
    rough: [bool; 7],
    stage: Vec<f64>,
    error: Vec<f64>,
    dense: [Vec<f64>; 5],
    rejected: u64,
    /// Why a longer step failed, and where: the reason to give if steps get too short before that.
    trouble: Option<(f64, RunError)>,
}

impl Dopri5 {
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
        let mut method = Self {
            tolerance: SHARE * tolerance,
            longest_step: longest_step.min(end - t),
            span: end - t,
            before: t,
            t,
            step: 0.0,
            last_step: 0.0,
            last_error: 1e-4,
            y: y.to_vec(),
            next: zero(),
            slopes: std::array::from_fn(|_| zero()),
            rough: [false; 7],
            stage: zero(),
            error: zero(),
            dense: std::array::from_fn(|_| zero()),
            rejected: 0,
            trouble: None,
        };
        problem.derivative(t, &method.y, &mut method.slopes[0])?;
        method.rough[0] = problem.is_rough();
        problem.reached(t, &method.slopes[0]);
        method.step = method.first_step(problem);
        Ok(method)
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
                    problem.reached(next_t, &self.slopes[6]);
                    self.accept(step, next_t, estimate, just_rejected);
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
                    self.step = step * (SAFETY * libm::pow(error, -0.2)).max(SHRINK_MOST);
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
        self.slopes.swap(0, 6);
        self.rough.swap(0, 6);
        let (before, longer) = (self.before, self.step);
        self.t = before;
        // A part of a step that was accepted is accepted, whatever its own estimate says.
        let estimate = self.attempt(problem, t - before, t)?;
        problem.reached(t, &self.slopes[6]);
        self.accept(t - before, t, Estimate { error: estimate.error.min(1.0), ..estimate }, true);
        self.step = self.step.min(longer);
        Ok(())
    }

    /// Takes a step and estimates its error.
    fn attempt(&mut self, problem: &mut dyn Problem, step: f64, next_t: f64) -> Result<Estimate, RunError> {
        for stage in 1..7 {
            let (known, unknown) = self.slopes.split_at_mut(stage);
            weighted_sum(&mut self.next, &A[stage], known);
            for (next, y) in self.next.iter_mut().zip(&self.y) {
                *next = y + step * *next;
            }
            if stage == 6 {
                problem.project(next_t, &self.y, &mut self.next)?;
            }
            let t = if stage >= 5 { next_t } else { self.t + C[stage] * step };
            problem.derivative(t, &self.next, &mut unknown[0])?;
            self.rough[stage] = problem.is_rough();
        }
        weighted_sum(&mut self.error, &E, &self.slopes);
        let estimate = self.estimate(problem, step, 0.0);
        if let Ok(Estimate { error, .. }) = estimate
            && error > 1.0
            && self.rough.contains(&true)
        {
            let noise = self.noise(problem, step);
            return self.estimate(problem, step, noise).map_err(|worst| not_finite(problem, next_t, worst));
        }
        estimate.map_err(|worst| not_finite(problem, next_t, worst))
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

    /// How much of the error estimate of the last step tried may be rounding of its slopes.
    fn noise(&mut self, problem: &mut dyn Problem, step: f64) -> f64 {
        let mut noise = 0.0;
        for stage in (0..7).filter(|stage| self.rough[*stage]) {
            // The last stage is the projected end of the step.
            self.stage.copy_from_slice(&self.next);
            if stage < 6 {
                weighted_sum(&mut self.stage, &A[stage], &self.slopes[..stage]);
                for (stage, y) in self.stage.iter_mut().zip(&self.y) {
                    *stage = y + step * *stage;
                }
            }
            let t = self.t + C[stage] * step;
            noise += E[stage].abs() * problem.noise(t, &self.stage, &self.slopes[stage]);
        }
        noise
    }

    fn accept(&mut self, step: f64, next_t: f64, estimate: Estimate, just_rejected: bool) {
        for i in 0..self.y.len() {
            let difference = self.next[i] - self.y[i];
            let bend = step * self.slopes[0][i] - difference;
            self.dense[0][i] = self.y[i];
            self.dense[1][i] = difference;
            self.dense[2][i] = bend;
            self.dense[3][i] = difference - step * self.slopes[6][i] - bend;
        }
        weighted_sum(&mut self.dense[4], &D, &self.slopes);
        self.dense[4].iter_mut().for_each(|x| *x *= step);
        if self.trouble.as_ref().is_some_and(|(t, _)| next_t >= *t) {
            self.trouble = None;
        }
        core::mem::swap(&mut self.y, &mut self.next);
        self.slopes.swap(0, 6);
        self.rough.swap(0, 6);
        (self.before, self.t, self.last_step) = (self.t, next_t, step);
        let error = estimate.error.max(1e-10);
        let growth = if estimate.noisy {
            1.0
        } else {
            SAFETY * libm::pow(self.last_error, PI_WEIGHT) / libm::pow(error, 0.2 - 0.75 * PI_WEIGHT)
        };
        let most = if just_rejected { 1.0 } else { GROW_MOST };
        self.step = (step * growth.clamp(SHRINK_MOST, most)).min(self.longest_step);
        self.last_error = error.max(1e-4);
    }

    /// The state at a time within the last accepted step.
    pub fn interpolate(&self, t: f64, y: &mut [f64]) {
        let s = (t - self.before) / self.last_step;
        let r = 1.0 - s;
        for (i, value) in y.iter_mut().enumerate() {
            let [a, b, c, d, e] = [0, 1, 2, 3, 4].map(|k| self.dense[k][i]);
            *value = a + s * (b + r * (c + s * (d + r * e)));
        }
    }

    /// Hairer's choice: one explicit Euler step tells the second derivative.
    fn first_step(&mut self, problem: &mut dyn Problem) -> f64 {
        let weigh = |problem: &dyn Problem, values: &[f64], y: &[f64]| {
            let weighed = values.iter().zip(y).enumerate();
            weighed.fold(0.0_f64, |most, (i, (x, y))| most.max(x.abs() / y.abs().max(problem.scale(i))))
        };
        let slope = weigh(problem, &self.slopes[0], &self.y);
        let size = weigh(problem, &self.y, &self.y);
        let trial = if slope < 1e-10 || size < 1e-10 { 1e-6 } else { 0.01 * size / slope };
        let trial = trial.min(self.longest_step);
        for (next, (y, k)) in self.next.iter_mut().zip(self.y.iter().zip(&self.slopes[0])) {
            *next = y + trial * k;
        }
        if problem.derivative(self.t + trial, &self.next, &mut self.slopes[1]).is_err() {
            // Too far already: the step control finds its way from here.
            return 1e-3 * trial;
        }
        for (bend, (a, b)) in self.dense[0].iter_mut().zip(self.slopes[1].iter().zip(&self.slopes[0])) {
            *bend = (a - b) / trial;
        }
        let steepest = slope.max(weigh(problem, &self.dense[0], &self.y));
        let step = if steepest <= 1e-15 {
            (1e-3 * trial).max(1e-6)
        } else {
            libm::pow(0.01 * self.tolerance / steepest, 0.2)
        };
        step.min(100.0 * trial).min(self.longest_step)
    }
}

fn not_finite(problem: &dyn Problem, t: f64, worst: usize) -> RunError {
    RunError::NonFinite { t, what: problem.name(worst) }
}

/// `out = sum of weight * slope`, slope by slope: loops over long slices, which compilers vectorise.
fn weighted_sum(out: &mut [f64], weights: &[f64], slopes: &[Vec<f64>]) {
    out.fill(0.0);
    for (weight, slope) in weights.iter().zip(slopes) {
        if *weight != 0.0 {
            add_scaled(out, *weight, slope);
        }
    }
}
