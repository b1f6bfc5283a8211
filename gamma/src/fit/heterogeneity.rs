//! Whether units differ, and by how much. In: observations, model. Out: the fit in which they do, beside the one in which they do
//! not, and a test. That no difference is found is an answer: the largest likelihood is then that of the plain process.

use super::error::FitError;
use super::estimate::{Fit, estimate_increments, follows};
use super::few_units::FewUnits;
use super::maximise::maximise;
use super::model::Model;
use crate::data::Observations;
use crate::matrix::Factor;
use crate::process::RandomEffect;

/// Coefficients of variation that a start is looked for among: powers of 2 times the least that is told from none.
pub(super) const LEAST_CV: f64 = 1e-5;
const DOUBLINGS: i32 = 19;
/// Where the search begins that has no better start.
pub(super) const START_CV: f64 = 0.3;
/// Gain in the log-likelihood below which no difference is found: so little tells nothing, and rounding of some thousand terms lets
/// no top be found.
const GAIN: f64 = 1e-6;

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
pub(super) fn few_units(plain: &Fit, effect: &dyn RandomEffect, observations: &Observations) -> FewUnits {
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
}
