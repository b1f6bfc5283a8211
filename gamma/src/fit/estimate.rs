//! The maximum-likelihood estimate. In: observations, model. Out: parameters, covariance, first-order bias. Never
//! knows intervals.

use super::error::FitError;
use super::maximise::{maximise, start, unbounded};
use super::model::{Model, units};
use super::rounded::{Differing, Laws, windows};
use crate::data::{Increment, Known, Observations, Rounding};
use crate::matrix::Factor;
use crate::special::gamma_q;

/// Largest error of a gauge, in its steps, whose readings are followed through a grid of wear: a step then hides in the error,
/// and a larger one loses nothing.
const MOST_ERROR: f64 = 100.0;

/// Increments whose wear must be known beside those that are bounded: scatter is seen between them.
const FEWEST_EXACT: usize = 2;

/// Part of the information on an exponent or a power that has to be left beside the other parameters. Sums of the information, and
/// logarithms of exposures that differ in their seventh digit, are known to some 1e-10 of themselves: a smaller part is rounding, and
/// any value of the parameter as good as another.
const LEAST_TOLD: f64 = 1e-9;

/// Sizes of increments of wear and exposure between which products of a few are numbers.
const SIZES: [f64; 2] = [1e-100, 1e100];

/// A fitted process.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// What was estimated.
    pub model: Model,
    /// As [`Model`] has it.
    pub(super) phi: Vec<f64>,
    /// Covariance of `phi`: inverse of the observed information.
    pub(super) covariance: Vec<Vec<f64>>,
    /// Log-likelihood there, of the wear increments in the units given.
    pub log_likelihood: f64,
    /// Number of increments.
    pub increments: usize,
}

/// Maximum likelihood, [CS (25)]: for the process's parameters alone as the process has it, otherwise by Newton's method in
/// their logarithms, c and the b. `near` is a start close to the estimate, if one is known.
pub(super) fn estimate_increments(
    increments: &[Increment],
    model: &Model,
    near: Option<&[f64]>,
) -> Result<Fit, FitError> {
    match found(increments, model, near) {
        Err(FitError::NoScatter | FitError::NotConverged) if !are_of_size(increments) => {
            Err(FitError::OutOfRange)
        }
        Ok(fit) if !fit.has_errors() && !are_of_size(increments) => Err(FitError::OutOfRange),
        found => found,
    }
}

/// Whether all wear and exposure is of a size that can be computed with.
fn are_of_size(increments: &[Increment]) -> bool {
    let is_of_size = |number: f64| number == 0.0 || (SIZES[0]..=SIZES[1]).contains(&number.abs());
    increments.iter().all(|one| is_of_size(one.wear) && is_of_size(one.to - one.from))
}

fn found(increments: &[Increment], model: &Model, near: Option<&[f64]>) -> Result<Fit, FitError> {
    let count = increments.iter().filter(|one| one.is_growth()).count();
    if count <= model.parameters() {
        return Err(FitError::TooFew { increments: count, parameters: model.parameters() });
    }
    let exact = increments.iter().filter(|one| one.is_exact()).count();
    if exact < FEWEST_EXACT {
        return Err(FitError::TooFewExact { increments: exact });
    }
    takes(model, increments)?;
    if !model.process.is_increasing() && !grows(increments) {
        return Err(FitError::NoGrowth);
    }
    if let Some(Rounding { step, error }) = model.resolution {
        let is_positive = step > 0.0 && step.is_finite() && error >= 0.0 && error.is_finite();
        if !is_positive {
            return Err(FitError::BadResolution);
        }
        if error > MOST_ERROR * step {
            return Err(FitError::LargeError);
        }
        model.process.mean_shortfall([0.0; 2], step).ok_or(FitError::NoResolution)?;
    }
    let is_plain = increments.iter().all(Increment::is_plain);
    let (phi, point) = if model.parameters() == 2 && model.resolution.is_none() && is_plain {
        let lambdas: Vec<f64> = increments.iter().map(|increment| increment.to - increment.from).collect();
        let wears: Vec<f64> = increments.iter().map(|increment| increment.wear).collect();
        let phi = model.process.maximum(&lambdas, &wears).ok_or(FitError::NoScatter)?.to_vec();
        let point = model.point(&phi, increments, None);
        (phi, point)
    } else {
        let from = near.map_or_else(|| start(model, increments), |phi| Ok(phi.to_vec()))?;
        follows(model, increments, &from)?;
        maximise(model, increments, &from, None)?
    };
    let covariance = Factor::definite(&point.information).and_then(|factor| factor.inverse());
    let covariance = covariance.ok_or_else(|| unbounded(model, increments, &phi))?;
    let is_told = |at: usize| covariance[at][at] * point.information[at][at] * LEAST_TOLD < 1.0;
    if !(2..phi.len()).all(is_told) {
        return Err(FitError::NotTold);
    }
    Ok(Fit { model: *model, phi, covariance, log_likelihood: point.value, increments: count })
}

/// Whether wear grows on average, beyond what rounding leaves of a sum of 0. The exponent and the powers of covariates of exposure
/// do not change the sign of the drift.
fn grows(increments: &[Increment]) -> bool {
    let wears = || increments.iter().filter(|one| one.is_growth()).map(|one| one.wear);
    let size: f64 = wears().map(f64::abs).sum();
    wears().sum::<f64>() > increments.len() as f64 * f64::EPSILON * size
}

/// Refuses increments whose likelihood the model does not have.
fn takes(model: &Model, increments: &[Increment]) -> Result<(), FitError> {
    let has_bridge = |one: &Increment| match one.known {
        Known::Through { .. } => model.process.ln_bridge([0.0; 2], [1.0; 2], 1.0, 0.5).is_some(),
        _ => true,
    };
    if model.resolution.is_some() && !increments.iter().all(Increment::is_plain) {
        return Err(FitError::RoundedBounds);
    }
    if !increments.iter().all(has_bridge) {
        return Err(FitError::NoBridge);
    }
    let Some(effect) = model.process.random_effect().filter(|_| model.units_differ) else { return Ok(()) };
    for unit in units(increments) {
        let is_open = |one: &&Increment| !one.is_exact() && one.known != Known::Entered { from_new: true };
        if unit.iter().filter(is_open).count() > 1 && effect.place([0.0; 2], 1.0, 0.0).is_none() {
            return Err(FitError::ManyBounds);
        }
        let sizes = |one: &Increment| one.ln_covariates[model.covariates..].to_vec();
        // Wear of another size can be brought to a common one where size is the rate's reciprocal alone.
        let is_scaled = model.process.size_powers()[0] == 0.0;
        if model.sizes > 0 && !is_scaled && unit.iter().any(|one| sizes(one) != sizes(&unit[0])) {
            return Err(FitError::SizesWithinUnit);
        }
    }
    Ok(())
}

/// Refuses more rounded readings than can be followed.
pub(super) fn follows(model: &Model, increments: &[Increment], phi: &[f64]) -> Result<(), FitError> {
    let Some(rounding) = model.resolution else { return Ok(()) };
    let logs = |one: &Increment| model.logs(phi, one);
    let places = if model.units_differ { Differing::COST } else { 1 };
    let windows = windows(Laws { process: model.process, logs: &logs }, increments, rounding, places);
    match windows.count > windows.most {
        true => Err(FitError::TooManyWindows { readings: windows.count, most: windows.most }),
        false => Ok(()),
    }
}

impl Fit {
    /// Logarithms of the process's parameters.
    pub fn logs(&self) -> [f64; 2] {
        [self.phi[0], self.phi[1]]
    }

    /// The process's two parameters, then c, if it was estimated, the b of each covariate, and the coefficient of variation of units,
    /// if they differ.
    pub fn parameters(&self) -> Vec<f64> {
        self.phi.iter().enumerate().map(|(at, value)| self.model.natural(at, *value)).collect()
    }

    /// Exponent c, if it was estimated.
    pub fn exponent(&self) -> Option<f64> {
        self.model.power_law.then(|| self.phi[2])
    }

    /// Powers b of the covariates.
    pub fn powers(&self) -> &[f64] {
        self.model.powers(&self.phi)
    }

    /// Powers s of the covariates of size.
    pub fn size_powers(&self) -> &[f64] {
        self.model.size_powers(&self.phi)
    }

    /// Coefficient of variation of what differs between units; None if they do not.
    pub fn cv(&self) -> Option<f64> {
        self.model.units_differ.then(|| self.phi.last().map_or(0.0, |log| libm::exp(*log)))
    }

    /// Covariance of [`Self::parameters`]. At the maximum the gradient is zero, so the change of variables is exact.
    pub fn covariance(&self) -> Vec<Vec<f64>> {
        let slope = |at: usize| if self.model.is_logarithm(at) { libm::exp(self.phi[at]) } else { 1.0 };
        let size = self.phi.len();
        (0..size).map(|i| (0..size).map(|j| self.covariance[i][j] * slope(i) * slope(j)).collect()).collect()
    }

    /// Standard errors of [`Self::parameters`].
    pub fn standard_errors(&self) -> Vec<f64> {
        self.covariance().iter().enumerate().map(|(at, row)| libm::sqrt(row[at].max(0.0))).collect()
    }

    /// Whether all standard errors are positive numbers.
    fn has_errors(&self) -> bool {
        self.standard_errors().iter().all(|error| *error > 0.0 && error.is_finite())
    }

    /// Akaike's criterion.
    pub fn aic(&self) -> f64 {
        2.0 * self.phi.len() as f64 - 2.0 * self.log_likelihood
    }

    /// Schwarz's criterion, n = number of increments.
    pub fn bic(&self) -> f64 {
        self.phi.len() as f64 * libm::log(self.increments as f64) - 2.0 * self.log_likelihood
    }

    /// Exposure of an increment under this fit.
    pub fn lambda(&self, increment: &Increment) -> f64 {
        self.model.lambda(&self.phi, increment)
    }

    /// Bias of the estimates of the process's parameters to first order in 1/n; None with an exponent, covariates, bounds or a
    /// resolution, and where theory has none.
    pub fn first_order_bias(&self, observations: &Observations) -> Option<[f64; 2]> {
        if self.phi.len() > 2 || self.model.resolution.is_some() || !observations.is_plain() {
            return None;
        }
        let lambdas = observations.increments.iter().map(|increment| increment.to - increment.from);
        self.model.process.first_order_bias(self.logs(), &lambdas.collect::<Vec<_>>())
    }
}

/// A test of a wider model against a narrower one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LikelihoodRatio {
    /// Twice the difference of the log-likelihoods.
    pub statistic: f64,
    /// Difference of the numbers of parameters.
    pub degrees: usize,
    /// Probability of more, if the narrower model is true, by the chi-square law.
    pub p_value: f64,
}

/// The likelihood-ratio test of S. S. Wilks (1938).
pub fn likelihood_ratio(wide: f64, narrow: f64, degrees: usize) -> LikelihoodRatio {
    let statistic = (2.0 * (wide - narrow)).max(0.0);
    LikelihoodRatio { statistic, degrees, p_value: gamma_q(degrees as f64 / 2.0, statistic / 2.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_likelihood_ratio_of_3_84_is_at_5_per_cent() {
        // chi-square, 1 degree: 3.841458820694124.
        assert!((likelihood_ratio(1.0 + 1.920_729_410_347_062, 1.0, 1).p_value - 0.05).abs() < 1e-14);
    }
}
