//! Likelihood of exact increments, [CS (25)], and the prior beside it. In: increments, a prior. Out: ln posterior density in
//! the logarithms of the parameters, not normalised. Never knows thresholds.

use super::prior::Prior;
use crate::process::Slice;

/// Increments and what was known before.
#[derive(Debug)]
pub struct Likelihood<'a> {
    /// Exposures, before any exponent, that wear grew between, and by how much.
    increments: &'a [[f64; 3]],
    prior: &'a Prior,
}

impl<'a> Likelihood<'a> {
    pub fn new(increments: &'a [[f64; 3]], prior: &'a Prior) -> Self {
        Self { increments, prior }
    }

    /// All that does not change with the second parameter.
    pub fn slice(&self, ln_first: f64, ln_exponent: f64) -> Slice {
        let exponent = libm::exp(ln_exponent);
        let exposure = |e: f64| if ln_exponent == 0.0 { e } else { libm::pow(e, exponent) };
        let increments: Vec<(f64, f64)> =
            self.increments.iter().map(|[from, to, wear]| (exposure(*to) - exposure(*from), *wear)).collect();
        let mut slice = self.prior.process().slice(ln_first, &increments);
        if let Prior::Matching { process, .. } = self.prior {
            slice.constant += process.ln_matching_weight(ln_first, &increments);
        }
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
