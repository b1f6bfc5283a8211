//! How the incomplete gamma function changes with its shape. In and out: numbers. Never knows wear.

use super::incomplete::{Uniform, ln_gamma_q};
use super::polygamma::digamma;

/// Failed part below which the series cancels too much.
const FEW: f64 = 1e-5;
/// Step of the difference in the shape, as a part of it: error 1e-9 by curvature and by rounding.
const STEP: f64 = 1e-5;
/// Shapes below this are as good as none: Q is linear there.
const NO_SHAPE: f64 = 1e-8;

/// -d ln P(shape, x) / d shape, P the lower regularised incomplete gamma function; `shape` >= 0, `x` > 0.
///
/// P(a, x) = sum over n >= 0 of t_n, t_n = x^(a+n) e^-x / Gamma(a+n+1), and d t_n / da = t_n (ln x - psi(a+n+1)). The
/// answer is the mean of psi(a+n+1) - ln x under weights t_n. Terms are taken relative to the largest, from which the
/// sum goes both ways: nothing underflows however small P is. Where P is near 1 the differences cancel: there the change of
/// ln Q, by a central difference, keeps the digits. Relative accuracy 1e-8.
pub fn ln_gamma_p_slope(shape: f64, x: f64) -> f64 {
    if let Some(expansion) = Uniform::for_slope(shape, x, libm::log(x)) {
        return expansion.slope();
    }
    let floored = shape.max(NO_SHAPE);
    let ln_failed = ln_gamma_q(floored, x);
    if ln_failed < libm::log(FEW) {
        let step = STEP * floored;
        let change = (ln_gamma_q(floored + step, x) - ln_gamma_q(floored - step, x)) / (2.0 * step);
        return change * libm::exp(ln_failed) / -libm::expm1(ln_failed);
    }
    let peak = (x - shape).floor().max(0.0);
    let (ln_x, mut total, mut sum) = (libm::log(x), 0.0, 0.0);
    // Upwards from the peak.
    let mut order = shape + peak + 1.0;
    let (mut weight, mut psi) = (1.0, digamma(order));
    while weight > 1e-18 * total {
        total += weight;
        sum += weight * (psi - ln_x);
        psi += 1.0 / order;
        weight *= x / order;
        order += 1.0;
    }
    // Downwards.
    let mut order = shape + peak;
    let (mut weight, mut psi) = (1.0, digamma(order + 1.0));
    for _ in 0..peak as u64 {
        weight *= order / x;
        psi -= 1.0 / order;
        if weight < 1e-18 * total {
            break;
        }
        total += weight;
        sum += weight * (psi - ln_x);
        order -= 1.0;
    }
    (sum / total).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::special::gamma_p;

    #[test]
    fn the_slope_is_the_derivative_of_the_logarithm() {
        for (shape, x) in [(0.3, 0.7), (5.0, 3.0), (3.0, 9.0), (64.0, 70.0), (300.0, 120.0), (1000.0, 1090.0)]
        {
            let step = 1e-5 * shape;
            let difference = (gamma_p(shape - step, x).ln() - gamma_p(shape + step, x).ln()) / (2.0 * step);
            let exact = ln_gamma_p_slope(shape, x);
            // Central difference: curvature times step², below 1e-7, and rounding 1e-13 / step.
            assert!((difference - exact).abs() < 1e-6 * (exact + 1e-3), "{shape} {x}: {difference} {exact}");
        }
    }

    #[test]
    fn at_large_shapes_the_slope_is_the_difference_of_the_uniform_expansion() {
        for shape in [2e6_f64, 1e9, 1e12] {
            for z in [-8.0, -1.0, 0.0, 0.5, 4.0] {
                let x = shape + z * shape.sqrt();
                let step = 1e-3 * shape.sqrt();
                let ln_p = |a: f64| crate::special::ln_gamma_p(a, x);
                let difference = (ln_p(shape - step) - ln_p(shape + step)) / (2.0 * step);
                let exact = ln_gamma_p_slope(shape, x);
                // Central difference of a thousandth of a deviation; shape itself is rounded by up to 1e-10 of one.
                assert!((difference / exact - 1.0).abs() < 1e-5, "{shape} {z}: {difference} {exact}");
            }
        }
    }

    #[test]
    fn shape_zero_gives_the_exponential_integral() {
        // The least shape stands for 0: 1e-8 of it.
        // d P / da at a = 0 is -E1(x); E1(1) = 0.219383934395520 (Abramowitz & Stegun, table 5.1).
        assert!((ln_gamma_p_slope(0.0, 1.0) - 0.219_383_934_395_520).abs() < 1e-7);
    }

    #[test]
    fn hazard_of_the_rarest_failures_keeps_its_digits() {
        // At shape 0 the derivative of Q(a, x) is E1(x): E1(20) = 9.835525290649882e-11 (Abramowitz & Stegun, table 5.2).
        assert!((ln_gamma_p_slope(0.0, 20.0) / 9.835_525_290_649_88e-11 - 1.0).abs() < 1e-6);
        // Both ways agree where they meet.
        for shape in [3.0, 3.2, 3.4, 3.6] {
            let (step, x) = (1e-4, 18.0);
            let q = |a: f64| crate::special::gamma_q(a, x);
            let difference = (q(shape + step) - q(shape - step)) / (2.0 * step) / (1.0 - q(shape));
            // Central difference, curvature 1e-8.
            assert!((ln_gamma_p_slope(shape, x) / difference - 1.0).abs() < 1e-6, "{shape}");
        }
    }
}
