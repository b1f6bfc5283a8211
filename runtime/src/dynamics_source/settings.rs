//! How revolutions are run that a measurement is made of. Never knows a mechanism.

use crate::simulate::Integrator;

/// How revolutions are run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RevolutionSettings {
    /// The method.
    pub integrator: Integrator,
    /// Turns after each change of wear before one is measured. Nothing: until later turns would wear alike.
    pub settle: Option<u32>,
    /// Turns whose mean is taken, at least 1. One is enough for a periodic motion; one that chatters needs 20 or more.
    pub average: u32,
}

impl Default for RevolutionSettings {
    /// Adaptive Runge-Kutta, until later turns would wear alike.
    ///
    /// The wear of a revolution is off by 1e-6 to 1e-5 of itself then in the case study, the more the looser the joint has
    /// become; its life by 3e-6 of itself.
    fn default() -> Self {
        Self { integrator: Integrator::Rk43 { tolerance: 1e-6, max_step: None }, settle: None, average: 1 }
    }
}
