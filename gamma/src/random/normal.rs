//! The standard normal law. Out: draws. Never knows the generator.

use rand::distr::{Distribution, Open01};
use rand::{Rng, RngExt};

/// Standard normal numbers by G. E. P. Box and M. E. Muller (1958), each from two uniform ones.
#[derive(Clone, Copy, Debug)]
pub struct StandardNormal;

impl Distribution<f64> for StandardNormal {
    fn sample<R: Rng + ?Sized>(&self, rng: &mut R) -> f64 {
        let radius = libm::sqrt(-2.0 * libm::log(rng.sample(Open01)));
        let turn: f64 = rng.sample(Open01);
        radius * libm::cos(2.0 * core::f64::consts::PI * turn)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Stream;

    #[test]
    fn moments_are_those_of_the_normal_law() {
        let mut stream = Stream::new(2, 0, 0);
        let n = 100_000;
        let draws: Vec<f64> = (0..n).map(|_| stream.sample(StandardNormal)).collect();
        let moment = |k: i32| draws.iter().map(|z| z.powi(k)).sum::<f64>() / f64::from(n);
        // Four standard errors: variances of z, z^2, z^4 are 1, 2, 96.
        let error = |variance: f64| 4.0 * (variance / f64::from(n)).sqrt();
        assert!(moment(1).abs() < error(1.0));
        assert!((moment(2) - 1.0).abs() < error(2.0));
        assert!((moment(4) - 3.0).abs() < error(96.0));
    }
}
