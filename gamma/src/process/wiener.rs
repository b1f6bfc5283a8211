//! The Wiener process with drift: dW ~ Normal(mean drift dLambda, variance spread² dLambda). In and out: see [`Process`].
//! Never knows other processes.
//!
//! First passage over `left` takes an exposure of the inverse Gaussian law with mean left / drift and shape
//! (left / spread)² (E. Schrödinger 1915; J. L. Folks, R. S. Chhikara, J. R. Stat. Soc. B 40 (1978) 263).

mod units;

use rand::RngExt;

use self::units::NormalDrift;
use super::definition::{Process, Slice, Term, scatters};
use super::random_effect::RandomEffect;
use crate::random::{StandardNormal, Stream};
use crate::special::{LN_2_PI, inverse_gaussian, normal_cdf, normal_mills, normal_quantile};

/// Parameters: the drift, wear per unit of exposure, and the spread, its standard deviation over a unit of exposure.
#[derive(Clone, Copy, Debug)]
pub struct Wiener;

impl Process for Wiener {
    fn name(&self) -> &'static str {
        "wiener"
    }

    fn title(&self) -> &'static str {
        "Wiener"
    }

    fn parameters(&self) -> [&'static str; 2] {
        ["drift", "spread"]
    }

    fn exposure_powers(&self) -> [f64; 2] {
        [1.0, 0.5]
    }

    fn is_increasing(&self) -> bool {
        false
    }

    fn maximum(&self, exposures: &[f64], wears: &[f64]) -> Option<[f64; 2]> {
        let drift = wears.iter().sum::<f64>() / exposures.iter().sum::<f64>();
        let square = |(l, w): (&f64, &f64)| (w - drift * l) * (w - drift * l) / l;
        let scatter: f64 = exposures.iter().zip(wears).map(square).sum();
        let logs = [libm::log(drift), 0.5 * libm::log(scatter / wears.len() as f64)];
        let wear: f64 = wears.iter().sum();
        (drift > 0.0 && scatters(scatter, drift * wear)).then_some(logs)
    }

    fn ln_mean(&self, logs: [f64; 2]) -> f64 {
        logs[0]
    }

    fn variance(&self, logs: [f64; 2]) -> f64 {
        libm::exp(2.0 * logs[1])
    }

    fn density(&self, [ln_mean, ln_deviation]: [f64; 2], wear: f64) -> Term {
        let (mean, deviation) = (libm::exp(ln_mean), libm::exp(ln_deviation));
        let (z, m) = ((wear - mean) / deviation, mean / deviation);
        Term {
            value: -0.5 * (LN_2_PI + z * z) - ln_deviation,
            gradient: [z * m, z * z - 1.0],
            hessian: [(z - m) * m, -2.0 * z * m, -2.0 * z * z],
        }
    }

    fn slice(&self, ln_drift: f64, increments: &[(f64, f64)]) -> Slice {
        let drift = libm::exp(ln_drift);
        let (mut constant, mut scale) = (0.0, 0.0);
        for (exposure, wear) in increments {
            let miss = wear - drift * exposure;
            scale += 0.5 * miss * miss / exposure;
            constant -= 0.5 * (LN_2_PI + libm::log(*exposure));
        }
        Slice { constant, slope: -(increments.len() as f64), scale, power: -2.0 }
    }

    /// Flat in the drift: flat in its logarithm, the likelihood at drift 0 would leave all weight there.
    fn flat_prior_power(&self) -> f64 {
        1.0
    }

    /// Drifts near 0 keep some density: lives go as 1 / drift.
    fn increments_for_variance(&self) -> Option<usize> {
        None
    }

    fn random_effect(&self) -> Option<&'static dyn RandomEffect> {
        Some(&NormalDrift)
    }

    fn draw(&self, logs: [f64; 2], exposure: f64, stream: &mut Stream) -> f64 {
        let [drift, spread] = logs.map(libm::exp);
        drift * exposure + spread * libm::sqrt(exposure) * stream.sample(StandardNormal)
    }

    fn cumulative(&self, logs: [f64; 2], exposure: f64, wear: f64) -> f64 {
        let [drift, spread] = logs.map(libm::exp);
        normal_cdf((wear - drift * exposure) / (spread * libm::sqrt(exposure)))
    }

    /// Normal around the straight line, whatever the drift.
    fn ln_bridge(&self, logs: [f64; 2], [first, second]: [f64; 2], wear: f64, below: f64) -> Option<f64> {
        let all = first + second;
        let deviation = libm::exp(logs[1]) * libm::sqrt(first * second / all);
        Some(libm::log(normal_cdf((below - wear * first / all) / deviation)))
    }

    fn quantile(&self, logs: [f64; 2], exposure: f64, p: f64) -> f64 {
        let [drift, spread] = logs.map(libm::exp);
        drift * exposure + spread * libm::sqrt(exposure) * normal_quantile(p)
    }

    fn survival(&self, logs: [f64; 2], exposure: f64, left: f64) -> f64 {
        let [drift, spread] = logs.map(libm::exp);
        inverse_gaussian(left / drift, (left / spread) * (left / spread), exposure).1
    }

    fn failure(&self, logs: [f64; 2], exposure: f64, left: f64) -> f64 {
        let [drift, spread] = logs.map(libm::exp);
        inverse_gaussian(left / drift, (left / spread) * (left / spread), exposure).0
    }

    /// Density over survival, both divided by the normal density that they share.
    fn hazard(&self, logs: [f64; 2], exposure: f64, left: f64) -> f64 {
        if exposure <= 0.0 {
            return 0.0;
        }
        let [drift, spread] = logs.map(libm::exp);
        let deviation = spread * libm::sqrt(exposure);
        let (near, far) = ((left - drift * exposure) / deviation, (left + drift * exposure) / deviation);
        left / (deviation * exposure) / (normal_mills(-near) - normal_mills(far))
    }

    /// Those of the inverse Gaussian law: mean, mean³ / shape.
    fn passage_moments(&self, logs: [f64; 2], left: f64) -> Option<(f64, f64)> {
        let [drift, spread] = logs.map(libm::exp);
        let mean = left / drift;
        Some((mean, mean * (spread / drift) * (spread / drift)))
    }

    /// Exact.
    fn mean_exposure(&self, logs: [f64; 2], left: f64) -> f64 {
        left / libm::exp(logs[0])
    }
}
