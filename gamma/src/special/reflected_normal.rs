//! What first passages of normal paths are made of. In and out: numbers. Never knows wear.

use super::LN_2_PI;
use super::normal::{normal_cdf, normal_density, normal_mills};

/// Phi(z) + phi(z) Mills(y), y >= |z|, and 1 minus it; each has its digits where it is small. phi(z) Mills(y) is
/// exp([y² - z²] / 2) Phi(-y), which would overflow.
pub fn reflected_normal(z: f64, y: f64) -> (f64, f64) {
    let (density, far) = (normal_density(z), normal_mills(y));
    let above = if z > 0.0 { density * (normal_mills(z) - far) } else { normal_cdf(-z) - density * far };
    (normal_cdf(z) + density * far, above)
}

/// ln of the first of both, also where it is too small for a number.
pub fn ln_reflected_normal(z: f64, y: f64) -> f64 {
    if z > 0.0 {
        return libm::log(reflected_normal(z, y).0);
    }
    libm::log(normal_mills(-z) + normal_mills(y)) - 0.5 * (z * z + LN_2_PI)
}

/// ln of the second of both, likewise.
pub fn ln_above_reflected(z: f64, y: f64) -> f64 {
    if z <= 0.0 {
        return libm::log(reflected_normal(z, y).1);
    }
    libm::log(normal_mills(z) - normal_mills(y)) - 0.5 * (z * z + LN_2_PI)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn logarithms_are_those_of_both_parts_and_go_on_beyond_numbers() {
        for (z, y) in [(-8.0, 9.0), (-0.3, 0.4), (0.3, 2.0), (8.0, 8.5)] {
            let (first, second) = reflected_normal(z, y);
            // Rounding of a logarithm.
            assert!((ln_reflected_normal(z, y) - first.ln()).abs() < 1e-13 * (1.0 + z * z), "{z} {y}");
            assert!((ln_above_reflected(z, y) - second.ln()).abs() < 1e-13 * (1.0 + z * z), "{z} {y}");
        }
        // phi(60) [Mills(60) -+ Mills(90)], by three terms of Mills' series: 1e-10 of itself.
        let mills = |x: f64| (1.0 - 1.0 / (x * x) + 3.0 / x.powi(4)) / x;
        let density = -1800.0 - 0.5 * LN_2_PI;
        assert!((ln_reflected_normal(-60.0, 90.0) - density - (mills(60.0) + mills(90.0)).ln()).abs() < 1e-9);
        assert!((ln_above_reflected(60.0, 90.0) - density - (mills(60.0) - mills(90.0)).ln()).abs() < 1e-9);
    }
}
