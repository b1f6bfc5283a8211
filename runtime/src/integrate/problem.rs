//! What an explicit method integrates.

use crate::error::RunError;
use crate::system::{STATES, StepOf};

/// What came of a step that was asked for in one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stepped {
    /// Nothing: its stages have to be evaluated one by one.
    OneByOne,
    /// The state at its end, which has to be projected.
    Raw,
    /// The state at its end on the constraints; the derivative there is known.
    Whole,
}

/// States beside one: each differs from it in one component, and the last one in the time alone.
pub struct Beside<'a> {
    /// The time of all but the last.
    pub t: f64,
    /// The one that they are beside.
    pub y: &'a [f64],
    /// What its first components are instead, one in each state.
    pub others: &'a [f64],
    /// The time of the last.
    pub later: f64,
}

impl Beside<'_> {
    /// Length of a row with a number for every state: as many are evaluated at once, up to whole groups.
    pub(crate) fn row(others: usize) -> usize {
        (others + 1).next_multiple_of(STATES)
    }

    /// Writes the derivatives row by row. `storage`: for a state and its derivative.
    pub(crate) fn one_by_one(
        &self,
        storage: &mut [f64],
        derivatives: &mut [f64],
        mut derivative: impl FnMut(f64, &[f64], &mut [f64]) -> Result<(), RunError>,
    ) -> Result<(), RunError> {
        let (state, slope) = storage.split_at_mut(self.y.len());
        let row = Self::row(self.others.len());
        let mut write = |column: usize, slope: &[f64]| {
            let rows = derivatives.chunks_exact_mut(row);
            rows.zip(slope).for_each(|(row, value)| row[column] = *value);
        };
        state.copy_from_slice(self.y);
        for (place, other) in self.others.iter().enumerate() {
            state[place] = *other;
            derivative(self.t, state, slope)?;
            state[place] = self.y[place];
            write(place, slope);
        }
        derivative(self.later, state, slope)?;
        write(self.others.len(), slope);
        Ok(())
    }
}

/// An initial value problem `y' = f(t, y)`, perhaps with constraints that a projection keeps.
pub trait Problem {
    /// Writes `f(t, y)`.
    ///
    /// # Errors
    /// If it has no value there; an adaptive method then tries a shorter step.
    fn derivative(&mut self, t: f64, y: &[f64], derivative: &mut [f64]) -> Result<(), RunError>;

    /// Writes `f` at states beside that of the last derivative: no part of the solution will come through them. Of every component a
    /// row, with a number for each state. `storage`: for a state and its derivative.
    ///
    /// # Errors
    /// As [`Self::derivative`].
    fn derivatives(
        &mut self,
        beside: &Beside<'_>,
        storage: &mut [f64],
        derivatives: &mut [f64],
    ) -> Result<(), RunError> {
        beside.one_by_one(storage, derivatives, |t, y, derivative| self.derivative(t, y, derivative))
    }

    /// Writes the end of a step of the classical Runge-Kutta method, and the slope at its last inner stage where that is asked for, if it
    /// can evaluate them at once.
    fn classical_step(
        &mut self,
        step: &StepOf<'_>,
        end: &mut [f64],
        last_slope: Option<&mut [f64]>,
    ) -> Stepped {
        let _ = (step, end, last_slope);
        Stepped::OneByOne
    }

    /// Puts the result `y` of a step from `before` onto the constraints.
    ///
    /// # Errors
    /// If that fails or moves it too far; an adaptive method then tries a shorter step.
    fn project(&mut self, t: f64, before: &[f64], y: &mut [f64]) -> Result<(), RunError> {
        let _ = (t, before, y);
        Ok(())
    }

    /// Whether rounding may show in the last derivative.
    fn is_rough(&self) -> bool {
        false
    }

    /// Rounding error of the derivative at (`t`, `y`), of its largest component: what is below means nothing.
    fn noise(&mut self, t: f64, y: &[f64], derivative: &[f64]) -> f64 {
        let _ = (t, y, derivative);
        0.0
    }

    /// Whether steps had better not end where the last derivative was taken: one of half the length, and then one across it, lose less.
    fn shuns_end(&self) -> bool {
        false
    }

    /// Told of every state that counts, with its derivative.
    fn reached(&mut self, t: f64, y: &[f64], derivative: &[f64]) {
        let _ = (t, y, derivative);
    }

    /// Size below which the error of component `index` is measured absolutely, not relative to the value.
    fn scale(&self, index: usize) -> f64 {
        let _ = index;
        1.0
    }

    /// Writes [`Self::scale`] of every component, in order: one call for all.
    fn write_scales(&self, scales: &mut [f64]) {
        scales.iter_mut().enumerate().for_each(|(index, scale)| *scale = self.scale(index));
    }

    /// How many of the `dimension` components the slopes depend on, those at the begin; the others are plain integrals.
    fn deciding(&self, dimension: usize) -> usize {
        dimension
    }

    /// The fastest vibration of all that may hold steps short [rad/s], 0 if there is none to speak of.
    fn fastest(&self) -> f64 {
        0.0
    }

    /// Lessens the errors of a step, by any measure, where they are of vibrations that it passes over and forgets: from one radian in
    /// `reach` [s] on, by as many.
    fn pass_over(&self, reach: f64, error: &mut [f64]) {
        let _ = (reach, error);
    }

    /// The component that is the slope of this one, if there is such.
    fn follows(&self, index: usize) -> Option<usize> {
        let _ = index;
        None
    }

    /// Name of a component, for messages.
    fn name(&self, index: usize) -> String {
        format!("y{index}")
    }
}
