//! Quantiles of the Gamma law. In: shape and probability. Out: x or ln x. Never knows what is asked for.
//!
//! ln P and ln Q are concave in ln x. So Newton's method on them converges from any start, and from one side
//! monotonically; brackets guard its first step.

use super::incomplete::ln_both;
use super::ln_gamma::{EULER, ln_gamma, ln_gamma_1p};
use super::normal::normal_quantile;
use super::root::guarded;

/// The p-quantile of Gamma(shape, 1). It underflows to 0 at small shapes: see [`ln_gamma_quantile`].
pub fn gamma_quantile(shape: f64, p: f64) -> f64 {
    libm::exp(ln_gamma_quantile(shape, p))
}

/// ln of the p-quantile of Gamma(shape, 1): minus infinity at p = 0, infinity at p = 1, NaN outside.
pub fn ln_gamma_quantile(shape: f64, p: f64) -> f64 {
    if !(0.0..=1.0).contains(&p) || shape.is_nan() || shape <= 0.0 {
        f64::NAN
    } else if p > 0.5 {
        solve_upper(shape, libm::log1p(-p))
    } else {
        solve_lower(shape, libm::log(p))
    }
}

fn solve_lower(shape: f64, target: f64) -> f64 {
    if target == f64::NEG_INFINITY {
        return target;
    }
    // P <= x^shape / Gamma(shape + 1), so this is never above the root.
    let low = (target + ln_gamma_1p(shape)) / shape;
    let start = wilson_hilferty(shape, normal_quantile(libm::exp(target))).unwrap_or(low);
    newton(shape, target, start, |pair| pair.0, 1.0)
}

fn solve_upper(shape: f64, target: f64) -> f64 {
    if target == f64::NEG_INFINITY {
        return f64::INFINITY;
    }
    let q = libm::exp(target);
    let start = wilson_hilferty(shape, -normal_quantile(q)).unwrap_or_else(|| {
        // Tiny shapes: Q = -shape (ln x + gamma) while x is small, shape E1(x) beyond.
        let by_log = -q / shape - EULER;
        if by_log < -1.0 { by_log } else { libm::log((libm::log(shape) - target).max(0.3)) }
    });
    newton(shape, target, start, |pair| pair.1, -1.0)
}

/// E. B. Wilson, M. M. Hilferty (1931): ln x from the normal quantile z, none where the cube is not positive.
fn wilson_hilferty(shape: f64, z: f64) -> Option<f64> {
    if shape < 1.0 {
        return None;
    }
    let ninth = 1.0 / (9.0 * shape);
    let root = 1.0 - ninth + z * libm::sqrt(ninth);
    (root > 0.1).then(|| libm::log(shape) + 3.0 * libm::log(root))
}

/// Newton on ln P (slope +) or ln Q (slope -) over y = ln x.
fn newton(shape: f64, target: f64, start: f64, side: impl Fn((f64, f64)) -> f64, slope: f64) -> f64 {
    let ln_gamma = ln_gamma(shape);
    let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
    let mut y = start;
    for _ in 0..200 {
        let x = libm::exp(y);
        let value = side(ln_both(shape, x, y));
        let miss = value - target;
        if miss * slope > 0.0 {
            high = y
        } else {
            low = y
        }
        let rate = slope * libm::exp(shape * y - x - ln_gamma - value);
        let next = guarded(y - miss / rate, y, (low, high));
        if (next - y).abs() <= 2e-16 * y.abs().max(1.0) {
            return next;
        }
        y = next;
    }
    y
}
