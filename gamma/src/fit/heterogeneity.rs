//! Whether units differ, and by how much. In: observations, model. Out: the fit in which they do, beside the one in which they do
//! not, and a test. That no difference is found is an answer: the largest likelihood is then that of the plain process.

use super::drawn_units::{DrawnUnits, is_skew};
use super::error::FitError;
use super::estimate::{Fit, estimate_increments, follows};
use super::few_units::FewUnits;
use super::interval::Interval;
use super::maximise::{LARGEST_CV, maximise};
use super::model::Model;
use crate::data::Observations;
use crate::matrix::Factor;
use crate::process::RandomEffect;
use crate::special::rising_root;

/// Coefficients of variation that a start is looked for among: powers of 2 times the least that is told from none.
const LEAST_CV: f64 = 1e-5;
const DOUBLINGS: i32 = 19;
/// Where the search begins that has no better start.
const START_CV: f64 = 0.3;
/// Gain in the log-likelihood below which no difference is found: so little tells nothing, and rounding of some thousand terms lets
/// no top be found.
const GAIN: f64 = 1e-6;
/// Turns of the end of an interval and a drawn critical value there, and where they end, in the logarithm of cv: drawn data tell an end to
/// some percent.
const TURNS: usize = 4;
const CLOSE: f64 = 0.03;

/// A fit in which units differ.
#[derive(Clone, Debug, PartialEq)]
pub struct Heterogeneity {
    /// The fit with the larger likelihood: that in which units differ, or the plain one where no difference is found.
    pub fit: Fit,
    /// The fit in which they do not.
    pub plain: Fit,
    /// Whether none is found.
    pub boundary: bool,
    /// Of no difference.
    pub test: UnitsTest,
    /// Units.
    pub units: usize,
}

/// The test of no difference between units by the ratio of likelihoods.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnitsTest {
    /// Twice the difference of the log-likelihoods; 0 on the boundary.
    pub statistic: f64,
    /// Probability of so large a statistic if units do not differ.
    pub p_value: f64,
    /// The same by its law for many units, half of it at 0 and half chi-square with one degree of freedom.
    pub asymptotic_p: f64,
}

/// Maximum likelihood, [CS (25)]: where units may differ, the fit of [`estimate_units`].
///
/// # Errors
/// [`FitError`].
pub fn estimate(observations: &Observations, model: &Model) -> Result<Fit, FitError> {
    match model.units_differ {
        true => estimate_units(observations, model).map(|found| found.fit),
        false => estimate_increments(&observations.increments, model, None),
    }
}

/// The maximum-likelihood fit with units that differ, of readings of two units or more. `model` says all but that.
///
/// # Errors
/// [`FitError`].
pub fn estimate_units(observations: &Observations, model: &Model) -> Result<Heterogeneity, FitError> {
    let units = observations.units.len();
    let effect = model.process.random_effect().ok_or(FitError::NoRandomEffect)?;
    if units < 2 {
        return Err(FitError::OneUnit);
    }
    let plain = estimate(observations, &Model { units_differ: false, ..*model })?;
    let wide = Model { units_differ: true, ..*model };
    if plain.increments <= wide.parameters() {
        return Err(FitError::TooFew { increments: plain.increments, parameters: wide.parameters() });
    }
    let mut start = plain.phi.clone();
    start.push(libm::log(START_CV));
    follows(&wide, &observations.increments, &start)?;
    let found = climb(observations, &wide, &plain)?;
    let boundary = found.is_none();
    let fit = found.unwrap_or_else(|| plain.clone());
    let statistic = if boundary { 0.0 } else { 2.0 * (fit.log_likelihood - plain.log_likelihood) };
    let few = few_units(&plain, effect, observations);
    let test = UnitsTest {
        statistic,
        p_value: if boundary { 1.0 } else { few.probability(statistic, 0.0) },
        asymptotic_p: if boundary { 1.0 } else { 0.5 * libm::erfc(libm::sqrt(0.5 * statistic)) },
    };
    Ok(Heterogeneity { fit, plain, boundary, test, units })
}

/// The fit in which units differ, if it is more likely than the plain one. There the likelihood does not change with
/// the other parameters, so the plain fit's own slope in the variation says whether one lies nearby.
fn climb(observations: &Observations, wide: &Model, plain: &Fit) -> Result<Option<Fit>, FitError> {
    let from = |cv: f64| {
        let mut phi = plain.phi.clone();
        phi.push(libm::log(cv));
        phi
    };
    let starts = (0..DOUBLINGS).map(|power| LEAST_CV * libm::exp2(power.into()));
    let gain = |cv: f64| match wide.resolution {
        Some(_) => wide.value(&from(cv), &observations.increments) - plain.log_likelihood,
        None => wide.of_units(&from(cv), &observations.increments),
    };
    let rated = starts.map(|cv| (gain(cv), cv));
    let best = rated.filter(|(gain, _)| *gain > GAIN).max_by(|a, b| a.0.total_cmp(&b.0));
    let start = from(best.map_or(START_CV, |(_, cv)| cv));
    let climbed = maximise(wide, &observations.increments, &start, None);
    let (phi, point) = match climbed {
        Ok(found) => found,
        // Without a start that gains the way led nowhere, as expected.
        Err(_) if best.is_none() => return Ok(None),
        Err(error) => return Err(error),
    };
    let differ = phi.last().is_some_and(|log| *log > libm::log(LEAST_CV));
    if point.value < plain.log_likelihood + GAIN || !differ {
        return Ok(None);
    }
    let covariance = Factor::definite(&point.information).and_then(|factor| factor.inverse());
    let covariance = covariance.ok_or(FitError::NotConverged)?;
    Ok(Some(Fit { model: *wide, phi, covariance, log_likelihood: point.value, increments: plain.increments }))
}

/// How many units of equal exposures and normal totals say as much of differences as these, by the mean and the variance of the score.
fn few_units(plain: &Fit, effect: &dyn RandomEffect, observations: &Observations) -> FewUnits {
    let excess = effect.excess(plain.logs());
    let exposures = plain.model.exposures(&plain.phi, &observations.increments);
    let all: f64 = exposures.iter().sum();
    let squares: f64 = exposures.iter().map(|own| own * (own + excess)).sum();
    let count = exposures.len() as f64;
    let units = 1.0 + all * all / squares * (count - 1.0) / count;
    let degrees = plain.increments as f64 - observations.units.len() as f64 - (plain.phi.len() - 2) as f64;
    FewUnits { units, degrees: degrees.max(1.0) }
}

impl Heterogeneity {
    /// Parameters of the model in which units differ, also where no difference is found.
    pub fn parameters(&self) -> usize {
        self.plain.phi.len() + 1
    }

    /// Akaike's criterion of that model.
    pub fn aic(&self) -> f64 {
        2.0 * self.parameters() as f64 - 2.0 * self.fit.log_likelihood
    }

    /// Schwarz's criterion of that model, n = number of increments.
    pub fn bic(&self) -> f64 {
        self.parameters() as f64 * libm::log(self.fit.increments as f64) - 2.0 * self.fit.log_likelihood
    }

    /// The coefficients of variation that a likelihood-ratio test at 1 - `level` does not reject, from 0 on if it does not reject
    /// that, and without an upper end if it rejects none up to 1000. Critical values are those of the law of few units, which the test
    /// goes by; of few units whose wear jumps they are drawn at the ends.
    ///
    /// # Errors
    /// [`FitError::NotConverged`] where the other parameters cannot be re-estimated.
    pub fn cv_interval(&self, observations: &Observations, level: f64) -> Result<Interval, FitError> {
        let law = self.critical(observations, level)?;
        let drawn = |cv: f64| {
            let drawn = DrawnUnits::new(self, observations, cv);
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
        let fall = self.fall(observations, cv).ok_or(FitError::NotConverged)?;
        if self.is_skew(observations)? {
            let drawn = DrawnUnits::new(self, observations, cv).ok_or(FitError::NotConverged)?;
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

    /// The other parameters' best at a coefficient of variation, and their log-likelihood.
    pub(super) fn best_at(&self, observations: &Observations, cv: f64) -> Option<(Vec<f64>, f64)> {
        let wide = Model { units_differ: true, ..self.fit.model };
        let last = wide.parameters() - 1;
        let from = |phi: &[f64]| {
            let mut phi = phi.to_vec();
            phi.resize(last + 1, 0.0);
            phi[last] = libm::log(cv);
            maximise(&wide, &observations.increments, &phi, Some(last)).ok()
        };
        // Where the likelihood hardly falls towards large ones the estimate may be too far away to begin there.
        let (phi, point) = from(&self.fit.phi).or_else(|| from(&self.plain.phi))?;
        Some((phi, point.value))
    }

    /// Twice the fall of the log-likelihood from its maximum to a coefficient of variation.
    fn fall(&self, observations: &Observations, cv: f64) -> Option<f64> {
        self.best_at(observations, cv).map(|(_, value)| 2.0 * (self.fit.log_likelihood - value))
    }

    /// Where the fall below the estimate is critical; 0 where it is nowhere.
    fn low_end(&self, observations: &Observations, critical: &dyn Fn(f64) -> f64) -> f64 {
        let beyond = |cv: f64| self.fall(observations, cv).unwrap_or(f64::INFINITY) - critical(cv);
        // Falls towards the top: rises in 1 / cv.
        let low = 1.0 / rising_root(&|inverse| beyond(1.0 / inverse), 1.0 / self.fit.cv().unwrap_or(0.0));
        if low > LEAST_CV { low } else { 0.0 }
    }

    /// Where the fall above the estimate is critical; infinite where it is nowhere.
    fn high_end(&self, observations: &Observations, critical: &dyn Fn(f64) -> f64) -> Result<f64, FitError> {
        let top = self.fit.cv().unwrap_or(0.0);
        if self.is_flat_above(top, observations, critical) {
            return Ok(f64::INFINITY);
        }
        let beyond = |cv: f64| self.fall(observations, cv).unwrap_or(f64::INFINITY) - critical(cv);
        let high = top + rising_root(&|more| beyond(top + more), (0.5 * top).max(LEAST_CV));
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
