//! Standard normal law, and seeded draws for bands, particles and tests. In: probabilities, seeds. Out: numbers. Never
//! knows what is drawn.

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

/// A sequence of uniform, normal and Gamma numbers that its seed decides, the same on every machine.
pub struct Draws(ChaCha8Rng);

impl Draws {
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

    /// ln of a Gamma variate of rate 1, by Marsaglia & Tsang, ACM Trans. Math. Softw. 26 (2000) 363-372; shapes below 1
    /// by ln G(a) = ln G(a + 1) + ln(U) / a, which cannot underflow.
    pub fn ln_gamma(&mut self, shape: f64) -> f64 {
        if shape < 1.0 {
            return self.ln_gamma(shape + 1.0) + self.uniform().ln() / shape;
        }
        let d = shape - 1.0 / 3.0;
        let c = 1.0 / (9.0 * d).sqrt();
        loop {
            let z = self.normal();
            let v = (1.0 + c * z).powi(3);
            if v > 0.0 && self.uniform().ln() < 0.5 * z * z + d * (1.0 - v + v.ln()) {
                return d.ln() + v.ln();
            }
        }
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

    #[test]
    fn gamma_draws_have_their_distribution() {
        for shape in [0.05, 1.0, 40.0] {
            let mut draws = Draws::new(1);
            let count = 20_000;
            let mut seen: Vec<f64> = (0..count).map(|_| draws.ln_gamma(shape)).collect();
            seen.sort_by(f64::total_cmp);
            // ln P for the small ones would underflow as P: those below e^-700 count as their probability 0.
            let miss = |(at, ln): (usize, &f64)| {
                let p = crate::special::gamma_p(shape, ln.exp());
                (p - (at as f64 + 0.5) / f64::from(count)).abs()
            };
            let distance = seen.iter().enumerate().map(miss).fold(0.0, f64::max);
            // Kolmogorov-Smirnov at 1e-3: 1.95 / sqrt(n).
            assert!(distance < 1.95 / f64::from(count).sqrt(), "{shape}: {distance}");
        }
    }
}
