//! The law of a Gamma number over another of mean 1, and with it those of beta and of F. In and out: numbers. Never knows wear.

use super::ln_gamma::{ln_gamma, stirling_rest};

/// From here on Stirling's series has all digits with the terms it has here.
const LARGE: f64 = 20.0;
/// Steps after which the fraction ends in any case; it takes about 3 sqrt(largest shape) of them.
const MOST_STEPS: u32 = 1_000_000;
/// Size of a step that no longer counts, and of a number that stands for 0.
const NEGLIGIBLE: f64 = 1.1e-16;
const TINY: f64 = 1e-300;

/// ln Gamma(base + shape) - ln Gamma(base) - shape ln base, which goes to 0 for large bases, without the difference of large numbers.
pub fn ln_rising(base: f64, shape: f64) -> f64 {
    if base < LARGE {
        return ln_gamma(base + shape) - ln_gamma(base) - shape * libm::log(base);
    }
    (base + shape - 0.5) * libm::log1p(shape / base) - shape + stirling_rest(base + shape)
        - stirling_rest(base)
}

/// Probabilities that a Gamma number of shape `shape` (rate 1), over an independent one of shape `base` and mean 1, is at most `ratio`,
/// and above it; each has its digits where it is small. For large bases the law is that of the Gamma number alone.
pub fn gamma_ratio(shape: f64, base: f64, ratio: f64) -> (f64, f64) {
    if ratio <= 0.0 {
        return (0.0, 1.0);
    }
    let (x, rest) = (ratio / (base + ratio), base / (base + ratio));
    let front = libm::exp(ln_front(shape, base, ratio));
    if is_low(shape, base, x) {
        let below = (front * fraction(shape, base, x) / shape).min(1.0);
        (below, 1.0 - below)
    } else {
        let above = (front * fraction(base, shape, rest) / base).min(1.0);
        (1.0 - above, above)
    }
}

/// x^a (1 - x)^b / B(a, b) of the beta law, x = ratio / (base + ratio), in logarithms.
fn ln_front(shape: f64, base: f64, ratio: f64) -> f64 {
    shape * libm::log(ratio) - ln_gamma(shape) + ln_rising(base, shape)
        - (shape + base) * libm::log1p(ratio / base)
}

/// Whether x is where the fraction of the lower tail ends soon.
fn is_low(shape: f64, base: f64, x: f64) -> bool {
    x < (shape + 1.0) / (shape + base + 2.0)
}

/// ln of the first of both, also where it is too small for a number.
pub fn ln_gamma_ratio_below(shape: f64, base: f64, ratio: f64) -> f64 {
    let x = ratio / (base + ratio);
    if ratio <= 0.0 || !is_low(shape, base, x) {
        return libm::log(gamma_ratio(shape, base, ratio).0);
    }
    ln_front(shape, base, ratio) + libm::log(fraction(shape, base, x) / shape)
}

/// Probability that a number of Fisher's law with so many degrees of freedom is above `f`.
pub fn f_above(numerator: f64, denominator: f64, f: f64) -> f64 {
    gamma_ratio(0.5 * numerator, 0.5 * denominator, 0.5 * numerator * f).1
}

/// The continued fraction of the incomplete beta function (DLMF 8.17.22) by the method of W. J. Lentz (1976).
fn fraction(a: f64, b: f64, x: f64) -> f64 {
    let away = |value: f64| if value.abs() < TINY { TINY } else { value };
    let mut c = 1.0;
    let mut d = 1.0 / away(1.0 - (a + b) * x / (a + 1.0));
    let mut sum = d;
    for step in 1..MOST_STEPS {
        let m = f64::from(step);
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        let mut change = 1.0;
        for term in [even, odd] {
            d = 1.0 / away(1.0 + term * d);
            c = away(1.0 + term / c);
            change *= c * d;
        }
        sum *= change;
        if (change - 1.0).abs() <= 2.0 * NEGLIGIBLE {
            break;
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::special::{gamma_p, gamma_q, student_bound};

    fn close(found: f64, expected: f64, tolerance: f64) {
        assert!((found / expected - 1.0).abs() < tolerance, "{found} for {expected}");
    }

    #[test]
    fn rising_powers_of_whole_numbers_are_products() {
        for (base, shape) in [(3.0, 2_u32), (19.5, 4), (20.5, 4), (4000.0, 3), (1e9, 2)] {
            let product: f64 = (0..shape).map(|k| f64::ln_1p(f64::from(k) / base)).sum();
            let found = ln_rising(base, f64::from(shape));
            // Rounding of numbers of the size of the shape, and of ln Gamma below LARGE.
            assert!((found - product).abs() < 1e-13, "{base} {shape}: {found} {product}");
        }
    }

    #[test]
    fn tails_are_those_of_closed_forms() {
        // Shape 1: 1 - (1 + r/b)^-b.
        for (base, ratio) in [(2.0, 0.3), (2.0, 40.0), (500.0, 3.0)] {
            let above = f64::powf(1.0 + ratio / base, -base);
            close(gamma_ratio(1.0, base, ratio).1, above, 1e-12);
            close(gamma_ratio(1.0, base, ratio).0, 1.0 - above, 1e-12);
        }
        // Base 1e10: the Gamma law but for shape² / base.
        for (shape, x) in [(0.3, 1.0), (5.0, 2.0), (300.0, 340.0)] {
            let (below, above) = gamma_ratio(shape, 1e10, x);
            close(below, gamma_p(shape, x), 1e-5);
            close(above, gamma_q(shape, x), 1e-5);
        }
    }

    #[test]
    fn the_law_of_f_is_that_of_the_square_of_students() {
        for degrees in [1_usize, 4, 15, 999] {
            let t = student_bound(degrees, 0.95);
            close(f_above(1.0, degrees as f64, t * t), 0.05, 1e-10);
        }
        // Tables: F(4, 45) at 5 %: 2.578739, which numerical integration of the density confirms to 2e-8.
        close(f_above(4.0, 45.0, 2.578_739), 0.05, 1e-5);
    }
}
