//! Other processes for comparison: Wiener with drift, and inverse Gaussian. In: the same data and Lambda's form. Out:
//! their likelihoods. Never knows the Gamma process's estimate.
//!
//! Both have closed-form estimates given Lambda; c and the powers of covariates are sought by Nelder and Mead's
//! simplex.

use super::FitError;
use super::likelihood::Model;
use super::simplex::maximise_simplex;
use crate::data::Increment;

/// A fit of another process.
#[derive(Clone, Debug, PartialEq)]
pub struct Rival {
    /// Mean wear per unit of Lambda.
    pub drift: f64,
    /// Wiener: standard deviation of wear at Lambda = 1. Inverse Gaussian: its lambda, per Lambda^2.
    pub spread: f64,
    /// Exponent c and powers b, as the model has them.
    pub shape: Vec<f64>,
    /// Log-likelihood.
    pub log_likelihood: f64,
    /// Akaike's criterion.
    pub aic: f64,
}

/// dW ~ Normal(mu dLambda, sigma^2 dLambda).
///
/// # Errors
/// [`FitError::NoScatter`].
pub fn wiener(increments: &[Increment], model: &Model) -> Result<Rival, FitError> {
    best(increments, model, |lambdas| {
        let n = increments.len() as f64;
        let drift = drift(lambdas, increments);
        let square = |(l, i): (&f64, &Increment)| (i.wear - drift * l) * (i.wear - drift * l) / l;
        let variance = lambdas.iter().zip(increments).map(square).sum::<f64>() / n;
        let logs: f64 = lambdas.iter().map(|l| libm::log(2.0 * core::f64::consts::PI * variance * l)).sum();
        (drift, libm::sqrt(variance), -0.5 * (logs + n))
    })
}

/// dW ~ inverse Gaussian(mean mu dLambda, shape lambda dLambda^2).
///
/// # Errors
/// [`FitError::NoScatter`], also for increments that are not positive: the law has none.
pub fn inverse_gaussian(increments: &[Increment], model: &Model) -> Result<Rival, FitError> {
    best(increments, model, |lambdas| {
        let n = increments.len() as f64;
        let drift = drift(lambdas, increments);
        let square = |(l, i): (&f64, &Increment)| (i.wear - drift * l) * (i.wear - drift * l) / i.wear;
        let inverse = lambdas.iter().zip(increments).map(square).sum::<f64>() / (n * drift * drift);
        let density = |(l, i): (&f64, &Increment)| {
            libm::log(l * l / (inverse * 2.0 * core::f64::consts::PI)) - 3.0 * libm::log(i.wear)
        };
        let logs: f64 = lambdas.iter().zip(increments).map(density).sum();
        (drift, 1.0 / inverse, 0.5 * (logs - n))
    })
}

fn drift(lambdas: &[f64], increments: &[Increment]) -> f64 {
    increments.iter().map(|increment| increment.wear).sum::<f64>() / lambdas.iter().sum::<f64>()
}

fn best(
    increments: &[Increment],
    model: &Model,
    closed: impl Fn(&[f64]) -> (f64, f64, f64),
) -> Result<Rival, FitError> {
    let at = |shape: &[f64]| {
        let phi = [&[0.0, 0.0], shape].concat();
        let lambdas: Vec<f64> = increments.iter().map(|increment| model.lambda(&phi, increment)).collect();
        closed(&lambdas)
    };
    let start: Vec<f64> = (2..model.parameters()).map(|k| f64::from(model.power_law && k == 2)).collect();
    let allowed = |shape: &[f64]| !model.power_law || shape[0] > 0.0;
    let value = |shape: &[f64]| if allowed(shape) { at(shape).2 } else { f64::NEG_INFINITY };
    let shape = if start.is_empty() { start } else { maximise_simplex(value, &start, 0.3) };
    let (drift, spread, log_likelihood) = at(&shape);
    if !log_likelihood.is_finite() {
        return Err(FitError::NoScatter);
    }
    let aic = 2.0 * model.parameters() as f64 - 2.0 * log_likelihood;
    Ok(Rival { drift, spread, shape, log_likelihood, aic })
}
