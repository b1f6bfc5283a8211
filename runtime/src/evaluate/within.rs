//! All stages within a step at once, of one mechanism. In: where the step begins. Out: what they answer. Never knows code.

use super::Evaluator;
use super::stages::StagesAnswer;
use crate::system::StagesOf;

impl Evaluator<'_> {
    /// The stages within a step from a state whose derivative was the last answer, `pivots` the largest so far. Nothing where they have to
    /// be evaluated one by one. The answer to the state stays the last one.
    pub(crate) fn inner_stages(&mut self, step: &StagesOf<'_>, pivots: &[f64]) -> Option<StagesAnswer<'_>> {
        // Inputs change from stage to stage, and contacts that have changed are not those of the state.
        if !self.questions.inputs.is_empty() || self.clearances.has_changed() {
            return None;
        }
        self.derivative.inner_stages(self.questions.parameters(), &self.clearances, (step, pivots))
    }
}
