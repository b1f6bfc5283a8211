//! Likelihood of exact Gamma increments, [CS (25)], and the prior beside it. In: increments, a prior. Out: ln posterior
//! density in the logarithms of the parameters, not normalised. Never knows thresholds.

use super::posterior::Prior;
use crate::life::Estimate;
use crate::special::ln_gamma;

/// Increments of one joint in wear and the exposures they happened between.
#[derive(Debug)]
pub struct Likelihood<'a> {
    /// Exposures at the readings, before any exponent.
    exposures: &'a [f64],
    /// ln of each wear increment.
    ln_wear: Vec<f64>,
    wear: f64,
    prior: &'a Prior,
}

/// Everything that does not change with beta.
#[derive(Clone, Copy, Debug)]
pub struct Slice {
    /// Shape of all exposure together: alpha Lambda.
    shape: f64,
    wear: f64,
    constant: f64,
}

impl<'a> Likelihood<'a> {
    pub fn new(exposures: &'a [f64], wear: &[f64], prior: &'a Prior) -> Self {
        let ln_wear = wear.windows(2).map(|pair| (pair[1] - pair[0]).ln()).collect();
        Self { exposures, ln_wear, wear: wear[wear.len() - 1] - wear[0], prior }
    }

    /// At ln alpha and the exponent: sum of alpha d ln beta - ln Gamma(alpha d) + (alpha d - 1) ln w, less beta W.
    pub fn slice(&self, ln_alpha: f64, ln_exponent: f64) -> Slice {
        let alpha = ln_alpha.exp();
        let exponent = ln_exponent.exp();
        let exposure = |e: f64| if ln_exponent == 0.0 { e } else { e.powf(exponent) };
        let (mut shape, mut constant) = (0.0, 0.0);
        for (pair, ln_wear) in self.exposures.windows(2).zip(&self.ln_wear) {
            let one = alpha * (exposure(pair[1]) - exposure(pair[0]));
            // An exponent far out leaves no exposure between two readings: no probability there.
            if one <= 0.0 || !one.is_finite() {
                return Slice { shape: 1.0, wear: self.wear, constant: f64::NEG_INFINITY };
            }
            shape += one;
            constant += (one - 1.0) * ln_wear - ln_gamma(one);
        }
        Slice { shape, wear: self.wear, constant }
    }

    /// ln posterior of a slice at ln beta.
    pub fn at(&self, slice: &Slice, ln_alpha: f64, ln_beta: f64, ln_exponent: f64) -> f64 {
        let likelihood = slice.constant + slice.shape * ln_beta - slice.wear * ln_beta.exp();
        match self.prior {
            Prior::Flat { .. } => likelihood,
            Prior::Fit(fit) => likelihood + ln_prior(fit, &[ln_alpha, ln_beta, ln_exponent]),
        }
    }
}

impl Slice {
    /// ln beta where the likelihood alone is largest.
    pub fn peak(&self) -> f64 {
        (self.shape / self.wear).ln()
    }
}

/// ln of the normal density of the logarithms, not normalised.
fn ln_prior(fit: &Estimate, logs: &[f64]) -> f64 {
    let off: Vec<f64> = fit.logs().iter().zip(logs).map(|(mean, log)| log - mean).collect();
    fit.factor().distance(&off).map_or(f64::NEG_INFINITY, |square| -0.5 * square)
}
