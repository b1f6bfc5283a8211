//! The maximum-likelihood estimate. In: observations, model. Out: parameters, covariance, first-order bias. Never
//! knows intervals.

use super::likelihood::Model;
use super::linear::inverse;
use super::maximise::{maximise, profile_ln_alpha, start};
use super::{Covariate, Fit, FitError};
use crate::data::{Increment, Observations};
use crate::special::{gamma_q, tetragamma, trigamma};

/// An estimate, with what further analysis needs.
#[derive(Clone, Debug)]
pub struct Estimate {
    /// What was estimated.
    pub model: Model,
    /// (ln alpha, ln beta, [c], [b..]).
    pub(super) phi: Vec<f64>,
    /// Covariance of `phi`: inverse of the observed information.
    pub(super) covariance: Vec<Vec<f64>>,
    /// Log-likelihood there.
    pub log_likelihood: f64,
}

/// Maximum likelihood, [CS (25)]: for alpha and beta alone by Newton's method on the profile equation in ln alpha,
/// otherwise by Newton's method in (ln alpha, ln beta, c, b..).
///
/// # Errors
/// [`FitError`].
pub fn estimate(observations: &Observations, model: &Model) -> Result<Estimate, FitError> {
    estimate_increments(&observations.increments, model, None)
}

/// The same from increments; `near` is a start close to the estimate, if one is known.
pub(super) fn estimate_increments(
    increments: &[Increment],
    model: &Model,
    near: Option<&[f64]>,
) -> Result<Estimate, FitError> {
    if increments.len() <= model.parameters() {
        return Err(FitError::TooFew { increments: increments.len(), parameters: model.parameters() });
    }
    if model.resolution.is_some_and(|step| step.is_nan() || step <= 0.0) {
        return Err(FitError::BadResolution);
    }
    let censored = increments.iter().any(|increment| increment.wear <= 0.0);
    let (phi, point) = if model.parameters() == 2 && !censored {
        let lambdas: Vec<f64> = increments.iter().map(|increment| increment.to - increment.from).collect();
        let wears: Vec<f64> = increments.iter().map(|increment| increment.wear).collect();
        let ln_alpha = profile_ln_alpha(&lambdas, &wears).ok_or(FitError::NoScatter)?;
        let ratio: f64 = lambdas.iter().sum::<f64>() / wears.iter().sum::<f64>();
        let phi = vec![ln_alpha, ln_alpha + libm::log(ratio)];
        let point = model.point(&phi, increments);
        (phi, point)
    } else {
        let from = near.map_or_else(|| start(model, increments), |phi| Ok(phi.to_vec()))?;
        maximise(model, increments, &from, None)?
    };
    let covariance = inverse(&point.information).ok_or(FitError::NotConverged)?;
    Ok(Estimate { model: *model, phi, covariance, log_likelihood: point.value })
}

impl Estimate {
    /// Shape per unit of Lambda.
    pub fn alpha(&self) -> f64 {
        libm::exp(self.phi[0])
    }

    /// Rate [1 / unit of wear].
    pub fn beta(&self) -> f64 {
        libm::exp(self.phi[1])
    }

    /// (alpha, beta, [c], [b..]).
    pub fn parameters(&self) -> Vec<f64> {
        natural(&self.phi)
    }

    /// Covariance of [`Self::parameters`]. At the maximum the gradient is zero, so the change of variables is exact.
    pub fn covariance(&self) -> Vec<Vec<f64>> {
        let slope = |at: usize| if at < 2 { libm::exp(self.phi[at]) } else { 1.0 };
        let size = self.phi.len();
        (0..size).map(|i| (0..size).map(|j| self.covariance[i][j] * slope(i) * slope(j)).collect()).collect()
    }

    /// What a prediction needs.
    pub fn fit(&self, observations: &Observations, covariates: &[String], wear: &str, exposure: &str) -> Fit {
        let first = self.phi.len() - self.model.covariates;
        let covariates = covariates.iter().zip(&self.phi[first..]);
        Fit {
            alpha: self.alpha(),
            beta: self.beta(),
            exponent: self.model.power_law.then(|| self.phi[2]),
            covariates: covariates
                .map(|(name, b)| Covariate { name: name.clone(), coefficient: *b })
                .collect(),
            covariance: self.covariance(),
            log_likelihood: self.log_likelihood,
            n: observations.increments.len(),
            units: observations.units.len(),
            wear_unit: wear.to_owned(),
            exposure_unit: exposure.to_owned(),
        }
    }

    /// Shape of an increment under this estimate.
    pub(super) fn shape(&self, increment: &Increment) -> f64 {
        self.alpha() * self.model.lambda(&self.phi, increment)
    }

    /// Bias of the estimates of alpha and beta to first order in 1/n: D. R. Cox, E. J. Snell (1968),
    /// b_r = 1/2 sum K^ri K^jk kappa_ijk with the third derivatives of the log-likelihood, which are not random in
    /// (alpha, -beta), the canonical parameters. None with an exponent, covariates or a resolution.
    pub fn first_order_bias(&self, observations: &Observations) -> Option<[f64; 2]> {
        if self.model != Model::default() {
            return None;
        }
        let lambdas = observations.increments.iter().map(|increment| increment.to - increment.from);
        Some(first_order_bias(self.alpha(), self.beta(), &lambdas.collect::<Vec<_>>()))
    }
}

pub(super) fn natural(phi: &[f64]) -> Vec<f64> {
    phi.iter().enumerate().map(|(at, value)| if at < 2 { libm::exp(*value) } else { *value }).collect()
}

pub(super) fn first_order_bias(alpha: f64, beta: f64, lambdas: &[f64]) -> [f64; 2] {
    let total: f64 = lambdas.iter().sum();
    let curvature: f64 = lambdas.iter().map(|l| l * l * trigamma(alpha * l)).sum();
    let skew: f64 = lambdas.iter().map(|l| l * l * l * tetragamma(alpha * l)).sum();
    // Information of (alpha, beta) and its inverse.
    let (aa, ab, bb) = (curvature, -total / beta, alpha * total / (beta * beta));
    let determinant = aa * bb - ab * ab;
    let inverse = [[bb / determinant, -ab / determinant], [-ab / determinant, aa / determinant]];
    // kappa_ijk: (a, a, a), (a, b, b) in any order, (b, b, b).
    let (aaa, abb, bbb) = (-skew, -total / (beta * beta), 2.0 * alpha * total / (beta * beta * beta));
    let kappa = |i: usize, j: usize, k: usize| match i + j + k {
        0 => aaa,
        2 => abb,
        3 => bbb,
        _ => 0.0,
    };
    let mut contracted = [0.0; 2];
    for (i, entry) in contracted.iter_mut().enumerate() {
        for (j, row) in inverse.iter().enumerate() {
            for (k, value) in row.iter().enumerate() {
                *entry += 0.5 * kappa(i, j, k) * value;
            }
        }
    }
    [0, 1].map(|r: usize| inverse[r][0] * contracted[0] + inverse[r][1] * contracted[1])
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
    fn first_order_bias_is_that_of_the_textbook_for_equal_spans() {
        // D. E. Giles, H. Feng (2009): bias of the shape a = alpha of n draws is
        // [a psi' - a^2 psi'' - 2] / [2 n (a psi' - 1)^2].
        let (alpha, beta, n) = (2.5, 0.7, 40.0);
        let lambdas = vec![1.0; 40];
        let (one, two) = (trigamma(alpha), tetragamma(alpha));
        let expected = (alpha * one - alpha * alpha * two - 2.0) / (2.0 * n * (alpha * one - 1.0).powi(2));
        let [found, of_beta] = first_order_bias(alpha, beta, &lambdas);
        assert!((found / expected - 1.0).abs() < 1e-10, "{found} {expected}");
        // E[beta^] = E[alpha^] n E[1 / sum W] exactly, sum W ~ Gamma(n alpha, beta), independent of alpha^ (Basu).
        let by_basu = (alpha + expected) * n * beta / (n * alpha - 1.0) - beta;
        // Equal to first order: what is left is of order 1/n of it.
        assert!((of_beta / by_basu - 1.0).abs() < 2.0 / n, "{of_beta} {by_basu}");
    }

    #[test]
    fn a_likelihood_ratio_of_3_84_is_at_5_per_cent() {
        // chi-square, 1 degree: 3.841458820694124.
        assert!((likelihood_ratio(1.0 + 1.920_729_410_347_062, 1.0, 1).p_value - 0.05).abs() < 1e-14);
    }
}
