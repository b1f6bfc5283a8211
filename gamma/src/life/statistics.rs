//! Statistics of simulated lives with their Monte-Carlo standard errors. In: lives. Out: mean, spread, quantiles.
//! Never knows where lives come from.

use crate::error::{LifeError, probability};
use crate::order::sorted_quantile;

/// A statistic and its standard error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WithError {
    /// The statistic.
    pub value: f64,
    /// Its standard error from the finite number of lives.
    pub error: f64,
}

/// Statistics of independent lives.
#[derive(Clone, Debug, PartialEq)]
pub struct LifeStatistics {
    sorted: Vec<f64>,
    mean: f64,
    /// Central moments of order 2, 3, 4.
    central: [f64; 3],
}

impl LifeStatistics {
    /// Of lives that all ended, in any order: the order does not change a bit.
    ///
    /// # Errors
    /// [`LifeError::FewLives`], [`LifeError::Life`].
    pub fn of(lives: &[f64]) -> Result<Self, LifeError> {
        if lives.len() < 2 {
            return Err(LifeError::FewLives { lives: lives.len() });
        }
        for (at, life) in lives.iter().enumerate() {
            if !(life.is_finite() && *life > 0.0) {
                return Err(LifeError::Life { row: at + 1, value: *life });
            }
        }
        let mut sorted = lives.to_vec();
        sorted.sort_by(f64::total_cmp);
        let count = sorted.len() as f64;
        let mean = sorted.iter().sum::<f64>() / count;
        let mut sums = [0.0; 3];
        for life in &sorted {
            let (off, square) = (life - mean, (life - mean) * (life - mean));
            for (sum, power) in sums.iter_mut().zip([square, square * off, square * square]) {
                *sum += power;
            }
        }
        let central = sums.map(|sum| sum / count);
        Ok(Self { sorted, mean, central })
    }

    /// Number of lives.
    pub fn count(&self) -> usize {
        self.sorted.len()
    }

    /// The lives, shortest first.
    pub fn sorted(&self) -> &[f64] {
        &self.sorted
    }

    /// Mean; standard error s / sqrt(n).
    pub fn mean(&self) -> WithError {
        let count = self.sorted.len() as f64;
        WithError { value: self.mean, error: self.deviation() / count.sqrt() }
    }

    /// Standard deviation (divisor n - 1); standard error sqrt((m4 - m2²) / n) / (2 s), the delta method.
    pub fn std(&self) -> WithError {
        let [m2, _, m4] = self.central;
        let deviation = self.deviation();
        let error = ((m4 - m2 * m2).max(0.0) / self.sorted.len() as f64).sqrt() / (2.0 * deviation);
        WithError { value: deviation, error: if deviation > 0.0 { error } else { 0.0 } }
    }

    /// Coefficient of variation s / mean; standard error by the delta method with the third and fourth moments:
    /// var(c) = c² [ (m4/m2² - 1)/4 - m3/(m2 mean) + m2/mean² ] / n.
    pub fn cov(&self) -> WithError {
        let [m2, m3, m4] = self.central;
        let value = self.deviation() / self.mean;
        if m2 == 0.0 {
            return WithError { value, error: 0.0 };
        }
        let spread = (m4 / (m2 * m2) - 1.0) / 4.0 - m3 / (m2 * self.mean) + m2 / (self.mean * self.mean);
        WithError { value, error: value * (spread.max(0.0) / self.sorted.len() as f64).sqrt() }
    }

    /// Quantile by linear interpolation (type 7 of Hyndman & Fan 1996); standard error without assuming a law: half the
    /// distance of the quantiles one binomial standard error sqrt(p (1 - p) / n) below and above.
    ///
    /// # Errors
    /// [`LifeError::Probability`].
    pub fn quantile(&self, p: f64) -> Result<WithError, LifeError> {
        probability(p)?;
        let step = (p * (1.0 - p) / self.sorted.len() as f64).sqrt();
        let at = |p: f64| sorted_quantile(&self.sorted, p.clamp(0.0, 1.0));
        Ok(WithError { value: at(p), error: 0.5 * (at(p + step) - at(p - step)) })
    }

    /// Share of the lives longer than `t`; binomial standard error.
    pub fn reliability(&self, t: f64) -> WithError {
        let count = self.sorted.len() as f64;
        let value = (self.sorted.len() - self.sorted.partition_point(|life| *life <= t)) as f64 / count;
        WithError { value, error: (value * (1.0 - value) / count).sqrt() }
    }

    fn deviation(&self) -> f64 {
        let count = self.sorted.len() as f64;
        (self.central[0] * count / (count - 1.0)).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{StandardNormal, Stream};
    use rand::RngExt;

    #[test]
    fn small_lists_give_what_a_hand_calculation_gives() {
        let lives = LifeStatistics::of(&[4.0, 1.0, 3.0, 2.0]).expect("valid");
        assert_eq!(lives.mean().value, 2.5);
        assert!((lives.std().value - (5.0_f64 / 3.0).sqrt()).abs() < 1e-15);
        assert_eq!(lives.quantile(0.5).expect("valid").value, 2.5);
        assert_eq!(lives.reliability(2.0).value, 0.5);
    }

    #[test]
    fn standard_errors_are_the_scatter_of_repetitions() {
        // 400 repetitions of 200 lives, lognormal: skewed, so the third moment counts.
        let mut draws = Stream::new(3, 0, 0);
        let mut found: Vec<[f64; 4]> = Vec::new();
        let mut told = [0.0; 4];
        for _ in 0..400 {
            let lives: Vec<f64> =
                (0..200).map(|_| (3.0 + 0.2 * draws.sample(StandardNormal)).exp()).collect();
            let lives = LifeStatistics::of(&lives).expect("valid");
            let all = [lives.mean(), lives.std(), lives.cov(), lives.quantile(0.1).expect("valid")];
            found.push(all.map(|one| one.value));
            for (sum, one) in told.iter_mut().zip(all) {
                *sum += one.error / 400.0;
            }
        }
        for k in 0..4 {
            let values: Vec<f64> = found.iter().map(|row| row[k]).collect();
            let scatter = LifeStatistics::of(&values).expect("valid").std();
            // Three standard errors of the scatter itself (3.5 % each), and 5 % for 200 being finite.
            let miss = (scatter.value - told[k]).abs();
            assert!(miss < 3.0 * scatter.error + 0.05 * scatter.value, "{k}: {scatter:?} {}", told[k]);
        }
    }

    #[test]
    fn lives_that_are_none_are_named() {
        assert_eq!(LifeStatistics::of(&[1.0]), Err(LifeError::FewLives { lives: 1 }));
        let error = LifeStatistics::of(&[1.0, f64::NAN]).expect_err("no number");
        assert!(error.to_string().starts_with("life 2 "), "{error}");
    }
}
