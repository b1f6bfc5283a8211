//! What an explicit method integrates.

use crate::error::RunError;

/// An initial value problem `y' = f(t, y)`, perhaps with constraints that a projection keeps.
pub trait Problem {
    /// Writes `f(t, y)`.
    ///
    /// # Errors
    /// If it has no value there; an adaptive method then tries a shorter step.
    fn derivative(&mut self, t: f64, y: &[f64], derivative: &mut [f64]) -> Result<(), RunError>;

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
    fn reached(&mut self, t: f64, derivative: &[f64]) {
        let _ = (t, derivative);
    }

    /// Size below which the error of component `index` is measured absolutely, not relative to the value.
    fn scale(&self, index: usize) -> f64 {
        let _ = index;
        1.0
    }

    /// Name of a component, for messages.
    fn name(&self, index: usize) -> String {
        format!("y{index}")
    }
}
