//! Standard normal law and seeded draws from it. In: probabilities, seeds. Out: numbers. Never knows what is drawn.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use statrs::function::erf::{erfc, erfc_inv};

/// Phi(z).
pub fn standard_normal_cdf(z: f64) -> f64 {
    0.5 * erfc(-z * std::f64::consts::FRAC_1_SQRT_2)
}

/// phi(z).
pub fn standard_normal_density(z: f64) -> f64 {
    (-0.5 * z * z).exp() / (2.0 * std::f64::consts::PI).sqrt()
}

/// Inverse of Phi, 0 < `p` < 1.
pub fn standard_normal_quantile(p: f64) -> f64 {
    -std::f64::consts::SQRT_2 * erfc_inv(2.0 * p)
}

/// A sequence of uniform and normal numbers that its seed decides, the same on every machine.
pub struct Normals(ChaCha8Rng);

impl Normals {
    pub fn new(seed: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed))
    }

    /// Uniform in (0, 1), both ends excluded: the middle of one of 2^52 cells.
    pub fn uniform(&mut self) -> f64 {
        ((self.0.next_u64() >> 12) as f64 + 0.5) / (1u64 << 52) as f64
    }

    /// Standard normal, by the inverse of its distribution.
    pub fn normal(&mut self) -> f64 {
        standard_normal_quantile(self.uniform())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantile_and_distribution_are_inverse() {
        // Phi^-1(0.975), Abramowitz & Stegun table 26.5; statrs' inverse is good to 1e-10 or better.
        assert!((standard_normal_quantile(0.975) - 1.959_963_984_540_054).abs() < 1e-9);
        for p in [1e-12, 0.1, 0.5, 0.999] {
            assert!((standard_normal_cdf(standard_normal_quantile(p)) / p - 1.0).abs() < 1e-8, "{p}");
        }
    }
}
