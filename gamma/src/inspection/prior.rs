//! What was known before the readings. Never knows readings.

use crate::life::{Estimate, LifeError};
use crate::process::{Process, Reference};
use crate::special::normal_quantile;

/// Probability that a range of a catalogue holds the value.
const RANGE: f64 = 0.95;

/// What was known before the readings.
#[derive(Clone, Debug, PartialEq)]
pub enum Prior {
    /// Nothing: flat in the logarithms of the parameters, of the first as [`Process::flat_prior_power`] has it, and in ln
    /// exponent if that is a parameter; the parameters then are those over the largest exposure of the readings.
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
    /// Nothing but the mean wear per unit of exposure, as a catalogue gives it: its logarithm is normal. Exposure counts as it is.
    Catalogue {
        /// The process.
        process: &'static dyn Process,
        /// Mean of the logarithm.
        mean: f64,
        /// Standard deviation of the logarithm.
        std: f64,
    },
    /// An estimate from other units of the same population: normal in the logarithms of its parameters. Without
    /// covariance the parameters are known, and readings say only where wear is.
    Fit(Estimate),
}

impl Prior {
    /// [`Prior::Catalogue`] from a range [unit of wear / unit of exposure] that holds the mean wear with 95 %.
    ///
    /// # Errors
    /// [`LifeError::CatalogueRange`] where it does not go up, from above 0.
    pub fn catalogue(process: &'static dyn Process, [from, to]: [f64; 2]) -> Result<Self, LifeError> {
        // Not a number does not go up either.
        if !(from > 0.0 && to > from && to.is_finite()) {
            return Err(LifeError::CatalogueRange { from, to });
        }
        let (low, high) = (libm::log(from), libm::log(to));
        let std = 0.5 * (high - low) / normal_quantile(0.5 + 0.5 * RANGE);
        Ok(Self::Catalogue { process, mean: 0.5 * (low + high), std })
    }

    /// The process of the joint.
    pub fn process(&self) -> &'static dyn Process {
        match self {
            Self::Flat { process, .. } | Self::Matching { process, .. } | Self::Catalogue { process, .. } => {
                *process
            }
            Self::Fit(fit) => fit.process(),
        }
    }

    /// Whether exposure counts by an unknown power, if nothing is known of it.
    pub(super) fn has_power_law(&self) -> bool {
        matches!(self, Self::Flat { power_law: true, .. } | Self::Matching { power_law: true, .. })
    }

    pub(super) fn is_catalogue(&self) -> bool {
        matches!(self, Self::Catalogue { .. })
    }

    /// The exposure at which it is told, after increments; exposure 1 where no exponent is unknown.
    pub(super) fn reference(&self, increments: &[[f64; 3]]) -> Reference {
        match self {
            Self::Fit(fit) => *fit.reference(),
            _ if self.has_power_law() => {
                let most = increments.iter().map(|[_, to, _]| *to).fold(0.0, f64::max);
                Reference::exposure(self.process(), most)
            }
            _ => Reference::default(),
        }
    }

    /// ln of the density in the logarithms of parameters, at the reference, and exponent, not normalised.
    pub(super) fn ln_density(&self, logs: &[f64]) -> f64 {
        match self {
            Self::Flat { process, .. } | Self::Matching { process, .. } => {
                process.flat_prior_power() * logs[0]
            }
            Self::Catalogue { process, mean, std } => {
                let off = (process.ln_mean([logs[0], logs[1]]) - mean) / std;
                -0.5 * off * off
            }
            Self::Fit(fit) => {
                let off: Vec<f64> =
                    fit.logs_at_reference().iter().zip(logs).map(|(mean, log)| log - mean).collect();
                fit.factor().distance(&off).map_or(f64::NEG_INFINITY, |square| -0.5 * square)
            }
        }
    }
}
