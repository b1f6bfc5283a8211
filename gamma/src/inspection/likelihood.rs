//! Likelihood of exact increments, [CS (25)], and the prior beside it. In: increments, a prior. Out: ln posterior density in
//! the logarithms of the parameters, not normalised. Never knows thresholds.

use super::prior::Prior;
use crate::process::Slice;

/// Increments of one joint in wear and the exposures they happened between.
#[derive(Debug)]
pub struct Likelihood<'a> {
    /// Exposures at the readings, before any exponent.
    exposures: &'a [f64],
    wear: &'a [f64],
    prior: &'a Prior,
}

impl<'a> Likelihood<'a> {
    pub fn new(exposures: &'a [f64], wear: &'a [f64], prior: &'a Prior) -> Self {
        Self { exposures, wear, prior }
    }

    /// All that does not change with the second parameter.
    pub fn slice(&self, ln_first: f64, ln_exponent: f64) -> Slice {
        let exponent = libm::exp(ln_exponent);
        let exposure = |e: f64| if ln_exponent == 0.0 { e } else { libm::pow(e, exponent) };
        let pairs = self.exposures.windows(2).zip(self.wear.windows(2));
        let increments: Vec<(f64, f64)> =
            pairs.map(|(e, w)| (exposure(e[1]) - exposure(e[0]), w[1] - w[0])).collect();
        let slice = self.prior.process().slice(ln_first, &increments);
        // An exponent far out leaves no exposure between two readings: no probability there.
        let possible = increments.iter().all(|(exposure, _)| *exposure > 0.0 && exposure.is_finite());
        if possible && slice.constant.is_finite() && slice.peak().is_finite() {
            return slice;
        }
        Slice { constant: f64::NEG_INFINITY, slope: 1.0, scale: 1.0, power: 1.0 }
    }

    /// ln posterior of a slice at the logarithms of first and second parameter and of the exponent.
    pub fn at(&self, slice: &Slice, logs: &[f64; 3]) -> f64 {
        slice.at(logs[1]) + self.prior.ln_density(logs)
    }
}
