//! Estimated parameters with their covariance, and the situation life is asked for in.
//! In: numbers of a fit. Out: a [`FirstPassage`] for these parameters or others near them. Never knows how they were fitted.

use super::clock::Clock;
use super::error::{LifeError, non_negative, positive};
use super::first_passage::FirstPassage;
use super::law::GammaLaw;

/// alpha, beta and perhaps the exponent of exposure, with the covariance of their logarithms.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// ln alpha, ln beta, and ln exponent if it was estimated.
    logs: Vec<f64>,
    /// Lower triangular factor of the covariance of `logs`; empty if the parameters are taken as known.
    factor: Factor,
}

/// Lower triangular Cholesky factor, row by row.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Factor(Vec<Vec<f64>>);

impl Estimate {
    /// Parameters taken as known exactly. `exponent`: None for exposure that counts as it is.
    ///
    /// # Errors
    /// [`LifeError::NotPositive`].
    pub fn exact(alpha: f64, beta: f64, exponent: Option<f64>) -> Result<Self, LifeError> {
        let mut logs = vec![positive("alpha", alpha)?.ln(), positive("beta", beta)?.ln()];
        if let Some(exponent) = exponent {
            logs.push(positive("the exponent", exponent)?.ln());
        }
        Ok(Self { logs, factor: Factor::default() })
    }

    /// With the covariance of (alpha, beta\[, exponent\]) themselves, as a fit prints it. It is taken over to the
    /// logarithms to first order: divided by the parameters, cov(ln a, ln b) = cov(a, b) / (a b).
    ///
    /// # Errors
    /// [`LifeError::Covariance`].
    pub fn with_covariance(self, covariance: &[Vec<f64>]) -> Result<Self, LifeError> {
        let size = self.logs.len();
        if covariance.len() != size || covariance.iter().any(|row| row.len() != size) {
            return Err(LifeError::Covariance { reason: "another size than the parameters", size });
        }
        let scale = |i: usize, j: usize| covariance[i][j] / (self.logs[i].exp() * self.logs[j].exp());
        let scaled: Vec<Vec<f64>> = (0..size).map(|i| (0..size).map(|j| scale(i, j)).collect()).collect();
        self.with_log_covariance(&scaled)
    }

    /// With the covariance of (ln alpha, ln beta\[, ln exponent\]).
    ///
    /// # Errors
    /// [`LifeError::Covariance`].
    pub fn with_log_covariance(mut self, covariance: &[Vec<f64>]) -> Result<Self, LifeError> {
        self.factor = Factor::of(covariance, self.logs.len())?;
        Ok(self)
    }

    /// Shape per unit of exposure.
    #[must_use]
    pub fn alpha(&self) -> f64 {
        self.logs[0].exp()
    }

    /// Rate [1 / unit of wear].
    #[must_use]
    pub fn beta(&self) -> f64 {
        self.logs[1].exp()
    }

    /// Exponent of exposure, if one was estimated.
    #[must_use]
    pub fn exponent(&self) -> Option<f64> {
        self.logs.get(2).map(|log| log.exp())
    }

    /// Whether a covariance is known.
    #[must_use]
    pub fn is_uncertain(&self) -> bool {
        !self.factor.0.is_empty()
    }

    /// Variance of a value to first order, from its derivatives by (ln alpha, ln beta\[, ln exponent\]); 0 if the
    /// parameters are taken as known. Derivatives left out count as 0.
    #[must_use]
    pub fn variance(&self, gradient: &[f64]) -> f64 {
        let mut padded = gradient.to_vec();
        padded.resize(self.logs.len(), 0.0);
        self.factor.variance(&padded)
    }

    pub(crate) fn logs(&self) -> &[f64] {
        &self.logs
    }

    pub(crate) fn factor(&self) -> &Factor {
        &self.factor
    }
}

impl Factor {
    /// Of a positive semi-definite matrix; a direction without variance gets a zero column.
    fn of(matrix: &[Vec<f64>], size: usize) -> Result<Self, LifeError> {
        let refuse = |reason| Err(LifeError::Covariance { reason, size });
        if matrix.len() != size || matrix.iter().any(|row| row.len() != size) {
            return refuse("another size than the parameters");
        }
        if matrix.iter().flatten().any(|value| !value.is_finite()) {
            return refuse("a value is no finite number");
        }
        let mut rows = vec![vec![0.0; size]; size];
        for i in 0..size {
            for j in 0..=i {
                let size = (matrix[i][i] * matrix[j][j]).abs().sqrt();
                if (matrix[i][j] - matrix[j][i]).abs() > 1e-6 * size {
                    return refuse("not symmetric");
                }
                let done: f64 = (0..j).map(|k| rows[i][k] * rows[j][k]).sum();
                let rest = matrix[i][j] - done;
                // Rounding of printed matrices may leave a tiny negative pivot.
                if i == j && rest < -1e-9 * matrix[i][i].abs() || matrix[i][i] < 0.0 {
                    return refuse("negative in some direction");
                }
                rows[i][j] = if i == j {
                    rest.max(0.0).sqrt()
                } else if rows[j][j] > 0.0 {
                    rest / rows[j][j]
                } else {
                    0.0
                };
            }
        }
        Ok(Self(rows))
    }

    /// L z; zero without a covariance.
    pub(crate) fn times(&self, z: &[f64]) -> Vec<f64> {
        let row = |row: &Vec<f64>| row.iter().zip(z).map(|(a, b)| a * b).sum();
        self.0.iter().map(row).collect()
    }

    /// |L' g|²: variance of g · x.
    pub(crate) fn variance(&self, gradient: &[f64]) -> f64 {
        let column = |j: usize| -> f64 { self.0.iter().zip(gradient).map(|(row, g)| row[j] * g).sum() };
        (0..self.0.len()).map(|j| column(j).powi(2)).sum()
    }

    /// |L^-1 d|²: squared distance in standard deviations; None where a direction has no variance.
    pub(crate) fn distance(&self, d: &[f64]) -> Option<f64> {
        let mut solved: Vec<f64> = Vec::with_capacity(d.len());
        for (i, row) in self.0.iter().enumerate() {
            if row[i] <= 0.0 {
                return None;
            }
            let done: f64 = solved.iter().zip(row).map(|(a, b)| a * b).sum();
            solved.push((d[i] - done) / row[i]);
        }
        Some(solved.iter().map(|x| x * x).sum())
    }
}

/// Logarithms moved by a step; a step without entries moves nothing.
pub(crate) fn moved(logs: &[f64], by: &[f64]) -> Vec<f64> {
    let by = by.iter().copied().chain(std::iter::repeat(0.0));
    logs.iter().zip(by).map(|(log, step)| log + step).collect()
}

/// What is worn how far, and how fast exposure runs from here.
#[derive(Clone, Debug, PartialEq)]
pub struct OperatingState {
    threshold: f64,
    current: f64,
    exposure: f64,
    rate: f64,
}

impl OperatingState {
    /// A new joint that fails at `threshold` [unit of wear]; one unit of exposure per unit of time.
    ///
    /// # Errors
    /// [`LifeError::NotPositive`].
    pub fn new(threshold: f64) -> Result<Self, LifeError> {
        Ok(Self { threshold: positive("the threshold", threshold)?, current: 0.0, exposure: 0.0, rate: 1.0 })
    }

    /// Worn to `current` [unit of wear] after `exposure` (before any exponent) [unit of exposure].
    ///
    /// # Errors
    /// [`LifeError::Negative`], [`LifeError::Failed`].
    pub fn worn(mut self, current: f64, exposure: f64) -> Result<Self, LifeError> {
        self.current = non_negative("the present wear", current)?;
        self.exposure = non_negative("the present exposure", exposure)?;
        if current >= self.threshold {
            return Err(LifeError::Failed { threshold: self.threshold, current });
        }
        Ok(self)
    }

    /// `rate` units of exposure per unit of time from now on; lives are told in that time.
    ///
    /// # Errors
    /// [`LifeError::NotPositive`].
    pub fn at_rate(mut self, rate: f64) -> Result<Self, LifeError> {
        self.rate = positive("the rate", rate)?;
        Ok(self)
    }

    /// Wear at failure.
    #[must_use]
    pub fn threshold(&self) -> f64 {
        self.threshold
    }

    /// Wear now.
    #[must_use]
    pub fn current(&self) -> f64 {
        self.current
    }

    /// Units of exposure per unit of time.
    #[must_use]
    pub fn rate(&self) -> f64 {
        self.rate
    }

    /// Law of the remaining life if the parameters are those estimated.
    ///
    /// # Errors
    /// [`LifeError`], if a parameter leaves the range of numbers.
    pub fn life(&self, estimate: &Estimate) -> Result<FirstPassage, LifeError> {
        self.life_at(&estimate.logs)
    }

    /// The same at given logarithms of the parameters.
    pub(crate) fn life_at(&self, logs: &[f64]) -> Result<FirstPassage, LifeError> {
        let law = GammaLaw::new(logs[0].exp(), logs[1].exp())?;
        let clock = Clock::power(self.rate, logs.get(2).map_or(1.0, |log| log.exp()))?;
        FirstPassage::from(law, clock, self.threshold, self.current, self.exposure / self.rate)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn covariance_goes_over_to_logarithms() {
        let estimate = Estimate::exact(2.0, 4.0, None).expect("valid");
        let uncertain = estimate.with_covariance(&[vec![0.04, 0.04], vec![0.04, 0.16]]).expect("valid");
        // Standard deviations 0.2 of 2 and 0.4 of 4: 0.1 in the logarithm.
        assert!((uncertain.factor.variance(&[1.0, 0.0]) - 0.01).abs() < 1e-15);
        assert!((uncertain.factor.variance(&[0.0, 1.0]) - 0.01).abs() < 1e-15);
        // Correlation 0.5: variance of the difference 0.01 + 0.01 - 2 * 0.005.
        assert!((uncertain.factor.variance(&[1.0, -1.0]) - 0.01).abs() < 1e-15);
        assert!((uncertain.variance(&[1.0]) - 0.01).abs() < 1e-15);
        assert_eq!(Estimate::exact(2.0, 4.0, None).expect("valid").variance(&[1.0, 1.0]), 0.0);
        let distance = uncertain.factor.distance(&[0.1, 0.1]).expect("full rank");
        // d' C^-1 d with C = 0.01 [[1, .5], [.5, 1]]: 1/0.75 (1 + 1 - 1).
        assert!((distance - 4.0 / 3.0).abs() < 1e-12);
    }

    #[test]
    fn matrices_that_are_no_covariance_are_refused() {
        let estimate = || Estimate::exact(2.0, 4.0, None).expect("valid");
        let cases = [
            vec![vec![1.0, 2.0], vec![2.0, 1.0]],
            vec![vec![-1.0, 0.0], vec![0.0, 1.0]],
            vec![vec![1.0, 0.5], vec![0.1, 1.0]],
            vec![vec![1.0, f64::NAN], vec![f64::NAN, 1.0]],
            vec![vec![1.0]],
        ];
        for case in cases {
            let error = estimate().with_covariance(&case).expect_err("no covariance");
            assert!(matches!(error, LifeError::Covariance { size: 2, .. }), "{error}");
        }
    }

    #[test]
    fn parameters_that_are_not_positive_are_named() {
        let error = Estimate::exact(-1.0, 4.0, None).expect_err("negative");
        assert_eq!(error, LifeError::NotPositive { what: "alpha", value: -1.0 });
        assert!(Estimate::exact(1.0, f64::NAN, None).is_err());
        assert!(Estimate::exact(1.0, 1.0, Some(0.0)).is_err());
        assert!(OperatingState::new(3.0).expect("valid").worn(1.0, -0.5).is_err());
    }
}
