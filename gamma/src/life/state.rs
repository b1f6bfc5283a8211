//! The state that life is asked for in: how far a joint is worn, and how fast exposure runs. In: numbers. Out: a
//! [`FirstPassage`]. Never knows how parameters were estimated.

use super::clock::Clock;
use super::estimate::{Estimate, exponent_of};
use super::first_passage::FirstPassage;
use super::law::Law;
use super::lifetime::Lifetime;
use crate::error::{LifeError, non_negative, positive};
use crate::process::Process;

/// What is worn how far, and how fast exposure runs from here.
#[derive(Clone, Debug, PartialEq)]
pub struct OperatingState {
    threshold: f64,
    current: f64,
    exposure: f64,
    rate: f64,
}

impl OperatingState {
    /// A new joint that fails at `threshold` [unit of wear]; one unit of exposure per unit of time.
    ///
    /// # Errors
    /// [`LifeError::NotPositive`].
    pub fn new(threshold: f64) -> Result<Self, LifeError> {
        Ok(Self { threshold: positive("the threshold", threshold)?, current: 0.0, exposure: 0.0, rate: 1.0 })
    }

    /// Of a joint of an estimate that fails at `threshold`, as far as is said: units of exposure per unit of time (else 1), wear and
    /// exposure until now (else 0). Where exposure counts by a power, wear needs its exposure.
    ///
    /// # Errors
    /// Those of the parts, [`LifeError::ExposureMissing`].
    pub fn of(
        estimate: &Estimate,
        threshold: f64,
        rate: Option<f64>,
        (current, exposure): (Option<f64>, Option<f64>),
    ) -> Result<Self, LifeError> {
        let mut state = Self::new(threshold)?;
        if let Some(rate) = rate {
            state = state.at_rate(rate)?;
        }
        let current = current.unwrap_or(0.0);
        if current > 0.0 && exposure.is_none() && estimate.exponent().is_some() {
            return Err(LifeError::ExposureMissing);
        }
        state.worn(current, exposure.unwrap_or(0.0))
    }

    /// Worn to `current` [unit of wear] after `exposure` (before any exponent) [unit of exposure].
    ///
    /// # Errors
    /// [`LifeError::Negative`], [`LifeError::Failed`].
    pub fn worn(mut self, current: f64, exposure: f64) -> Result<Self, LifeError> {
        self.current = non_negative("the present wear", current)?;
        self.exposure = non_negative("the present exposure", exposure)?;
        if current >= self.threshold {
            return Err(LifeError::Failed { threshold: self.threshold, current });
        }
        Ok(self)
    }

    /// `rate` units of exposure per unit of time from now on; lives are in that time.
    ///
    /// # Errors
    /// [`LifeError::NotPositive`].
    pub fn at_rate(mut self, rate: f64) -> Result<Self, LifeError> {
        self.rate = positive("the rate", rate)?;
        Ok(self)
    }

    /// Wear at failure.
    pub fn threshold(&self) -> f64 {
        self.threshold
    }

    /// Wear now.
    pub fn current(&self) -> f64 {
        self.current
    }

    /// Units of exposure per unit of time.
    pub fn rate(&self) -> f64 {
        self.rate
    }

    /// Law of the remaining life if the parameters are those estimated.
    ///
    /// # Errors
    /// [`LifeError`], if a parameter leaves the range of numbers.
    pub fn life(&self, estimate: &Estimate) -> Result<FirstPassage, LifeError> {
        let life = self.life_by(estimate, estimate.logs())?;
        let typical = life.typical();
        if typical > 0.0 && typical.is_finite() { Ok(life) } else { Err(LifeError::OutOfRange { typical }) }
    }

    /// Law of wear and clock of a part if the parameters are those estimated.
    ///
    /// # Errors
    /// [`LifeError`], if a parameter leaves the range of numbers.
    pub fn wear(&self, estimate: &Estimate) -> Result<(Law, Clock), LifeError> {
        let exponent = exponent_of(estimate.logs(), estimate.units_differ());
        Ok((estimate.law_at(estimate.logs())?, self.clock(exponent)?))
    }

    fn clock(&self, exponent: Option<f64>) -> Result<Clock, LifeError> {
        Clock::power(self.rate, exponent.unwrap_or(1.0))
    }

    /// Exposure until now.
    pub fn exposure(&self) -> f64 {
        self.exposure
    }

    /// The same at other logarithms of what was estimated.
    pub(crate) fn life_by(&self, estimate: &Estimate, logs: &[f64]) -> Result<FirstPassage, LifeError> {
        self.life_of(estimate.law_at(logs)?, exponent_of(logs, estimate.units_differ()))
    }

    /// The same of one joint, at given logarithms of its parameters and perhaps of the exponent.
    pub(crate) fn life_at(
        &self,
        process: &'static dyn Process,
        logs: &[f64],
    ) -> Result<FirstPassage, LifeError> {
        self.life_of(Law::from_logs(process, [logs[0], logs[1]])?, exponent_of(logs, false))
    }

    fn life_of(&self, law: Law, exponent: Option<f64>) -> Result<FirstPassage, LifeError> {
        Ok(FirstPassage::with_left(
            law,
            self.clock(exponent)?,
            self.threshold - self.current,
            self.exposure / self.rate,
        ))
    }

    /// Worn to `current`, which a particle has, below the threshold but perhaps below 0.
    pub(crate) fn at_wear(&self, current: f64, exposure: f64) -> Self {
        Self { current, exposure, ..self.clone() }
    }
}
