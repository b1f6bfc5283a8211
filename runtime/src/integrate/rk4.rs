//! The classical Runge-Kutta method of order 4, fixed step (Kutta 1901; Hairer, Norsett, Wanner, Solving
//! Ordinary Differential Equations I, 2nd ed., table II.1.2). In: a problem and a state. Out: the next one.

use super::problem::Problem;
use crate::error::RunError;
use crate::linear::combine;

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
        let Self { slopes: [k1, k2, k3, k4], stage } = self;
        problem.derivative(t, y, k1)?;
        problem.reached(t, k1);
        combine(stage, y, 0.5 * step, k1);
        problem.derivative(t + 0.5 * step, stage, k2)?;
        combine(stage, y, 0.5 * step, k2);
        problem.derivative(t + 0.5 * step, stage, k3)?;
        combine(stage, y, step, k3);
        problem.derivative(t + step, stage, k4)?;
        advance(stage, y, step / 6.0, [k1, k2, k3, k4]);
        problem.project(t + step, y, stage)?;
        y.copy_from_slice(stage);
        Ok(())
    }
}

/// As [`combine`], with the four slopes of a step.
fn advance(next: &mut [f64], y: &[f64], sixth: f64, slopes: [&[f64]; 4]) {
    let n = next.len();
    let (y, [a, b, c, d]) = (&y[..n], slopes.map(|slope| &slope[..n]));
    for i in 0..n {
        next[i] = y[i] + sixth * ((a[i] + d[i]) + 2.0 * (b[i] + c[i]));
    }
}
