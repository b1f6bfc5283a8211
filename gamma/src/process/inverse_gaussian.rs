//! The inverse Gaussian process: dW ~ inverse Gaussian of mean drift dLambda and shape spread dLambda² (X. Wang, D. Xu,
//! Technometrics 52 (2010) 188). In and out: see [`Process`]. Never knows other processes.
//!
//! Wear does not fall, so the law of the first passage is that of the increment: with k² = spread / left,
//!
//! ```text
//! S(L) = Phi(k [left / drift - L]) + exp(2 spread L / drift) Phi(-k [left / drift + L])
//! ```

mod units;

use core::f64::consts::FRAC_1_SQRT_2;

use rand::RngExt;
use rand::distr::Open01;

use self::units::NormalSlowness;
use super::definition::{Process, Slice, Term, scatters};
use super::random_effect::RandomEffect;
use crate::random::{StandardNormal, Stream};
use crate::special::{LN_2_PI, inverse_gaussian, normal_cdf, normal_density, normal_mills, rising_root};

/// Parameters: the drift, mean wear per unit of exposure, and the spread, the law's shape lambda over a unit of exposure
/// [unit of wear / unit of exposure²]: the larger, the less wear scatters.
#[derive(Clone, Copy, Debug)]
pub struct InverseGaussian;

/// Mean and shape of the increment over an exposure.
fn law(logs: [f64; 2], exposure: f64) -> (f64, f64) {
    (libm::exp(logs[0]) * exposure, libm::exp(logs[1]) * exposure * exposure)
}

impl Process for InverseGaussian {
    fn name(&self) -> &'static str {
        "inverse-gaussian"
    }

    fn title(&self) -> &'static str {
        "inverse Gaussian"
    }

    fn parameters(&self) -> [&'static str; 2] {
        ["drift", "spread"]
    }

    fn exposure_powers(&self) -> [f64; 2] {
        [1.0, 2.0]
    }

    fn maximum(&self, exposures: &[f64], wears: &[f64]) -> Option<[f64; 2]> {
        let drift = wears.iter().sum::<f64>() / exposures.iter().sum::<f64>();
        let square = |(l, w): (&f64, &f64)| (w - drift * l) * (w - drift * l) / w;
        let scatter = exposures.iter().zip(wears).map(square).sum::<f64>() / (drift * drift);
        let logs = [libm::log(drift), libm::log(wears.len() as f64 / scatter)];
        let exposure: f64 = exposures.iter().sum();
        (wears.iter().all(|wear| *wear > 0.0) && scatters(scatter, exposure / drift)).then_some(logs)
    }

    fn ln_mean(&self, logs: [f64; 2]) -> f64 {
        logs[0]
    }

    fn variance(&self, logs: [f64; 2]) -> f64 {
        libm::exp(3.0 * logs[0] - logs[1])
    }

    fn density(&self, [ln_mean, ln_shape]: [f64; 2], wear: f64) -> Term {
        let (mean, shape) = (libm::exp(ln_mean), libm::exp(ln_shape));
        let miss = wear - mean;
        let square = shape * miss * miss / (2.0 * mean * mean * wear);
        let slope = shape * miss / (mean * mean);
        Term {
            value: 0.5 * (ln_shape - LN_2_PI) - 1.5 * libm::log(wear) - square,
            gradient: [slope, 0.5 - square],
            hessian: [-shape * (2.0 * wear - mean) / (mean * mean), slope, -square],
        }
    }

    fn slice(&self, ln_drift: f64, increments: &[(f64, f64)]) -> Slice {
        let drift = libm::exp(ln_drift);
        let (mut constant, mut scale) = (0.0, 0.0);
        for (exposure, wear) in increments {
            let miss = wear / drift - exposure;
            scale += 0.5 * miss * miss / wear;
            constant += libm::log(*exposure) - 0.5 * LN_2_PI - 1.5 * libm::log(*wear);
        }
        Slice { constant, slope: 0.5 * increments.len() as f64, scale, power: 1.0 }
    }

    /// Flat in 1 / drift, in which the likelihood is normal: flat in the logarithm it is not proper at infinite drift.
    fn flat_prior_power(&self) -> f64 {
        -1.0
    }

    /// 1 / drift follows Student's law of one degree less than there are increments.
    fn increments_for_variance(&self) -> Option<usize> {
        Some(4)
    }

    fn random_effect(&self) -> Option<&'static dyn RandomEffect> {
        Some(&NormalSlowness)
    }

    /// J. R. Michael, W. R. Schucany, R. W. Haas, Am. Stat. 30 (1976) 88: the smaller root of shape (w - mean)² /
    /// (mean² w) = z², or mean² over it.
    fn draw(&self, logs: [f64; 2], exposure: f64, stream: &mut Stream) -> f64 {
        let (mean, shape) = law(logs, exposure);
        let z: f64 = stream.sample(StandardNormal);
        let half = 0.5 * mean * z * z / shape;
        // Small against 1 + half + sqrt(..) by a quotient, not by a difference.
        let root = mean / (1.0 + half + libm::sqrt(half * (half + 2.0)));
        let u: f64 = stream.sample(Open01);
        if u * (mean + root) <= mean { root } else { mean * mean / root }
    }

    fn cumulative(&self, logs: [f64; 2], exposure: f64, wear: f64) -> f64 {
        let (mean, shape) = law(logs, exposure);
        inverse_gaussian(mean, shape, wear).0
    }

    fn quantile(&self, logs: [f64; 2], exposure: f64, p: f64) -> f64 {
        let (mean, shape) = law(logs, exposure);
        // The smaller of the two tails keeps its digits.
        let miss = |wear: f64| {
            let (below, above) = inverse_gaussian(mean, shape, wear);
            if p <= 0.5 { below - p } else { (1.0 - p) - above }
        };
        rising_root(&miss, mean)
    }

    fn failure(&self, logs: [f64; 2], exposure: f64, left: f64) -> f64 {
        let (mean, shape) = law(logs, exposure);
        inverse_gaussian(mean, shape, left).1
    }

    /// The derivative of S, and S itself, both divided by the normal density that they share.
    fn hazard(&self, logs: [f64; 2], exposure: f64, left: f64) -> f64 {
        let [drift, spread] = logs.map(libm::exp);
        let k = libm::sqrt(spread / left);
        let (near, far) = (k * (left / drift - exposure), normal_mills(k * (left / drift + exposure)));
        2.0 * (k - spread / drift * far) / (normal_mills(-near) + far)
    }

    /// The integral of S: with z = k left / drift, left / drift Phi(z) + [phi(z) + (Phi(z) - 1/2) / z] / k. For large z that is
    /// left / drift + drift / (2 spread).
    fn mean_exposure(&self, logs: [f64; 2], left: f64) -> f64 {
        let [drift, spread] = logs.map(libm::exp);
        // Where z is too small for a number, the quotient still has its limit.
        let z = (libm::sqrt(spread * left) / drift).max(f64::MIN_POSITIVE);
        let inner = 0.5 * libm::erf(z * FRAC_1_SQRT_2) / z;
        left / drift * normal_cdf(z) + libm::sqrt(left / spread) * (normal_density(z) + inner)
    }
}
