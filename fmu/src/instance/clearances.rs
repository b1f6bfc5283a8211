//! Values of parameters with which a journal would not fit into its bearing: refused when they are set. In: values, at the present state.
//! Out: a [`Fault`].

use linkwear_runtime::{Evaluator, SetupError, State, check_clearances};

use super::Instance;
use crate::fault::Fault;

/// Part by which a parameter is changed to see whether a clearance depends on it, and what is added to one of zero.
const CHANGE: f64 = 1e-3;

impl Instance {
    /// Refuses a clearance that none can be, whatever the parameters that are not `given` with these values. One that another of them can
    /// put right is refused when the motion is asked.
    pub(super) fn check_clearances(&self, parameters: &[f64], given: &[usize]) -> Result<(), Fault> {
        let description = self.loaded.unit.program.description();
        let Some(motion) = self.motion.as_ref().filter(|_| !description.contacts.is_empty()) else {
            return Ok(());
        };
        let states: Vec<f64> = (0..self.variables.states()).map(|index| motion.state(index)).collect();
        let (q, v) = states.split_at(description.coordinates.len());
        let (state, t) = (State { q: q.to_vec(), v: v.to_vec() }, motion.t());
        let refused = |parameters: &[f64]| -> Result<(), SetupError> {
            let mut evaluator = Evaluator::new(self.loaded.system(), description, parameters)?;
            check_clearances(&mut evaluator, t, &state)
        };
        let Err(fault) = refused(parameters) else { return Ok(()) };
        for index in (0..parameters.len()).filter(|index| !given.contains(index)) {
            let mut other = parameters.to_vec();
            other[index] += CHANGE * other[index].abs() + if other[index] == 0.0 { CHANGE } else { 0.0 };
            if refused(&other).err().as_ref() != Some(&fault) {
                return Ok(());
            }
        }
        Err(fault.into())
    }
}
