//! The classical Runge-Kutta method of order 4 with an error of order 3 from the slope at its end, which the next step
//! begins with. In: a problem, a step. Out: its end, its error, states within it.
//!
//! Of the methods of its cost it lets vibrations that nobody asks for be the fastest: they stay bounded up to 2.8 radians
//! a step, 0.7 an evaluation (Dormand-Prince: 0.17). That is what contacts need. Kutta 1901; the estimate: Hairer, Norsett,
//! Wanner, Solving Ordinary Differential Equations I, 2nd ed., II.4. Dense output: the cubic through values and slopes.

use super::adaptive::{MadeElsewhere, Method, Step};
use super::dense::Cubics;
use super::problem::{Problem, Stepped};
use super::step_control::SAFETY;
use crate::error::RunError;
use crate::runge_kutta::{advance, inner_stages};
use crate::scalar::Scalar;
use crate::system::{StageSum, StepOf};

const SUM: StageSum = StageSum::InTurn;

/// Weight of the difference of the last two slopes in the error: that of an embedded solution with a weight of 1/10 for
/// the slope at the end.
const WEIGHT: f64 = 0.1;

/// Error per second, by the slopes of the last stage and at the end.
#[inline(always)]
pub(crate) fn error_of<T: Scalar>(last: T, end: T) -> T {
    T::constant(WEIGHT) * (end - last)
}

/// See [`Method::growth`]. With weights of 1/32 and 7/32 in place of 0.04 and 0.22: roots take a third of the time of powers, which
/// are a tenth of that of a step.
#[inline(always)]
pub(crate) fn growth_of<T: Scalar>(last_error: T, error: T) -> T {
    let root = |x: T, times: usize| (0..times).fold(x, |x, _| x.sqrt());
    let eighth = root(error, 3);
    let sixteenth = eighth.sqrt();
    T::constant(SAFETY) * (root(last_error, 5) / (eighth * sixteenth * sixteenth.sqrt()))
}

/// Storage of the stages.
#[derive(Clone, Debug)]
pub struct Rk43 {
    /// At its begin and at its end.
    slopes: [Vec<f64>; 2],
    /// Of the stages within it.
    inner: [Vec<f64>; 3],
    cubics: Cubics,
}

impl MadeElsewhere for Rk43 {
    fn know(&mut self, [begin, end]: [&[f64]; 2]) {
        self.slopes[0].copy_from_slice(begin);
        self.slopes[1].copy_from_slice(end);
    }
}

impl Method for Rk43 {
    const ORDER: f64 = 4.0;
    /// With contacts most of the error is that of vibrations which die out and hardly wear. With three times the tolerance in
    /// every step the wear integral of a turn is off by 0.3 to 0.7 of the tolerance (RSSR at 10, 30 and 90 um, 1e-5).
    const SHARE: f64 = 3.0;

    fn new(dimension: usize) -> Self {
        let slope = || vec![0.0; dimension];
        Self {
            slopes: [slope(), slope()],
            inner: [slope(), slope(), slope()],
            cubics: Cubics::new(dimension),
        }
    }

    fn begin(&mut self, problem: &mut dyn Problem, t: f64, y: &[f64]) -> Result<(), RunError> {
        problem.derivative(t, y, &mut self.slopes[0])
    }

    fn slope(&self) -> &[f64] {
        &self.slopes[0]
    }

    fn attempt(
        &mut self,
        problem: &mut dyn Problem,
        step: Step<'_>,
        (next, error): (&mut [f64], &mut [f64]),
    ) -> Result<(), RunError> {
        let length = step.length;
        let ([a, end], [b, c, d]) = (&mut self.slopes, &mut self.inner);
        let times = [step.t + 0.5 * length, step.end];
        let of = StepOf { sum: SUM, times, length, y: step.y, slope: a };
        let stepped = problem.classical_step(&of, next, Some(d));
        if stepped == Stepped::OneByOne {
            let slopes = (&**a, [&mut **b, &mut **c, &mut **d]);
            inner_stages((times, length), step.y, next, slopes, &mut |t, y, slope| {
                problem.derivative(t, y, slope)
            })?;
            advance(SUM, next, step.y, length, [a, b, c, d]);
        }
        if stepped != Stepped::Whole {
            problem.project(step.end, step.y, next)?;
        }
        problem.derivative(step.end, next, end)?;
        for ((error, end), last) in error.iter_mut().zip(end).zip(d) {
            *error = error_of(*last, *end);
        }
        Ok(())
    }

    fn growth(last_error: f64, error: f64) -> f64 {
        growth_of(last_error, error)
    }

    fn accept(&mut self, step: Step<'_>, next: &[f64]) {
        self.cubics.set(step, next, [&self.slopes[0], &self.slopes[1]]);
        self.take_back();
    }

    fn take_back(&mut self) {
        self.slopes.swap(0, 1);
    }

    fn visit_memory(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        self.slopes.iter_mut().flatten().for_each(&mut *visit);
        self.cubics.visit_memory(visit);
    }

    fn interpolate<const N: usize>(&self, s: [f64; N], y: &mut [[f64; N]]) {
        self.cubics.at(s, y, |_| 0.0);
    }
}
