//! Values of variables and their derivatives, by reference.

use super::{Instance, Interface, Mode};
use crate::fault::{Fault, fault};
use crate::sensitivity::Sensitivity;
use crate::variables::Variable;

impl Instance {
    /// Values of variables, in the order of their references.
    ///
    /// # Errors
    /// If one is unknown, or has no value here.
    pub fn get(&mut self, references: &[u32], values: &mut [f64]) -> Result<(), Fault> {
        if references.len() != values.len() {
            return fault("every variable here is one number: give as many values as references");
        }
        for (reference, value) in references.iter().zip(values) {
            *value = match self.variables.get(*reference) {
                None => return fault(format!("there is no variable {reference}")),
                Some(Variable::Parameter(index)) => self.parameters[index],
                Some(Variable::Constant(index)) => self.loaded.unit.constants[index].value,
                Some(Variable::Time) => match &self.motion {
                    Some(motion) => motion.t(),
                    None => self.times.start,
                },
                Some(Variable::Output(index)) => self.motion()?.values()?[index],
                Some(Variable::State(index)) => self.motion()?.state(index),
                Some(Variable::Derivative(index)) => self.motion()?.derivative(index)?,
                Some(Variable::Indicator(index)) => self.motion()?.penetrations()[index],
            };
        }
        Ok(())
    }

    /// Sets parameters.
    ///
    /// # Errors
    /// If a variable is none that may be set now, a value is no number, or no journal would fit with it; nothing has changed then.
    pub fn set(&mut self, references: &[u32], values: &[f64]) -> Result<(), Fault> {
        if references.len() != values.len() {
            return fault("every variable here is one number: give as many values as references");
        }
        let begun = !matches!(self.mode, Mode::Instantiated | Mode::Initialization);
        let (mut parameters, mut given) = (self.parameters.clone(), Vec::new());
        for (reference, value) in references.iter().zip(values) {
            let Some(Variable::Parameter(index)) = self.variables.get(*reference) else {
                return fault(format!("variable {reference} is no parameter that can be set"));
            };
            let name = &self.loaded.unit.program.description().parameters[index].name;
            if !value.is_finite() {
                return fault(format!("parameter `{name}` is {value}; give it a finite value"));
            }
            let fixed = self.loaded.fixed[index];
            let allowed = match self.mode {
                Mode::Event | Mode::Step | Mode::ContinuousTime if self.loaded.is_input(index) => true,
                Mode::Event => !fixed,
                Mode::Step => !fixed && self.interface == (Interface::CoSimulation { events: false }),
                _ => !begun,
            };
            if !allowed {
                let why =
                    if fixed { "the mechanism would have to be assembled anew" } else { "not in this mode" };
                return fault(format!("parameter `{name}` cannot be changed now: {why}"));
            }
            parameters[index] = *value;
            given.push(index);
        }
        if begun && parameters != self.parameters {
            self.check_clearances(&parameters, &given)?;
        }
        self.parameters = parameters;
        Ok(())
    }

    /// Derivative of unknowns along a direction of knowns, `seed`.
    ///
    /// # Errors
    /// If one of them is no such variable, or has no derivative here.
    pub fn directional(
        &mut self,
        (unknowns, knowns): (&[u32], &[u32]),
        seed: &[f64],
        sensitivity: &mut [f64],
    ) -> Result<(), Fault> {
        if knowns.len() != seed.len() || unknowns.len() != sensitivity.len() {
            return fault("every variable here is one number: give as many of them as references");
        }
        let variable = |reference: &u32| match self.variables.get(*reference) {
            Some(variable) => Ok(variable),
            None => fault(format!("there is no variable {reference}")),
        };
        let unknowns = unknowns.iter().map(variable).collect::<Result<Vec<_>, _>>()?;
        let knowns = knowns.iter().map(variable).collect::<Result<Vec<_>, _>>()?;
        let loaded = self.loaded;
        let mut at = self.motion()?.kept();
        at.parameters = self.motion()?.present_parameters();
        let dual = self.sensitivity.get_or_insert_with(|| Sensitivity::new(loaded));
        let found = dual.along(loaded, &at, &knowns, seed).map_err(Fault)?;
        for (unknown, value) in unknowns.iter().zip(sensitivity) {
            *value = found
                .of(*unknown)
                .ok_or_else(|| Fault("an unknown is no output or derivative".to_owned()))?;
        }
        Ok(())
    }

    /// Derivative of `seed`-weighted unknowns by each of the knowns.
    ///
    /// # Errors
    /// As [`Self::directional`].
    pub fn adjoint(
        &mut self,
        (unknowns, knowns): (&[u32], &[u32]),
        seed: &[f64],
        sensitivity: &mut [f64],
    ) -> Result<(), Fault> {
        if unknowns.len() != seed.len() || knowns.len() != sensitivity.len() {
            return fault("every variable here is one number: give as many of them as references");
        }
        let mut column = vec![0.0; unknowns.len()];
        for (known, value) in knowns.iter().zip(sensitivity) {
            self.directional((unknowns, &[*known]), &[1.0], &mut column)?;
            *value = column.iter().zip(seed).map(|(a, b)| a * b).sum();
        }
        Ok(())
    }
}
