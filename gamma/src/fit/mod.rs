//! Estimation of the Gamma process, [CS (25)], [CS (26)]. In: observed wear. Out: estimates with their uncertainty.
//! Never knows files or terminals.
//!
//! Wear grows by independent increments dW ~ Gamma(shape alpha dLambda, rate beta): mean wear per unit of Lambda is
//! alpha / beta. With an exponent c, Lambda = exposure^c.

use serde::{Deserialize, Serialize};

/// A fitted Gamma process: what a prediction needs, in the units of the data.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fit {
    /// Shape per unit of Lambda.
    pub alpha: f64,
    /// Rate [1 / unit of wear].
    pub beta: f64,
    /// Exponent c of Lambda = exposure^c, when it was estimated; none: Lambda is the exposure as given.
    #[serde(default)]
    pub exponent: Option<f64>,
    /// Covariance of (alpha, beta), or of (alpha, beta, c): 2 x 2 or 3 x 3, symmetric.
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
