//! What residuals say about a model: white ones are noise, others are what it does not know. In: residuals in the order of reading.
//! Out: [`Whiteness`]. Never knows what was read.

use linkwear_gamma::special::gamma_q;

use crate::number::number;

/// How much residuals hang together from one reading to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Whiteness {
    /// Correlation of neighbours.
    pub neighbours: f64,
    /// Probability that independent noise hangs together as much (Ljung & Box 1978); none of fewer readings than a test needs.
    pub p: Option<f64>,
    /// So many readings that hang together tell as much as one: 1 where the test finds nothing.
    pub per_independent: f64,
}

/// Below this probability residuals are taken to hang together.
pub(super) const LEVEL: f64 = 0.01;
/// Readings that the test needs.
const LEAST: usize = 20;
/// Lags of the test, at most.
const LAGS: usize = 20;

impl Whiteness {
    pub(super) fn of(residuals: &[f64]) -> Self {
        let count = residuals.len();
        let square: f64 = residuals.iter().map(|r| r * r).sum();
        let correlation = |lag: usize| -> f64 {
            let product = residuals.iter().zip(&residuals[lag..]).map(|(a, b)| a * b).sum::<f64>();
            if square > 0.0 { product / square } else { 0.0 }
        };
        let neighbours = if count > 1 { correlation(1) } else { 0.0 };
        if count < LEAST {
            return Self { neighbours, p: None, per_independent: 1.0 };
        }
        let lags = LAGS.min(count / 5);
        let sum: f64 = (1..=lags).map(|lag| correlation(lag).powi(2) / (count - lag) as f64).sum();
        let statistic = count as f64 * (count as f64 + 2.0) * sum;
        let p = gamma_q(0.5 * lags as f64, 0.5 * statistic);
        let per_independent = if p < LEVEL { correlation_time(count, correlation) } else { 1.0 };
        Self { neighbours, p: Some(p), per_independent }
    }

    /// Whether the residuals hang together.
    pub fn is_doubtful(&self) -> bool {
        self.p.is_some_and(|p| p < LEVEL)
    }
}

/// A probability with its sign of equality: what is smaller is not known so well.
pub(crate) fn probability(p: f64) -> String {
    if p < 1e-4 { "< 1e-4".to_owned() } else { format!("= {}", number(p)) }
}

/// Sum of the correlations at all lags, cut off at five times itself (Sokal 1997).
fn correlation_time(count: usize, correlation: impl Fn(usize) -> f64) -> f64 {
    let mut time = 1.0;
    for lag in 1..count / 2 {
        time += 2.0 * correlation(lag);
        if lag as f64 >= 5.0 * time {
            break;
        }
    }
    time.clamp(1.0, count as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identify::tests::noise;

    #[test]
    fn independent_noise_is_white_and_a_wave_is_not() {
        // Of 400 samples 4 +- 2 fall below the level: 12 would be four standard deviations more.
        let doubtful = (0..400).filter(|seed| Whiteness::of(&noise(120, *seed)).is_doubtful()).count();
        assert!(doubtful < 12, "{doubtful}");
        let wave: Vec<f64> =
            noise(200, 3).iter().enumerate().map(|(at, e)| e + (0.1 * at as f64).sin()).collect();
        let white = Whiteness::of(&wave);
        assert!(white.is_doubtful() && white.per_independent > 3.0, "{white:?}");
    }

    #[test]
    fn a_first_order_process_has_the_correlation_time_of_its_law() {
        let mut last = 0.0;
        let series: Vec<f64> = noise(20_000, 5)
            .into_iter()
            .map(|e| {
                last = 0.6 * last + e;
                last
            })
            .collect();
        // (1 + 0.6) / (1 - 0.6) = 4; the window of 20 lags of 20,000 readings leaves a scatter of about 5 %.
        let time = Whiteness::of(&series).per_independent;
        assert!((time / 4.0 - 1.0).abs() < 0.15, "{time}");
    }

    #[test]
    fn few_readings_are_not_judged() {
        let white = Whiteness::of(&[1.0, 1.0, 1.0]);
        assert!(white.p.is_none() && !white.is_doubtful());
    }
}
