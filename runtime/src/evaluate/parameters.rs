//! Numbers that are given from outside: parameters, inputs, and where inputs go that drives follow. In: values, signals. Out: answers that
//! go by them from here on.

use super::Evaluator;
use crate::description::Description;
use crate::error::SetupError;
use crate::guide::Guide;
use crate::signals::Signals;

impl<'a> Evaluator<'a> {
    /// Whether values are as many as a mechanism has parameters, and finite.
    pub(super) fn check_parameters(description: &Description, parameters: &[f64]) -> Result<(), SetupError> {
        let (expected, found) = (description.parameters.len(), parameters.len());
        if expected != found {
            return Err(SetupError::Length { what: "parameters", expected, found });
        }
        match parameters.iter().position(|value| !value.is_finite()) {
            Some(at) => {
                let name = description.parameters[at].name.to_string();
                Err(SetupError::Parameter { name, value: parameters[at] })
            }
            None => Ok(()),
        }
    }

    /// Evaluates with other values of the parameters from here on.
    ///
    /// # Errors
    /// If they are not finite, or not as many as the mechanism has; nothing has changed then.
    pub fn set_parameters(&mut self, parameters: &[f64]) -> Result<(), SetupError> {
        Self::check_parameters(self.description, parameters)?;
        self.questions.set_parameters(parameters);
        self.derivative.set_parameters(parameters);
        self.forget_contacts();
        Ok(())
    }

    /// Values of the parameters.
    pub(crate) fn parameters(&self) -> &[f64] {
        self.questions.parameters()
    }

    /// Connects the inputs to signals; before that they have the values among the parameters.
    pub fn connect(&mut self, signals: &'a dyn Signals) {
        self.questions.connect(signals);
        self.derivative.forget();
    }

    /// Where the inputs that drives follow go: to be led on, from their [`Self::inputs`].
    pub(crate) fn guide(&self) -> &Guide {
        &self.questions.guide
    }

    /// Leads the inputs that drives follow from here on.
    pub(crate) fn set_guide(&mut self, guide: &Guide) {
        self.questions.guide.clone_from(guide);
        self.derivative.forget();
        self.forget_contacts();
    }

    /// The inputs among values of all parameters.
    ///
    /// # Errors
    /// As [`Self::set_parameters`].
    pub(crate) fn inputs_among<'p>(&self, parameters: &'p [f64]) -> Result<&'p [f64], SetupError> {
        Self::check_parameters(self.description, parameters)?;
        Ok(&parameters[self.questions.inputs.clone()])
    }

    /// Where inputs begin among the parameters.
    pub(crate) fn first_input(&self) -> usize {
        self.questions.inputs.start
    }

    /// Values of all inputs at a time.
    pub(crate) fn inputs(&mut self, t: f64) -> &[f64] {
        self.questions.inputs_at(t)
    }

    /// Passes all numbers of the guide, to be read or written: before an answer is asked for again.
    pub(crate) fn visit_guide(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        self.questions.guide.visit_memory(visit);
    }

    /// What the inputs are connected to.
    pub(crate) fn signals(&self) -> Option<&'a dyn Signals> {
        self.questions.signals()
    }
}
