//! Estimation of the Gamma process, [CS (25)], [CS (26)]. In: observed wear. Out: estimates with their uncertainty.
//! Never knows files or terminals.
//!
//! Wear grows by independent increments dW ~ Gamma(shape alpha dLambda, rate beta): mean wear per unit of Lambda is
//! alpha / beta. Lambda is the exposure as given, or exposure^c with c estimated, times covariates to powers b.

use serde::{Deserialize, Serialize};
use thiserror::Error;

mod bootstrap;
mod covariates;
mod estimate;
mod goodness;
mod interval;
mod likelihood;
mod linear;
mod maximise;
mod rival;
mod simplex;

pub use bootstrap::{Bootstrap, bootstrap};
pub use estimate::{Estimate, LikelihoodRatio, estimate, likelihood_ratio};
pub use goodness::{Goodness, goodness};
pub use interval::{Interval, profile_interval};
pub use likelihood::Model;
pub use rival::{Rival, inverse_gaussian, wiener};

/// A fitted Gamma process: what a prediction needs, in the units of the data.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Fit {
    /// Shape per unit of Lambda.
    pub alpha: f64,
    /// Rate [1 / unit of wear].
    pub beta: f64,
    /// Exponent c of Lambda = exposure^c, when it was estimated; none: Lambda is the exposure as given.
    #[serde(default)]
    pub exponent: Option<f64>,
    /// Covariates that multiply Lambda, each as value^b.
    #[serde(default)]
    pub covariates: Vec<Covariate>,
    /// Covariance of (alpha, beta, [exponent], [b of each covariate]): square, symmetric.
    pub covariance: Vec<Vec<f64>>,
    /// Log-likelihood at the estimate, of the wear increments in the units given.
    pub log_likelihood: f64,
    /// Number of increments.
    pub n: usize,
    /// Number of units (specimens).
    pub units: usize,
    /// What wear is counted in, as the data call it.
    #[serde(default)]
    pub wear_unit: String,
    /// What exposure or Lambda is counted in, as the data call it.
    #[serde(default)]
    pub exposure_unit: String,
}

/// A covariate of a fit.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Covariate {
    /// Its name in the data.
    pub name: String,
    /// Its power b.
    pub coefficient: f64,
}

impl Fit {
    /// Standard errors of (alpha, beta, [exponent], [b of each covariate]).
    pub fn standard_errors(&self) -> Vec<f64> {
        (0..self.covariance.len()).map(|at| self.covariance[at][at].max(0.0).sqrt()).collect()
    }

    /// Number of parameters.
    pub fn parameters(&self) -> usize {
        2 + usize::from(self.exponent.is_some()) + self.covariates.len()
    }

    /// Akaike's criterion.
    pub fn aic(&self) -> f64 {
        2.0 * self.parameters() as f64 - 2.0 * self.log_likelihood
    }

    /// Schwarz's criterion, n = number of increments.
    pub fn bic(&self) -> f64 {
        self.parameters() as f64 * libm::log(self.n as f64) - 2.0 * self.log_likelihood
    }
}

/// Why a fit did not come about.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum FitError {
    /// Wear is an exact function of Lambda: alpha has no finite maximum.
    #[error("wear follows Lambda without any scatter, so alpha has no finite estimate")]
    NoScatter,
    /// Newton's method has not found a maximum.
    #[error("the likelihood has no maximum inside; a parameter runs off, perhaps the exponent")]
    NotConverged,
    /// Too few increments.
    #[error("{increments} increments cannot give {parameters} parameters")]
    TooFew {
        /// How many there are.
        increments: usize,
        /// How many parameters are sought.
        parameters: usize,
    },
    /// A gauge's step that is not a positive number.
    #[error("the gauge's resolution must be a positive number")]
    BadResolution,
    /// A fit is asked for at values that are not those of its covariates.
    #[error(
        "the fit has {covariates} covariate(s), {given} value(s) were given: one positive number for each, and a covariance of all parameters, are needed"
    )]
    Covariates {
        /// How many it has.
        covariates: usize,
        /// How many values were given.
        given: usize,
    },
}

#[cfg(test)]
mod tests;
