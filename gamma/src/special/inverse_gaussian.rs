//! The inverse Gaussian law. In and out: numbers. Never knows wear.

use super::reflected_normal::reflected_normal;

/// Probabilities that an inverse Gaussian number of this mean and shape is at most x, and above x; each has its digits
/// where it is small.
///
/// J. Shuster, J. Am. Stat. Assoc. 63 (1968) 1514: P(X <= x) = Phi(z) + exp(2 shape / mean) Phi(-y), with
/// z, y = sqrt(shape / x) (x / mean -+ 1). Because y² - z² = 4 shape / mean, the second part is phi(z) times Mills' ratio at
/// y, which does not overflow.
pub fn inverse_gaussian(mean: f64, shape: f64, x: f64) -> (f64, f64) {
    if x <= 0.0 {
        return (0.0, 1.0);
    }
    let root = libm::sqrt(shape / x);
    let (z, y) = (root * (x / mean - 1.0), root * (x / mean + 1.0));
    reflected_normal(z, y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::special::normal_mills;

    #[test]
    fn both_tails_are_those_of_the_density() {
        // Midpoint sums of the density sqrt(l / (2 pi x³)) exp(-l (x - m)² / (2 m² x)) over ln x.
        for (mean, shape) in [(1.0, 0.3), (2.0, 8.0), (0.5, 400.0)] {
            let density = |x: f64| {
                let square = shape * (x - mean) * (x - mean) / (2.0 * mean * mean * x);
                (shape / (2.0 * std::f64::consts::PI * x * x * x)).sqrt() * (-square).exp()
            };
            let step = 1e-3;
            for x in [0.6 * mean, mean, 1.3 * mean] {
                let at = |k: i32| x * (step * (f64::from(k) + 0.5)).exp();
                let sum = |range: std::ops::Range<i32>| -> f64 {
                    range.map(|k| step * at(k) * density(at(k))).sum()
                };
                let (below, above) = inverse_gaussian(mean, shape, x);
                // The midpoint rule is good to step² / 24 of the change of the integrand: 1e-6.
                assert!((sum(-12_000..0) - below).abs() < 1e-6, "{mean} {shape} {x}: {below}");
                assert!((sum(0..12_000) - above).abs() < 1e-6, "{mean} {shape} {x}: {above}");
            }
        }
    }

    #[test]
    fn far_tails_keep_their_digits() {
        // mpmath 1.3.0 at 60 digits: mean, shape, x, and the smaller of the two. exp(2 shape / mean) overflows in two of them.
        let close = |found: f64, expected: f64| (found / expected - 1.0).abs() < 1e-12;
        assert!(close(inverse_gaussian(1.0, 1000.0, 1.4).1, 4.693_084_639_394_9e-27));
        assert!(close(inverse_gaussian(1.0, 2000.0, 0.75).0, 2.262_133_067_909_7e-38));
        assert!(close(inverse_gaussian(2.0, 8.0, 1.5).0, 0.361_027_585_150_322_7));
        // Mills' ratio where both its forms hold, and its asymptote.
        assert!((normal_mills(24.999_999) / normal_mills(25.000_001) - 1.0).abs() < 1e-7);
        assert!((normal_mills(1e4) * 1e4 - 1.0).abs() < 1.1e-8);
    }
}
