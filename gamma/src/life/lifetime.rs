//! What every law of life can tell from its reliability function: quantiles, moments, whole cycles, hazard.
//! In: reliability over time from the present. Out: numbers in the unit of that time. Never knows wear.

use crate::error::{LifeError, probability};
use crate::quadrature::integrate;
use crate::special::rising_root;

/// Survivors that are no longer counted, as a part of the accuracy asked for.
const GONE: f64 = 1e-5;
/// Whole cycles that are summed one by one; longer lives take the sum as an integral.
const SUMMED: f64 = 2000.0;

/// Mean and standard deviation of a life.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moments {
    /// Mean [unit of time].
    pub mean: f64,
    /// Standard deviation [unit of time].
    pub std: f64,
    /// Estimate of the quadrature error of the mean [unit of time].
    pub error: f64,
}

impl Moments {
    /// Coefficient of variation std / mean.
    pub fn cov(&self) -> f64 {
        self.std / self.mean
    }
}

/// A distribution of the time that is left.
pub trait Lifetime {
    /// Probability of no failure until `t` from now; 1 for `t` <= 0, not rising, to 0 for long times.
    fn reliability(&self, t: f64) -> f64;

    /// A positive time of the order of the life, from which searches start.
    fn typical(&self) -> f64;

    /// Probability of failure until `t`. Overridden where it can be had without the loss of digits in 1 - S.
    fn failed(&self, t: f64) -> f64 {
        1.0 - self.reliability(t)
    }

    /// Relative accuracy asked of integrals. Mixtures of many laws ask for less: each value costs them more, and they are
    /// no more accurate themselves.
    fn accuracy(&self) -> f64 {
        1e-11
    }

    /// Times where the reliability has kinks.
    fn breaks(&self) -> Vec<f64> {
        Vec::new()
    }

    /// Limits of integrals from the present to `end`, which end a piece where the reliability has kinks and at the times
    /// `more`.
    fn limits(&self, end: f64, more: &[f64]) -> Vec<f64> {
        let mut limits = vec![0.0, end];
        limits.extend(self.breaks().into_iter().filter(|t| *t > 0.0 && *t < end));
        limits.extend(more);
        limits.sort_by(f64::total_cmp);
        limits.dedup();
        limits
    }

    /// Whether mean and standard deviation are finite.
    ///
    /// # Errors
    /// [`LifeError::HeavyTail`].
    fn finite_moments(&self) -> Result<(), LifeError> {
        Ok(())
    }

    /// Failures per unit of time among the survivors at `t`: -d ln S/dt, by central difference unless overridden.
    fn hazard(&self, t: f64) -> f64 {
        let step = 1e-5 * self.typical();
        let (before, after) = ((t - step).max(0.0), t + step);
        libm::log(self.reliability(before) / self.reliability(after)) / (after - before)
    }

    /// Probability density of the life at `t` [1/unit of time].
    fn density(&self, t: f64) -> f64 {
        self.hazard(t) * self.reliability(t)
    }

    /// Time until which the part `p` has failed: B10 is `quantile(0.1)`. Relative accuracy 1e-12.
    ///
    /// # Errors
    /// [`LifeError::Probability`].
    fn quantile(&self, p: f64) -> Result<f64, LifeError> {
        probability(p)?;
        // The smaller of the two tails keeps its digits.
        let miss = |t: f64| if p <= 0.5 { self.failed(t) - p } else { (1.0 - p) - self.reliability(t) };
        Ok(rising_root(&miss, self.typical()))
    }

    /// Mean and standard deviation, time as it runs, by integrals of failed part and survivors; relative accuracy ten times
    /// [`Self::accuracy`].
    ///
    /// # Errors
    /// [`LifeError::HeavyTail`].
    fn moments(&self) -> Result<Moments, LifeError> {
        self.finite_moments()?;
        let scale = self.typical();
        let end = end(&|t| self.reliability(t), scale, GONE * self.accuracy());
        // From the median both ways, the failed part below it and the survivors above: nothing is a small difference.
        let centre = self.quantile(0.5)?;
        let integrand = |t: f64| {
            let part = if t < centre { -self.failed(t) } else { self.reliability(t) };
            [part, 2.0 * (t - centre) * part]
        };
        let tolerance = [self.accuracy() * centre, self.accuracy() * centre * centre];
        let (sums, errors) = integrate(&integrand, &self.limits(end, &[scale, centre]), tolerance);
        let variance = (sums[1] - sums[0] * sums[0]).max(0.0);
        Ok(Moments { mean: centre + sums[0], std: variance.sqrt(), error: errors[0] })
    }

    /// Mean and standard deviation of the number of whole cycles, a cycle being one unit of time: the cycle in which
    /// the threshold is passed counts in full, so the mean is about half a cycle above that of [`Self::moments`].
    /// E N = sum of S(n), n >= 0; above 2000 cycles E N = E T + 1/2 and var N = var T + 1/12, good to 1e-3 cycle.
    ///
    /// # Errors
    /// [`LifeError::HeavyTail`].
    fn whole_cycles(&self) -> Result<Moments, LifeError> {
        self.finite_moments()?;
        let gone = GONE * self.accuracy();
        if end(&|t| self.reliability(t), self.typical(), gone) > SUMMED {
            let moments = self.moments()?;
            let std = (moments.std * moments.std + 1.0 / 12.0).sqrt();
            return Ok(Moments { mean: moments.mean + 0.5, std, error: moments.error + 1e-3 });
        }
        let (mut mean, mut square, mut n) = (0.0, 0.0, 0.0);
        loop {
            let alive = self.reliability(n);
            mean += alive;
            square += (2.0 * n + 1.0) * alive;
            n += 1.0;
            if alive * n < gone {
                break;
            }
        }
        Ok(Moments { mean, std: (square - mean * mean).max(0.0).sqrt(), error: gone })
    }
}

/// Hazard of a mixture, from the part of each law that is alive and its hazard.
pub(crate) fn mixed_hazard(laws: impl Iterator<Item = (f64, f64)>) -> f64 {
    let (mut density, mut alive) = (0.0, 0.0);
    for (here, hazard) in laws {
        density += here * hazard;
        alive += here;
    }
    density / alive
}

/// A time after which nothing counts, neither for the mean nor for the variance.
fn end(reliability: &dyn Fn(f64) -> f64, scale: f64, gone: f64) -> f64 {
    let mut end = scale;
    while reliability(end) * (end / scale) * (end / scale) > gone && end < 1e12 * scale {
        end *= 1.5;
    }
    end
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Weibull law: closed forms for everything.
    struct Weibull {
        scale: f64,
        shape: f64,
    }

    impl Lifetime for Weibull {
        fn reliability(&self, t: f64) -> f64 {
            (-(t.max(0.0) / self.scale).powf(self.shape)).exp()
        }
        fn typical(&self) -> f64 {
            self.scale
        }
    }

    #[test]
    fn moments_and_quantiles_of_a_known_law() {
        for (scale, shape) in [(3.0, 1.0), (0.01, 2.5), (20.0, 20.0)] {
            let law = Weibull { scale, shape };
            let gamma = |x: f64| crate::special::ln_gamma(x).exp();
            let mean = scale * gamma(1.0 + 1.0 / shape);
            let std = (scale * scale * gamma(1.0 + 2.0 / shape) - mean * mean).sqrt();
            let moments = law.moments().expect("finite");
            // The accuracy asked of the integrals, times ten for the differences in the variance.
            assert!((moments.mean / mean - 1.0).abs() < 1e-10, "{shape} {} {mean}", moments.mean);
            assert!((moments.std / std - 1.0).abs() < 1e-8, "{shape} {} {std}", moments.std);
            for p in [1e-6, 0.1, 0.5, 0.9, 1.0 - 1e-9] {
                let expected = scale * (-f64::ln_1p(-p)).powf(1.0 / shape);
                // 1 - S of this test law loses digits at p = 1e-6.
                assert!((law.quantile(p).expect("valid") / expected - 1.0).abs() < 1e-9, "{shape} {p}");
            }
            // Central difference with a step of 1e-5.
            let hazard = shape / scale;
            assert!((law.hazard(scale) / hazard - 1.0).abs() < 1e-7);
        }
    }

    #[test]
    fn whole_cycles_of_an_exponential_law_are_geometric() {
        let law = Weibull { scale: 4.0, shape: 1.0 };
        let q = 1.0 - (-0.25_f64).exp();
        let whole = law.whole_cycles().expect("finite");
        assert!((whole.mean - 1.0 / q).abs() < 1e-12);
        assert!((whole.std - (1.0 - q).sqrt() / q).abs() < 1e-10);
        // Long lives: half a cycle more; S'(0)/12 = 1e-5 is left out.
        let law = Weibull { scale: 8000.0, shape: 1.0 };
        let q = -(-1.0 / 8000.0_f64).exp_m1();
        assert!((law.whole_cycles().expect("finite").mean - 1.0 / q).abs() < 1e-3);
    }

    #[test]
    fn no_probability_is_refused() {
        let law = Weibull { scale: 1.0, shape: 1.0 };
        for p in [0.0, 1.0, -0.1, f64::NAN] {
            assert!(matches!(law.quantile(p), Err(LifeError::Probability { .. })));
        }
    }
}
