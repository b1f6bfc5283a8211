//! A whole step side by side with others, as if its end needed no projection, over any scalar. In: the begin of an arena. Out: the rest
//! of it. Never knows machine code.
//!
//! What the closure at the end and the derivative there have in common is computed once, and neither waits for the other.

use super::plan::{Evaluate, StepPlan};
use crate::scalar::Scalar;

impl StepPlan {
    /// The end of a step of the classical Runge-Kutta method, how regular loops are on its way, and whether that end has to be projected;
    /// behind it the answer of [`Self::conclude`]. In: parameters, where the step begins and what is known there.
    pub fn step<T: Scalar>(&self, evaluate: Evaluate<'_, T>, question: &[T]) -> Vec<T> {
        let attempt = self.attempt(evaluate, question);
        let conclusion = self.conclude(evaluate, &[question, &attempt].concat());
        [attempt, conclusion].concat()
    }
}
