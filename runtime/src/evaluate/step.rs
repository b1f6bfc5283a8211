//! A step of one mechanism by one call. In: where the step begins. Out: its end, which becomes the state of the last answer where a
//! run goes on from it. Never knows code.

use super::Evaluator;
use super::step_code::{StepAnswer, StepLimits};
use crate::system::StepOf;

impl Evaluator<'_> {
    /// Evaluates a step from a state whose derivative was the last answer. Whether it could: if not, stages have to be evaluated one by
    /// one. If it did, there is no last answer until [`Self::go_to_end`] or another question.
    pub(crate) fn classical_step(&mut self, step: &StepOf<'_>, limits: StepLimits<'_>) -> bool {
        // Inputs change from stage to stage, and contacts that have changed are not those of the state.
        if !self.questions.inputs.is_empty() || self.clearances.has_changed() {
            return false;
        }
        self.derivative.classical_step(self.questions.parameters(), &self.clearances, (step, limits))
    }

    /// What the last step answered; nothing without code for steps.
    pub(crate) fn last_step(&self) -> Option<StepAnswer<'_>> {
        self.derivative.last_step()
    }

    /// Kinetic and potential energy where contacts were evaluated last [J], if a step ends there.
    pub(crate) fn energy_of_step(&self) -> Option<(f64, f64)> {
        self.derivative.energy().map(|[kinetic, potential]| (kinetic, potential))
    }

    /// The end of the last step, at time `t`, becomes the state of the last answer: derivative, contacts, energies and Jacobian are known
    /// there.
    pub(crate) fn go_to_end(&mut self, t: f64) {
        self.forget_dropped();
        self.contacts_known_at = None;
        if let Some(step) = self.derivative.last_step() {
            self.rows.note_squares(step.row_squares().iter().copied());
        }
        self.derivative.go_to_end(&mut self.clearances, t);
    }
}
