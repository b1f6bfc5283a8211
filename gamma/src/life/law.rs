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
}
