//! The standard normal law. In and out: numbers. Never knows wear.

use core::f64::consts::{FRAC_1_SQRT_2, PI};

/// ln (2 pi).
pub const LN_2_PI: f64 = 1.837_877_066_409_345_5;

/// Density of the standard normal law.
pub fn normal_density(z: f64) -> f64 {
    libm::exp(-0.5 * z * z) / libm::sqrt(2.0 * PI)
}

/// Probability that a standard normal number is at most z.
pub fn normal_cdf(z: f64) -> f64 {
    0.5 * libm::erfc(-z * FRAC_1_SQRT_2)
}

/// Mills' ratio at z: the probability of a standard normal number above z over the density there; infinite far below 0.
pub fn normal_mills(z: f64) -> f64 {
    /// From here on the continued fraction of P. S. Laplace has all digits after so many steps.
    const FAR: f64 = 25.0;
    const STEPS: u32 = 20;
    if z < FAR {
        return normal_cdf(-z) / normal_density(z);
    }
    1.0 / (1..=STEPS).rev().fold(z, |rest, n| z + f64::from(n) / rest)
}

/// The p-quantile of the standard normal law: infinite at 0 and 1, NaN outside.
pub fn normal_quantile(p: f64) -> f64 {
    if !(0.0..=1.0).contains(&p) {
        return f64::NAN;
    }
    if p == 0.0 || p == 1.0 {
        return if p == 0.0 { f64::NEG_INFINITY } else { f64::INFINITY };
    }
    // On the lower side always, where p has all its digits; 1 - p is exact for p >= 0.5.
    let (low, sign) = if p > 0.5 { (1.0 - p, -1.0) } else { (p, 1.0) };
    // Abramowitz and Stegun 26.2.23, good to 4.5e-4, then Newton on ln of the cdf, which is concave.
    let t = libm::sqrt(-2.0 * libm::log(low));
    let mut z = -(t
        - (2.515_517 + t * (0.802_853 + t * 0.010_328))
            / (1.0 + t * (1.432_788 + t * (0.189_269 + t * 0.001_308))));
    for _ in 0..4 {
        let cdf = normal_cdf(z);
        z -= cdf / normal_density(z) * libm::log(cdf / low);
    }
    sign * z
}
