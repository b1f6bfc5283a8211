//! The classical Runge-Kutta method of order 4, fixed step. In: a problem and a state. Out: the next one, on its constraints.

use super::problem::Problem;
use crate::error::RunError;
use crate::runge_kutta::rk4;

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
        let slopes = slopes.each_mut().map(Vec::as_mut_slice);
        rk4::<RunError>((t, step), y, stage, slopes, &mut |stage, t, y, slope| {
            problem.derivative(t, y, slope)?;
            if stage == 0 {
                problem.reached(t, y, slope);
            }
            Ok(())
        })?;
        problem.project(t + step, y, stage)?;
        y.copy_from_slice(stage);
        Ok(())
    }
}
