//! The interval of the coefficient of variation between units. In: a fit in which they differ, data. Out: the values that a
//! likelihood-ratio test does not reject. Never knows how the fit was found.

use std::cell::RefCell;

use super::drawn_units::{DrawnUnits, is_skew};
use super::error::FitError;
use super::heterogeneity::{Heterogeneity, LEAST_CV, START_CV, few_units};
use super::interval::{ACCURACY, Interval};
use super::maximise::{LARGEST_CV, maximise};
use super::model::Model;
use crate::data::Observations;
use crate::special::rising_root_within;

/// Turns of the end of an interval and a drawn critical value there, and where they end, in the logarithm of cv: drawn data tell an end to
/// some percent.
const TURNS: usize = 4;
const CLOSE: f64 = 0.03;

impl Heterogeneity {
    /// The coefficients of variation that a likelihood-ratio test at 1 - `level` does not reject, from 0 on if it does not reject
    /// that, and without an upper end if it rejects none up to 1000. Critical values are those of the law of few units, which the test
    /// goes by; of few units whose wear jumps they are drawn at the ends.
    ///
    /// # Errors
    /// [`FitError::NotConverged`] where the other parameters cannot be re-estimated.
    pub fn cv_interval(&self, observations: &Observations, level: f64) -> Result<Interval, FitError> {
        let law = self.critical(observations, level)?;
        let drawn = |cv: f64| {
            let drawn = self.drawn_at(observations, cv);
            drawn.and_then(|drawn| drawn.critical(level)).ok_or(FitError::NotConverged)
        };
        let is_skew = self.is_skew(observations)?;
        // The law has the drawn values' course over cv, so that few turns settle an end.
        let settled = |end: &dyn Fn(f64) -> Result<f64, FitError>| -> Result<f64, FitError> {
            let mut found = end(1.0)?;
            for _ in 0..TURNS {
                if !is_skew || found == 0.0 || found == f64::INFINITY {
                    break;
                }
                let next = end(drawn(found)? / law(found))?;
                let is_settled = next == found || libm::fabs(libm::log(next / found)) < CLOSE;
                found = next;
                if is_settled {
                    break;
                }
            }
            Ok(found)
        };
        let low = match self.test.p_value < 1.0 - level {
            true => settled(&|by| Ok(self.low_end(observations, &|cv| by * law(cv))))?,
            false => 0.0,
        };
        let high = settled(&|by| self.high_end(observations, &|cv| by * law(cv)))?;
        Ok(Interval { low, high })
    }

    /// Whether [`Self::cv_interval`] holds a coefficient of variation, by the test of that one alone: an interval takes some ten.
    ///
    /// # Errors
    /// [`FitError::NotConverged`] where the other parameters cannot be re-estimated.
    pub fn holds_cv(&self, observations: &Observations, cv: f64, level: f64) -> Result<bool, FitError> {
        // An interval that does not reject 0 holds all up to the estimate.
        if self.test.p_value >= 1.0 - level && cv <= self.fit.cv().unwrap_or(0.0) {
            return Ok(true);
        }
        let fall = self.fall(observations, cv, &mut self.fit.phi.clone()).ok_or(FitError::NotConverged)?;
        if self.is_skew(observations)? {
            let drawn = self.drawn_at(observations, cv).ok_or(FitError::NotConverged)?;
            return Ok(drawn.allows(fall, level));
        }
        Ok(fall <= self.critical(observations, level)?(cv))
    }

    /// Whether the law of few units is not that of these.
    fn is_skew(&self, observations: &Observations) -> Result<bool, FitError> {
        let effect = self.plain.model.process.random_effect().ok_or(FitError::NoRandomEffect)?;
        let units = few_units(&self.plain, effect, observations).units;
        Ok(is_skew(units, observations, &self.fit.model))
    }

    /// Data drawn there, the other parameters at their best.
    fn drawn_at<'a>(&self, observations: &'a Observations, cv: f64) -> Option<DrawnUnits<'a>> {
        let (phi, _) = self.best_at(observations, cv, &self.fit.phi)?;
        Some(DrawnUnits::new(&Model { units_differ: true, ..self.fit.model }, phi, observations))
    }

    /// The other parameters' best at a coefficient of variation, looked for from `near` on, and their log-likelihood.
    fn best_at(&self, observations: &Observations, cv: f64, near: &[f64]) -> Option<(Vec<f64>, f64)> {
        let wide = Model { units_differ: true, ..self.fit.model };
        let last = wide.parameters() - 1;
        let from = |phi: &[f64]| {
            let mut phi = phi.to_vec();
            phi.resize(last + 1, 0.0);
            phi[last] = libm::log(cv);
            maximise(&wide, &observations.increments, &phi, Some(last)).ok()
        };
        // Where the likelihood hardly falls towards large ones the estimate may be too far away to begin there.
        let (phi, point) = from(near).or_else(|| from(&self.fit.phi)).or_else(|| from(&self.plain.phi))?;
        Some((phi, point.value))
    }

    /// Twice the fall of the log-likelihood from its maximum to a coefficient of variation; `near` goes along with the best there.
    fn fall(&self, observations: &Observations, cv: f64, near: &mut Vec<f64>) -> Option<f64> {
        let (best, value) = self.best_at(observations, cv, near)?;
        *near = best;
        Some(2.0 * (self.fit.log_likelihood - value))
    }

    /// How far the fall is beyond a critical value, over the coefficient of variation.
    fn beyond<'a>(
        &'a self,
        observations: &'a Observations,
        critical: &'a dyn Fn(f64) -> f64,
    ) -> impl Fn(f64) -> f64 + 'a {
        let near = RefCell::new(self.fit.phi.clone());
        move |cv| {
            let fall = self.fall(observations, cv, &mut near.borrow_mut());
            fall.unwrap_or(f64::INFINITY) - critical(cv)
        }
    }

    /// Where the fall below the estimate is critical; 0 where it is nowhere.
    fn low_end(&self, observations: &Observations, critical: &dyn Fn(f64) -> f64) -> f64 {
        let beyond = self.beyond(observations, critical);
        // Falls towards the top: rises in 1 / cv.
        let rising = |inverse: f64| beyond(1.0 / inverse);
        let low = 1.0 / rising_root_within(&rising, 1.0 / self.fit.cv().unwrap_or(0.0), ACCURACY);
        if low > LEAST_CV { low } else { 0.0 }
    }

    /// Where the fall above the estimate is critical; infinite where it is nowhere.
    fn high_end(&self, observations: &Observations, critical: &dyn Fn(f64) -> f64) -> Result<f64, FitError> {
        let top = self.fit.cv().unwrap_or(0.0);
        if self.is_flat_above(top, observations, critical) {
            return Ok(f64::INFINITY);
        }
        let beyond = self.beyond(observations, critical);
        let rising = |more: f64| beyond(top + more);
        let high = top + rising_root_within(&rising, (0.5 * top).max(LEAST_CV), ACCURACY);
        Some(high).filter(|high| *high < LARGEST_CV).ok_or(FitError::NotConverged)
    }

    /// The fall of twice the log-likelihood to a coefficient of variation that is exceeded with probability 1 - `level`.
    pub(super) fn critical(
        &self,
        observations: &Observations,
        level: f64,
    ) -> Result<impl Fn(f64) -> f64 + use<>, FitError> {
        let effect = self.plain.model.process.random_effect().ok_or(FitError::NoRandomEffect)?;
        let few = few_units(&self.plain, effect, observations);
        let exposures = self.plain.model.exposures(&self.plain.phi, &observations.increments);
        let exposure = exposures.iter().sum::<f64>() / exposures.len() as f64;
        // Of the variance of a unit's total, what differences add to it, beside what is within units.
        let (process, logs) = (self.fit.model.process, self.fit.logs());
        let variance = process.variance(logs) * exposure;
        let mean = libm::exp(process.ln_mean(logs)) * exposure;
        Ok(move |cv: f64| few.critical(cv * cv * mean * mean / variance, level))
    }

    /// Whether the test rejects no larger coefficient of variation, by doubling it and starting each time from the last best fit.
    fn is_flat_above(&self, top: f64, observations: &Observations, critical: &dyn Fn(f64) -> f64) -> bool {
        let wide = Model { units_differ: true, ..self.fit.model };
        let mut phi = self.fit.phi.clone();
        phi.truncate(wide.parameters() - 1);
        phi.push(0.0);
        let last = phi.len() - 1;
        let mut cv = top.max(START_CV);
        while cv < LARGEST_CV {
            cv = (2.0 * cv).min(LARGEST_CV);
            phi[last] = libm::log(cv);
            let Ok((best, point)) = maximise(&wide, &observations.increments, &phi, Some(last)) else {
                return false;
            };
            if 2.0 * (self.fit.log_likelihood - point.value) >= critical(cv) {
                return false;
            }
            phi = best;
        }
        true
    }
}
