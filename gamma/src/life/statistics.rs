//! Statistics of simulated lives with their Monte-Carlo standard errors. In: lives. Out: mean, spread, quantiles.
//! Never knows where lives come from.

use super::counted::CountedLives;
use super::ordered::Ordered;
use crate::error::{LifeError, probability};
use crate::special::{gamma_quantile, ln_gamma, student_bound};

/// Probability outside of an interval, on each side.
const TAIL: f64 = 0.025;

/// A statistic and its standard error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WithError {
    /// The statistic.
    pub value: f64,
    /// Its standard error from the finite number of lives; NaN where they do not tell it.
    pub error: f64,
}

/// Statistics of independent lives.
#[derive(Clone, Debug, PartialEq)]
pub struct LifeStatistics {
    order: Ordered,
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
        sorted.sort_unstable_by(f64::total_cmp);
        let mean = sorted.iter().sum::<f64>() / sorted.len() as f64;
        Ok(Self::ordered(Ordered::Each(sorted), mean))
    }

    /// Of lives that are counted: the mean is that of the lives, all else that of the middles of their bins, each life off by
    /// [`CountedLives::ERROR`] of itself at most.
    ///
    /// # Errors
    /// [`LifeError::FewLives`].
    pub fn counted(lives: &CountedLives) -> Result<Self, LifeError> {
        match lives.count() {
            count @ 0..2 => Err(LifeError::FewLives { lives: usize::from(count == 1) }),
            _ => Ok(Self::ordered(Ordered::counted(lives), lives.mean())),
        }
    }

    fn ordered(order: Ordered, mean: f64) -> Self {
        let count = order.count() as f64;
        let central = order.powers(mean).map(|sum| sum / count);
        Self { order, mean, central }
    }

    /// Number of lives.
    pub fn count(&self) -> usize {
        self.order.count()
    }

    /// The shortest life.
    pub fn shortest(&self) -> f64 {
        self.order.quantile(0.0)
    }

    /// The longest life.
    pub fn longest(&self) -> f64 {
        self.order.quantile(1.0)
    }

    /// Mean; standard error s / sqrt(n).
    pub fn mean(&self) -> WithError {
        let count = self.count() as f64;
        WithError { value: self.mean, error: self.deviation() / count.sqrt() }
    }

    /// Half-width of the interval that holds the mean of the law of lives with 95 %, by Student's law.
    pub fn mean_half_width(&self) -> f64 {
        student_bound(self.count() - 1, 1.0 - 2.0 * TAIL) * self.mean().error
    }

    /// Standard deviation (divisor n - 1); standard error sqrt((m4 - m2²) / n) / (2 s), the delta method. Of two lives m4 is m2²,
    /// whatever they are: they do not tell it.
    pub fn std(&self) -> WithError {
        let [m2, _, m4] = self.central;
        let deviation = self.deviation();
        if self.count() == 2 {
            return WithError { value: deviation, error: f64::NAN };
        }
        let error = ((m4 - m2 * m2).max(0.0) / self.count() as f64).sqrt() / (2.0 * deviation);
        WithError { value: deviation, error: if deviation > 0.0 { error } else { 0.0 } }
    }

    /// Interval that holds the standard deviation of the law of lives with 95 %: s² f / (upper and lower 2.5 % of chi-square
    /// with f degrees of freedom). f is n - 1, exact for a normal law, or less where the fourth moment says that s² scatters
    /// more than that of a normal law: f = 2 n / (m4/m2² - (n - 3)/(n - 1)), D. G. Bonett (2006). Few lives hardly show the
    /// tails of their law: for one of heavy tails the interval of few is too short.
    pub fn std_interval(&self) -> (f64, f64) {
        let [m2, _, m4] = self.central;
        let (count, deviation) = (self.count() as f64, self.deviation());
        let scatter = m4 / (m2 * m2) - (count - 3.0) / (count - 1.0);
        let by_moment = if scatter > 0.0 { 2.0 * count / scatter } else { f64::INFINITY };
        let half = 0.5 * by_moment.min(count - 1.0);
        let end = |p: f64| deviation * (half / gamma_quantile(half, p)).sqrt();
        (end(1.0 - TAIL), end(TAIL))
    }

    /// Coefficient of variation s / mean; standard error by the delta method with the third and fourth moments:
    /// var(c) = c² [ (m4/m2² - 1)/4 - m3/(m2 mean) + m2/mean² ] / n. Two lives do not tell it, as that of [`Self::std`].
    pub fn cov(&self) -> WithError {
        let [m2, m3, m4] = self.central;
        let value = self.deviation() / self.mean;
        if self.count() == 2 {
            return WithError { value, error: f64::NAN };
        }
        if m2 == 0.0 {
            return WithError { value, error: 0.0 };
        }
        let spread = (m4 / (m2 * m2) - 1.0) / 4.0 - m3 / (m2 * self.mean) + m2 / (self.mean * self.mean);
        WithError { value, error: value * (spread.max(0.0) / self.count() as f64).sqrt() }
    }

    /// Quantile by linear interpolation (type 7 of Hyndman & Fan 1996); standard error without assuming a law: half the
    /// distance of the quantiles one binomial standard error sqrt(p (1 - p) / n) below and above.
    ///
    /// # Errors
    /// [`LifeError::Probability`].
    pub fn quantile(&self, p: f64) -> Result<WithError, LifeError> {
        probability(p)?;
        let step = (p * (1.0 - p) / self.count() as f64).sqrt();
        let at = |p: f64| self.order.quantile(p.clamp(0.0, 1.0));
        Ok(WithError { value: at(p), error: 0.5 * (at(p + step) - at(p - step)) })
    }

    /// Interval that holds the quantile of the law of lives with 95 % or more, whatever the law: between two of the lives in
    /// order, by the binomial law of how many lie below. None: there are too few lives for an end on that side.
    ///
    /// # Errors
    /// [`LifeError::Probability`].
    pub fn quantile_interval(&self, p: f64) -> Result<[Option<f64>; 2], LifeError> {
        probability(p)?;
        let count = self.count();
        let life = |rank: Option<usize>| rank.and_then(|rank| self.order.get(rank));
        // The mirror image gives the upper end.
        let below = most_within(count, p);
        let above = most_within(count, 1.0 - p).and_then(|rank| count.checked_sub(rank + 1));
        Ok([life(below), life(above)])
    }

    /// Share of the lives longer than `t`; binomial standard error.
    pub fn reliability(&self, t: f64) -> WithError {
        let count = self.count() as f64;
        let value = (self.count() - self.order.up_to(t)) as f64 / count;
        WithError { value, error: (value * (1.0 - value) / count).sqrt() }
    }

    fn deviation(&self) -> f64 {
        let count = self.count() as f64;
        (self.central[0] * count / (count - 1.0)).sqrt()
    }
}

/// The largest k for which at most k of `count` fall below a p-quantile with no more than the probability [`TAIL`].
fn most_within(count: usize, p: f64) -> Option<usize> {
    let (n, ln_p, ln_rest) = (count as f64, libm::log(p), libm::log1p(-p));
    let ln_factorial = |k: f64| ln_gamma(k + 1.0);
    // Forty standard deviations below the mean chances are no numbers any more.
    let first = n * p - 40.0 * (n * p * (1.0 - p)).sqrt() - 40.0;
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "between 0 and the number of lives"
    )]
    let first = first.max(0.0) as usize;
    let mut sum = 0.0;
    let within = (first..count).take_while(|k| {
        let (k, rest) = (*k as f64, n - *k as f64);
        let ln_chance = ln_factorial(n) - ln_factorial(k) - ln_factorial(rest) + k * ln_p + rest * ln_rest;
        sum += libm::exp(ln_chance);
        sum <= TAIL
    });
    within.last()
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
    fn two_lives_do_not_tell_how_far_their_scatter_is_off() {
        for pair in [[20.0, 21.0], [7.0, 7.0]] {
            let lives = LifeStatistics::of(&pair).expect("valid");
            assert!(lives.std().error.is_nan() && lives.cov().error.is_nan(), "{pair:?}");
            assert!(lives.std().value >= 0.0 && lives.mean().error >= 0.0, "{pair:?}");
        }
        let three = LifeStatistics::of(&[20.0, 21.0, 23.0]).expect("valid");
        assert!(three.std().error > 0.0 && three.cov().error > 0.0);
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
    fn intervals_hold_what_they_are_of_as_often_as_they_say() {
        // Lognormal lives of 3 % and of 20 %, few and many.
        let mut draws = Stream::new(4, 0, 0);
        for (scatter, count) in [(0.03_f64, 2), (0.03, 5), (0.03, 16), (0.2, 16), (0.2, 400)] {
            let truth = 20.0 * ((scatter * scatter).exp_m1() * (scatter * scatter).exp()).sqrt();
            let (mut std, mut median, repetitions) = (0.0, 0.0, 2000);
            for _ in 0..repetitions {
                let lives = (0..count).map(|_| 20.0 * (scatter * draws.sample(StandardNormal)).exp());
                let lives = LifeStatistics::of(&lives.collect::<Vec<f64>>()).expect("valid");
                let (low, high) = lives.std_interval();
                std += f64::from(u8::from(low <= truth && truth <= high));
                let [low, high] = lives.quantile_interval(0.5).expect("valid");
                let is_within = low.is_none_or(|low| low <= 20.0) && high.is_none_or(|high| high >= 20.0);
                median += f64::from(u8::from(is_within));
            }
            let [std, median] = [std, median].map(|hits| 100.0 * hits / f64::from(repetitions));
            println!("{scatter} {count}: standard deviation {std:.1}, median {median:.1}");
            // 2000 repetitions: 0.5 % standard error, three of them; a skew of 20 % costs the rest.
            assert!((93.0..=97.5).contains(&std), "{scatter} {count}: {std}");
            assert!(median >= 95.0 - 1.5, "{scatter} {count}: {median}");
        }
    }

    #[test]
    fn ends_of_quantiles_are_the_lives_that_tables_of_order_statistics_name() {
        let lives: Vec<f64> = (1..=20).map(f64::from).collect();
        let lives = LifeStatistics::of(&lives).expect("valid");
        // The median of 20: the 6th and the 15th, 95.9 % (any table of the sign test).
        assert_eq!(lives.quantile_interval(0.5), Ok([Some(6.0), Some(15.0)]));
        // Of 20 lives none bounds the 10 % quantile from below: 0.9^20 = 12 % have none below it.
        assert_eq!(lives.quantile_interval(0.1), Ok([None, Some(6.0)]));
        assert_eq!(lives.quantile_interval(0.9), Ok([Some(15.0), None]));
    }

    #[test]
    fn lives_that_are_none_are_named() {
        assert_eq!(LifeStatistics::of(&[1.0]), Err(LifeError::FewLives { lives: 1 }));
        let error = LifeStatistics::of(&[1.0, f64::NAN]).expect_err("no number");
        assert!(error.to_string().starts_with("life 2 "), "{error}");
    }
}
