//! The Gamma law of a wear increment, [CS (21)]. In and out: numbers. Never knows time.

use super::error::{LifeError, positive};

/// dW ~ Gamma(shape `alpha` dLambda, rate `beta`): mean alpha dLambda / beta, variance alpha dLambda / beta².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GammaLaw {
    alpha: f64,
    beta: f64,
}

impl GammaLaw {
    /// `alpha` [1 / unit of exposure], `beta` [1 / unit of wear].
    ///
    /// # Errors
    /// [`LifeError::NotPositive`].
    pub fn new(alpha: f64, beta: f64) -> Result<Self, LifeError> {
        Ok(Self { alpha: positive("alpha", alpha)?, beta: positive("beta", beta)? })
    }

    /// Shape per unit of exposure.
    #[must_use]
    pub fn alpha(&self) -> f64 {
        self.alpha
    }

    /// Rate [1 / unit of wear].
    #[must_use]
    pub fn beta(&self) -> f64 {
        self.beta
    }

    /// Mean wear over an exposure, [CS (23)] [unit of wear].
    #[must_use]
    pub fn mean(&self, exposure: f64) -> f64 {
        self.alpha * exposure / self.beta
    }

    /// Variance of the wear over an exposure, [CS (24)] [unit of wear squared].
    #[must_use]
    pub fn variance(&self, exposure: f64) -> f64 {
        self.alpha * exposure / (self.beta * self.beta)
    }
}

#[cfg(test)]
mod tests {
    use super::super::LifeStatistics;
    use super::*;
    use crate::random::{LnGamma, Stream};
    use rand::RngExt;

    #[test]
    fn drawn_increments_have_mean_and_variance_of_the_law() {
        let law = GammaLaw::new(3.0, 2.0).expect("valid");
        let mut draws = Stream::new(9, 0, 0);
        let drawn: Vec<f64> = (0..20_000).map(|_| draws.sample(LnGamma(3.0 * 0.7)).exp() / 2.0).collect();
        let seen = LifeStatistics::of(&drawn).expect("positive");
        // Three standard errors of a fixed seed.
        assert!((seen.mean().value - law.mean(0.7)).abs() < 3.0 * seen.mean().error);
        assert!((seen.std().value - law.variance(0.7).sqrt()).abs() < 3.0 * seen.std().error);
    }
}
