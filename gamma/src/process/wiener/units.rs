//! Wiener processes whose drifts differ by a normal law (C.-Y. Peng, S.-T. Tseng, IEEE Trans. Reliab. 58 (2009) 444). A drift below 0
//! is possible: such a unit may never fail, and lives have no mean.

use rand::RngExt;

use super::super::random_effect::{RandomEffect, RandomLaw};
use crate::random::{StandardNormal, Stream};
use crate::special::{LN_2_PI, ln_above_reflected, normal_cdf, reflected_normal};

/// The drift differs.
#[derive(Clone, Copy, Debug)]
pub struct NormalDrift;

/// Mean and variance of an increment.
fn moments(logs: [f64; 2], cv: f64, exposure: f64) -> (f64, f64) {
    let [drift, spread] = logs.map(libm::exp);
    let mean = drift * exposure;
    (mean, spread * spread * exposure + cv * cv * mean * mean)
}

/// The closed form of a known drift, with its two normal integrals taken over the drift: what [`reflected_normal`] takes.
fn passage(logs: [f64; 2], cv: f64, exposure: f64, left: f64) -> [f64; 2] {
    let [drift, spread] = logs.map(libm::exp);
    let (mean, variance) = moments(logs, cv, exposure);
    let deviation = libm::sqrt(variance);
    let shift = 2.0 * cv * cv * drift * drift * left * exposure / (spread * spread);
    [(mean - left) / deviation, (mean + left + shift) / deviation]
}

impl RandomEffect for NormalDrift {
    fn parameter(&self) -> &'static str {
        "drift"
    }

    fn law(&self) -> &'static str {
        "normal"
    }

    fn numbers(&self, logs: [f64; 2], cv: f64) -> RandomLaw {
        let mean = libm::exp(logs[0]);
        RandomLaw { shape: None, rate: None, mean, std: cv * mean }
    }

    fn ln_density(&self, logs: [f64; 2], cv: f64, wear: f64) -> f64 {
        let (mean, variance) = moments(logs, cv, 1.0);
        -0.5 * (LN_2_PI + libm::log(variance) + (wear - mean) * (wear - mean) / variance)
    }

    fn tails(&self, logs: [f64; 2], cv: f64, exposure: f64, wear: f64) -> (f64, f64) {
        let (mean, variance) = moments(logs, cv, exposure);
        let z = (wear - mean) / libm::sqrt(variance);
        (normal_cdf(z), normal_cdf(-z))
    }

    fn survival(&self, logs: [f64; 2], cv: f64, exposure: f64, left: f64) -> (f64, f64) {
        let [z, y] = passage(logs, cv, exposure, left);
        let (below, above) = reflected_normal(z, y);
        (above, below)
    }

    fn ln_survival(&self, logs: [f64; 2], cv: f64, exposure: f64, left: f64) -> f64 {
        let [z, y] = passage(logs, cv, exposure, left);
        ln_above_reflected(z, y)
    }

    fn after(&self, logs: [f64; 2], cv: f64, exposure: f64, wear: f64) -> Option<([f64; 2], f64)> {
        let [drift, spread] = logs.map(libm::exp);
        let (known, told) = (1.0 / (cv * cv * drift * drift), exposure / (spread * spread));
        let mean = (known * drift + wear / (spread * spread)) / (known + told);
        (mean > 0.0).then(|| ([libm::log(mean), logs[1]], 1.0 / (mean * libm::sqrt(known + told))))
    }

    /// A unit drawn with a drift that is not above 0 hardly wears.
    fn draw(&self, logs: [f64; 2], cv: f64, stream: &mut Stream) -> [f64; 2] {
        let factor: f64 = 1.0 + cv * stream.sample::<f64, _>(StandardNormal);
        [logs[0] + libm::log(factor.max(f64::MIN_POSITIVE)), logs[1]]
    }

    fn has_moments(&self) -> bool {
        false
    }
}
