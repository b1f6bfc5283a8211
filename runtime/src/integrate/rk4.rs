//! The classical Runge-Kutta method of order 4, fixed step. In: a problem and a state. Out: the next one, on its constraints.

use super::problem::{Problem, Stepped};
use crate::error::RunError;
use crate::runge_kutta::{advance, inner_stages};
use crate::system::{StageSum, StepOf};

const SUM: StageSum = StageSum::EndsFirst;

/// Storage of the four stages.
#[derive(Clone, Debug)]
pub struct Rk4 {
    slopes: [Vec<f64>; 4],
    stage: Vec<f64>,
}

impl Rk4 {
    /// Storage for states of `dimension` numbers.
    pub fn new(dimension: usize) -> Self {
        Self { slopes: std::array::from_fn(|_| vec![0.0; dimension]), stage: vec![0.0; dimension] }
    }

    /// Advances `y` from `t` by `step` and projects it.
    ///
    /// # Errors
    /// What the problem reports; `y` is then unchanged.
    pub fn step(
        &mut self,
        problem: &mut dyn Problem,
        t: f64,
        y: &mut [f64],
        step: f64,
    ) -> Result<(), RunError> {
        let Self { slopes, stage } = self;
        let [k1, k2, k3, k4] = slopes.each_mut().map(Vec::as_mut_slice);
        problem.derivative(t, y, k1)?;
        problem.reached(t, y, k1);
        let times = [t + 0.5 * step, t + step];
        let of = StepOf { sum: SUM, times, length: step, y, slope: k1 };
        let stepped = problem.classical_step(&of, stage, None);
        if stepped == Stepped::OneByOne {
            let slopes = (&*k1, [&mut *k2, &mut *k3, &mut *k4]);
            inner_stages((times, step), y, stage, slopes, &mut |t, y, slope| {
                problem.derivative(t, y, slope)
            })?;
            advance(SUM, stage, y, step, [k1, k2, k3, k4]);
        }
        if stepped != Stepped::Whole {
            problem.project(t + step, y, stage)?;
        }
        y.copy_from_slice(stage);
        Ok(())
    }
}
