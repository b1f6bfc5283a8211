//! What was known before the readings. Never knows readings.

use crate::life::Estimate;
use crate::process::Process;

/// What was known before the readings.
#[derive(Clone, Debug, PartialEq)]
pub enum Prior {
    /// Nothing: flat in the logarithms of the parameters, of the first as [`Process::flat_prior_power`] has it, and in ln
    /// exponent if that is a parameter.
    Flat {
        /// The process.
        process: &'static dyn Process,
        /// Whether exposure counts by an unknown power; else as it is.
        power_law: bool,
    },
    /// Nothing, as [`Prior::Flat`], but weighed by [`Process::ln_matching_weight`] so that intervals of lives cover as often in
    /// repeated sampling as they say.
    Matching {
        /// The process.
        process: &'static dyn Process,
        /// Whether exposure counts by an unknown power; else as it is.
        power_law: bool,
    },
    /// An estimate from other units of the same population: normal in the logarithms of its parameters. Without
    /// covariance the parameters are known, and readings say only where wear is.
    Fit(Estimate),
}

impl Prior {
    /// The process of the joint.
    pub fn process(&self) -> &'static dyn Process {
        match self {
            Self::Flat { process, .. } | Self::Matching { process, .. } => *process,
            Self::Fit(fit) => fit.process(),
        }
    }

    /// ln of the density in the logarithms of parameters and exponent, not normalised.
    pub(super) fn ln_density(&self, logs: &[f64]) -> f64 {
        match self {
            Self::Flat { process, .. } | Self::Matching { process, .. } => {
                process.flat_prior_power() * logs[0]
            }
            Self::Fit(fit) => {
                let off: Vec<f64> = fit.logs().iter().zip(logs).map(|(mean, log)| log - mean).collect();
                fit.factor().distance(&off).map_or(f64::NEG_INFINITY, |square| -0.5 * square)
            }
        }
    }
}
