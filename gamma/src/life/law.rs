//! The law of wear: a process with its parameters. In and out: numbers. Never knows time.

use crate::error::{LifeError, positive};
use crate::process::Process;

/// A process with its two parameters, in the units of the caller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Law {
    process: &'static dyn Process,
    logs: [f64; 2],
}

impl Law {
    /// The parameters in the order of [`Process::parameters`].
    ///
    /// # Errors
    /// [`LifeError::NotPositive`].
    pub fn new(process: &'static dyn Process, parameters: [f64; 2]) -> Result<Self, LifeError> {
        let names = process.parameters();
        let logs = [0, 1].map(|at: usize| positive(names[at], parameters[at]).map(libm::log));
        let [first, second] = logs;
        Ok(Self { process, logs: [first?, second?] })
    }

    /// The same from the logarithms of the parameters.
    ///
    /// # Errors
    /// [`LifeError::NotPositive`] for parameters out of the range of numbers.
    pub(crate) fn from_logs(process: &'static dyn Process, logs: [f64; 2]) -> Result<Self, LifeError> {
        for (name, log) in process.parameters().into_iter().zip(logs) {
            positive(name, libm::exp(log))?;
        }
        Ok(Self { process, logs })
    }

    /// Probability that wear stays below `left` throughout an exposure.
    pub(crate) fn survival(&self, exposure: f64, left: f64) -> f64 {
        if exposure > 0.0 { self.process.survival(self.logs, exposure, left) } else { 1.0 }
    }

    /// Probability that wear reaches `left` within an exposure.
    pub(crate) fn failure(&self, exposure: f64, left: f64) -> f64 {
        if exposure > 0.0 { self.process.failure(self.logs, exposure, left) } else { 0.0 }
    }

    /// Failures per unit of exposure among the survivors.
    pub(crate) fn hazard(&self, exposure: f64, left: f64) -> f64 {
        self.process.hazard(self.logs, exposure, left)
    }

    /// Mean exposure at which wear reaches `left`.
    pub(crate) fn mean_exposure(&self, left: f64) -> f64 {
        self.process.mean_exposure(self.logs, left)
    }
}
