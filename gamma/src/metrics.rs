//! How good predictions of remaining life were, once the truth is known. In: predictive laws or samples, true lives.
//! Out: scores. Never knows how predictions were made.
//!
//! Sources: continuous ranked probability score: Gneiting & Raftery, J. Am. Stat. Assoc. 102 (2007) 359-378; its form for
//! the Gamma law: Scheuerer & Möller, Ann. Appl. Stat. 9 (2015) 1328-1349.

use crate::error::LifeError;
use crate::life::Lifetime;
use crate::quadrature::integrate;
use crate::special::{gamma_p, ln_gamma, normal_cdf, normal_density};

/// CRPS of a sample: mean |X - y| - half the mean |X - X'|, over the empirical law. Same unit as the life; 0 is best.
/// None for an empty sample.
pub fn crps_sample(sample: &[f64], truth: f64) -> Option<f64> {
    if sample.is_empty() {
        return None;
    }
    let mut sorted = sample.to_vec();
    sorted.sort_by(f64::total_cmp);
    let count = sorted.len() as f64;
    let distance = sorted.iter().map(|x| (x - truth).abs()).sum::<f64>() / count;
    // Sum over pairs of |X_i - X_j| from ranks: each value counts once for every rank it exceeds.
    let ranked = sorted.iter().enumerate().map(|(at, x)| (2.0 * at as f64 + 1.0 - count) * x).sum::<f64>();
    Some(distance - ranked / (count * count))
}

/// CRPS of a normal law.
pub fn crps_normal(mean: f64, std: f64, truth: f64) -> f64 {
    let z = (truth - mean) / std;
    let pi = std::f64::consts::PI;
    std * (z * (2.0 * normal_cdf(z) - 1.0) + 2.0 * normal_density(z) - 1.0 / libm::sqrt(pi))
}

/// CRPS of a Gamma law of given shape and rate, for wear increments: `truth` in the unit of 1 / `rate`.
pub fn crps_gamma(shape: f64, rate: f64, truth: f64) -> f64 {
    let x = rate * truth;
    // 1 / B(1/2, shape).
    let beta = libm::exp(ln_gamma(shape + 0.5) - ln_gamma(shape)) / libm::sqrt(std::f64::consts::PI);
    (x * (2.0 * gamma_p(shape, x) - 1.0) - shape * (2.0 * gamma_p(shape + 1.0, x) - 1.0) - beta) / rate
}

/// CRPS of a law of life: integral of (F(t) - \[t >= truth\])² over time, relative accuracy 1e-9.
///
/// # Errors
/// Those of [`Lifetime::quantile`].
pub fn crps_life(life: &dyn Lifetime, truth: f64) -> Result<f64, LifeError> {
    let end = life.quantile(1.0 - 1e-12)?.max(truth);
    let median = life.quantile(0.5)?;
    let square = |t: f64| {
        let miss = if t < truth { life.failed(t) } else { life.reliability(t) };
        [miss * miss]
    };
    Ok(integrate(&square, &life.limits(end, &[median, truth]), [1e-11 * median]).0[0])
}

/// How often intervals held the truth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coverage {
    /// Intervals that held it.
    pub held: usize,
    /// Intervals.
    pub count: usize,
    /// Share that held it.
    pub part: f64,
    /// Ends of its 95 % interval by Wilson's score (Wilson 1927).
    pub interval: (f64, f64),
}

/// Coverage of (lower, upper, truth); an end counts as inside. None without intervals.
pub fn coverage(intervals: &[(f64, f64, f64)]) -> Option<Coverage> {
    const Z: f64 = 1.959_963_984_540_054;
    let held = intervals.iter().filter(|(lower, upper, truth)| lower <= truth && truth <= upper).count();
    if intervals.is_empty() {
        return None;
    }
    let count = intervals.len() as f64;
    let part = held as f64 / count;
    let scale = 1.0 + Z * Z / count;
    let centre = (part + Z * Z / (2.0 * count)) / scale;
    let half = Z / scale * (part * (1.0 - part) / count + Z * Z / (4.0 * count * count)).sqrt();
    Some(Coverage { held, count: intervals.len(), part, interval: (centre - half, centre + half) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{StandardNormal, Stream};
    use rand::RngExt;

    /// Gamma law as a life: what `crps_gamma` is compared with.
    struct GammaLife(f64, f64);

    impl Lifetime for GammaLife {
        fn reliability(&self, t: f64) -> f64 {
            crate::special::gamma_q(self.0, self.1 * t)
        }
        fn failed(&self, t: f64) -> f64 {
            gamma_p(self.0, self.1 * t)
        }
        fn typical(&self) -> f64 {
            self.0 / self.1
        }
    }

    #[test]
    fn closed_forms_agree_with_the_integral_and_with_samples() {
        let mut draws = Stream::new(5, 0, 0);
        let sample: Vec<f64> = (0..20_000).map(|_| 10.0 + 2.0 * draws.sample(StandardNormal)).collect();
        for truth in [7.0, 10.0, 13.5] {
            for (shape, rate) in [(0.7, 0.1), (3.0, 0.5), (25.0, 2.0)] {
                let integral = crps_life(&GammaLife(shape, rate), truth).expect("proper");
                // Accuracy asked of the integral.
                assert!((crps_gamma(shape, rate, truth) - integral).abs() < 1e-8, "{shape} {truth}");
            }
            let (score, closed) = (crps_sample(&sample, truth).expect("some"), crps_normal(10.0, 2.0, truth));
            // 20,000 draws: standard error about 2/sqrt(20,000) = 0.014; three of them.
            assert!((score - closed).abs() < 0.042, "{score} {closed}");
        }
    }

    #[test]
    fn a_sample_of_one_scores_its_distance() {
        assert_eq!(crps_sample(&[3.0], 5.0), Some(2.0));
        // Two points 0 and 2, truth 1: mean distance 1, half the mean difference 0.5 (pairs 0, 2, 2, 0).
        assert_eq!(crps_sample(&[2.0, 0.0], 1.0), Some(0.5));
        assert_eq!(crps_sample(&[], 1.0), None);
    }

    #[test]
    fn coverage_of_a_known_count() {
        let all: Vec<_> = (0..100).map(|k| if k < 95 { (0.0, 1.0, 0.5) } else { (0.0, 1.0, 2.0) }).collect();
        let coverage = coverage(&all).expect("some");
        // Wilson interval of 95 of 100, from Newcombe (1998): 0.8882 to 0.9785.
        assert_eq!(coverage.held, 95);
        assert!((coverage.interval.0 - 0.8882).abs() < 1e-4 && (coverage.interval.1 - 0.9785).abs() < 1e-4);
    }
}
