//! Model exchange: the tool integrates, the unit answers for states that it is given.

use linkwear_runtime::StateSpace;

use super::motion::Motion;
use super::{Instance, Interface, Mode};
use crate::fault::{Fault, fault};

impl Instance {
    fn space(&mut self, call: &str) -> Result<&mut StateSpace<'static>, Fault> {
        match self.motion()? {
            Motion::Space(space) => Ok(space),
            Motion::Steps(_) => fault(format!("{call} belongs to model exchange")),
        }
    }

    /// Sets the time of model exchange.
    ///
    /// # Errors
    /// In another mode, or if it is no number.
    pub fn set_time(&mut self, t: f64) -> Result<(), Fault> {
        self.is(&[Mode::ContinuousTime], "fmi3SetTime")?;
        if !t.is_finite() {
            return fault("the time must be finite");
        }
        self.space("fmi3SetTime")?.set_time(t);
        Ok(())
    }

    /// Sets the states of model exchange.
    ///
    /// # Errors
    /// In another mode, or if their number is another or one is none.
    pub fn set_states(&mut self, states: &[f64]) -> Result<(), Fault> {
        self.is(&[Mode::ContinuousTime], "fmi3SetContinuousStates")?;
        if let Some(wrong) = states.iter().find(|state| !state.is_finite()) {
            return fault(format!("a continuous state is {wrong}"));
        }
        Ok(self.space("fmi3SetContinuousStates")?.set_states(states)?)
    }

    /// States of model exchange.
    ///
    /// # Errors
    /// If there are none yet, or others asked for.
    pub fn states(&mut self, states: &mut [f64]) -> Result<(), Fault> {
        copy(self.space("fmi3GetContinuousStates")?.states(), states)
    }

    /// Natural sizes of the states.
    ///
    /// # Errors
    /// As [`Self::states`].
    pub fn nominals(&mut self, sizes: &mut [f64]) -> Result<(), Fault> {
        copy(self.space("fmi3GetNominalsOfContinuousStates")?.sizes(), sizes)
    }

    /// Derivatives of the states.
    ///
    /// # Errors
    /// If they have no value, or their number is another.
    pub fn derivatives(&mut self, derivatives: &mut [f64]) -> Result<(), Fault> {
        copy(self.space("fmi3GetContinuousStateDerivatives")?.derivatives()?, derivatives)
    }

    /// Penetrations of contacts [m].
    ///
    /// # Errors
    /// If their number is another.
    pub fn indicators(&mut self, indicators: &mut [f64]) -> Result<(), Fault> {
        let found: Vec<f64> = self.space("fmi3GetEventIndicators")?.penetrations().collect();
        copy(&found, indicators)
    }

    /// Number of states.
    pub fn state_count(&self) -> usize {
        self.variables.states()
    }

    /// Number of event indicators.
    pub fn indicator_count(&self) -> usize {
        self.variables.indicators()
    }

    /// A step of the tool's integrator is done. Whether event mode should be entered: loops have opened.
    ///
    /// # Errors
    /// In another mode, or if the step was too long to be followed.
    pub fn completed_step(&mut self) -> Result<bool, Fault> {
        self.is(&[Mode::ContinuousTime], "fmi3CompletedIntegratorStep")?;
        Ok(self.space("fmi3CompletedIntegratorStep")?.complete_step()?)
    }

    /// Handles events: contacts that closed, loops that opened, parameters that changed. Whether states have moved.
    ///
    /// # Errors
    /// In another mode, or if loops cannot be closed.
    pub fn update_discrete(&mut self) -> Result<bool, Fault> {
        self.is(&[Mode::Event], "fmi3UpdateDiscreteStates")?;
        if self.interface != Interface::ModelExchange {
            self.motion()?;
            return Ok(false);
        }
        let before = match &self.motion {
            Some(Motion::Space(space)) => space.states().to_vec(),
            _ => Vec::new(),
        };
        let space = self.space("fmi3UpdateDiscreteStates")?;
        space.close_contacts();
        space.put_on()?;
        Ok(space.states() != before)
    }
}

fn copy(from: &[f64], to: &mut [f64]) -> Result<(), Fault> {
    if from.len() != to.len() {
        return fault(format!("{} numbers are asked for, there are {}", to.len(), from.len()));
    }
    to.copy_from_slice(from);
    Ok(())
}
