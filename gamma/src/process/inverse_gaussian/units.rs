//! Inverse Gaussian processes whose reciprocal drifts differ by a normal law, cut off at 0 (Z.-S. Ye, N. Chen, Technometrics 56 (2014)
//! 302; X. Wang, D. Xu, Technometrics 52 (2010) 188). With m the mean and s the standard deviation of 1 / drift before the
//! cut, u = 1 + spread w s² of wear w over exposure 1:
//!
//! ```text
//! ln density = [ln(spread / (2 pi w³)) - ln u - spread (w m - 1)² / (w u)] / 2 + ln Phi(m' / s') - ln Phi(m / s)
//! m' = (m + spread s²) / u, s'² = s² / u: the law of 1 / drift after w
//! ```

use rand::RngExt;

use super::super::random_effect::{RandomEffect, RandomLaw};
use crate::quadrature::integrate;
use crate::random::{StandardNormal, Stream};
use crate::special::{
    LN_2_PI, inverse_gaussian, ln_reflected_normal, normal_cdf, normal_density, reflected_normal,
};

/// 1 / drift differs.
#[derive(Clone, Copy, Debug)]
pub struct NormalSlowness;

/// Standard deviations between 0 and the mean from which on the cut is below rounding.
const UNCUT: f64 = 8.0;
/// Standard deviations around the mean that are integrated over where the cut counts: beyond lie 1e-18.
const REACH: f64 = 8.8;
/// Accuracy of that integral.
const ACCURACY: f64 = 1e-11;

/// Logarithm of the part of a normal law that is above 0, its mean so many standard deviations above it.
fn ln_above_zero(mean_over_std: f64) -> f64 {
    libm::log1p(-normal_cdf(-mean_over_std))
}

/// The closed form of a known drift, with its two normal integrals taken over 1 / drift, cut off nowhere: what [`reflected_normal`] takes.
fn uncut(logs: [f64; 2], cv: f64, exposure: f64, wear: f64) -> [f64; 2] {
    let m = libm::exp(-logs[0]);
    let shape = libm::exp(logs[1]) * exposure * exposure;
    let s = cv * m / exposure;
    let m = m / exposure;
    let grown = libm::sqrt((1.0 + shape * wear * s * s) * wear / shape);
    [(wear * m - 1.0) / grown, (wear * (m + 2.0 * shape * s * s) + 1.0) / grown]
}

impl NormalSlowness {
    /// Below and above `wear`, by quadrature over 1 / drift from 0 on.
    fn cut(logs: [f64; 2], cv: f64, exposure: f64, wear: f64) -> (f64, f64) {
        let m = libm::exp(-logs[0]);
        let s = cv * m;
        let spread = libm::exp(logs[1]);
        let density = |d: f64| normal_density((d - m) / s) / s;
        let part = |d: f64| {
            let (below, above) = inverse_gaussian(exposure / d, spread * exposure * exposure, wear);
            [density(d) * below, density(d) * above]
        };
        let end = m + REACH * s;
        // Below the middle wear is fast; the integrand turns where the mean of the increment is `wear`.
        let turn = exposure / wear;
        let width = libm::sqrt(1.0 / (spread * wear));
        let begin = (m - REACH * s).max(f64::MIN_POSITIVE);
        let mut limits = vec![begin, end];
        let inner = [turn - 4.0 * width, turn, turn + 4.0 * width, m];
        limits.extend(inner.into_iter().filter(|d| *d > begin && *d < end));
        limits.sort_by(f64::total_cmp);
        let all = libm::exp(ln_above_zero(1.0 / cv));
        let [below, above] = integrate(&part, &limits, [ACCURACY; 2]).0;
        ((below / all).min(1.0), (above / all).min(1.0))
    }
}

impl RandomEffect for NormalSlowness {
    fn parameter(&self) -> &'static str {
        "1 / drift"
    }

    fn law(&self) -> &'static str {
        "normal"
    }

    fn numbers(&self, logs: [f64; 2], cv: f64) -> RandomLaw {
        let mean = libm::exp(-logs[0]);
        RandomLaw { shape: None, rate: None, mean, std: cv * mean }
    }

    fn ln_density(&self, logs: [f64; 2], cv: f64, wear: f64) -> f64 {
        let (m, spread) = (libm::exp(-logs[0]), libm::exp(logs[1]));
        let s = cv * m;
        let grown = 1.0 + spread * wear * s * s;
        let miss = wear * m - 1.0;
        let after = (1.0 / cv + spread * s) / libm::sqrt(grown);
        0.5 * (logs[1]
            - LN_2_PI
            - 3.0 * libm::log(wear)
            - libm::log(grown)
            - spread * miss * miss / (wear * grown))
            + ln_above_zero(after)
            - ln_above_zero(1.0 / cv)
    }

    fn tails(&self, logs: [f64; 2], cv: f64, exposure: f64, wear: f64) -> (f64, f64) {
        if wear <= 0.0 {
            return (0.0, 1.0);
        }
        if cv * UNCUT > 1.0 {
            return Self::cut(logs, cv, exposure, wear);
        }
        let [z, y] = uncut(logs, cv, exposure, wear);
        reflected_normal(z, y)
    }

    /// So few survive only at large 1 / drift, far from the cut, which leaves its mark on the whole alone.
    fn ln_survival(&self, logs: [f64; 2], cv: f64, exposure: f64, left: f64) -> f64 {
        let [z, y] = uncut(logs, cv, exposure, left);
        ln_reflected_normal(z, y) - ln_above_zero(1.0 / cv)
    }

    fn after(&self, logs: [f64; 2], cv: f64, exposure: f64, wear: f64) -> Option<([f64; 2], f64)> {
        let (m, spread) = (libm::exp(-logs[0]), libm::exp(logs[1]));
        let s = cv * m;
        let grown = 1.0 + spread * wear * s * s;
        let mean = (m + spread * exposure * s * s) / grown;
        Some(([-libm::log(mean), logs[1]], s / (mean * libm::sqrt(grown))))
    }

    /// Places are 1 / drift beside its mean, in standard deviations.
    fn place(&self, logs: [f64; 2], cv: f64, place: f64) -> Option<([f64; 2], f64)> {
        let factor = 1.0 + cv * place;
        let ln = -0.5 * (place * place + LN_2_PI) - ln_above_zero(1.0 / cv);
        Some(if factor > 0.0 {
            ([logs[0] - libm::log(factor), logs[1]], ln)
        } else {
            (logs, f64::NEG_INFINITY)
        })
    }

    fn place_of(&self, logs: [f64; 2], cv: f64, own: [f64; 2]) -> f64 {
        libm::expm1(logs[0] - own[0]) / cv
    }

    /// The score is [(a y)² - a (1 + y)] / 2, wear 1 + y of its mean, a = spread / drift; less its part along y it has the variance
    /// (a² + 3 a) / 2.
    fn excess(&self, logs: [f64; 2]) -> f64 {
        3.0 * libm::exp(logs[0] - logs[1])
    }

    /// Numbers below 0 are drawn again.
    fn draw(&self, logs: [f64; 2], cv: f64, stream: &mut Stream) -> [f64; 2] {
        loop {
            let factor = 1.0 + cv * stream.sample::<f64, _>(StandardNormal);
            if factor > 0.0 {
                return [logs[0] - libm::log(factor), logs[1]];
            }
        }
    }
}
