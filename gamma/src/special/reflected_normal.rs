//! What first passages of normal paths are made of. In and out: numbers. Never knows wear.

use super::normal::{normal_cdf, normal_density, normal_mills};

/// Phi(z) + phi(z) Mills(y), y >= |z|, and 1 minus it; each has its digits where it is small. phi(z) Mills(y) is
/// exp([y² - z²] / 2) Phi(-y), which would overflow.
pub fn reflected_normal(z: f64, y: f64) -> (f64, f64) {
    let (density, far) = (normal_density(z), normal_mills(y));
    let above = if z > 0.0 { density * (normal_mills(z) - far) } else { normal_cdf(-z) - density * far };
    (normal_cdf(z) + density * far, above)
}
