//! The life that is left to a part that has gone on for a time without failing. In: the law of a life. Out: a [`Lifetime`]
//! from the end of that time on. Never knows wear.

use super::lifetime::{Lifetime, Moments, integrated_moments};
use crate::error::{LifeError, non_negative};

/// Survivors below which the law beyond is rounding.
const FEWEST: f64 = 1e-12;
/// Least part of a typical life that searches start from.
const NEAR: f64 = 1e-3;

/// A life that has outlived an age: P(T > age + t | T > age).
pub struct Survived<'a> {
    life: &'a dyn Lifetime,
    age: f64,
    alive: f64,
}

impl<'a> Survived<'a> {
    /// The rest of a life that has lasted for `age` >= 0.
    ///
    /// # Errors
    /// [`LifeError::Negative`]; [`LifeError::NoneSurvives`] where fewer than 1e-12 get as old.
    pub fn new(life: &'a dyn Lifetime, age: f64) -> Result<Self, LifeError> {
        let age = non_negative("the time without failure", age)?;
        let alive = life.reliability(age);
        // Not a number counts as none.
        if alive >= FEWEST { Ok(Self { life, age, alive }) } else { Err(LifeError::NoneSurvives { age }) }
    }

    /// Mean of what is left.
    ///
    /// # Errors
    /// Those of [`Lifetime::moments`].
    pub fn mean(&self) -> Result<f64, LifeError> {
        Ok(self.moments()?.mean)
    }
}

impl Lifetime for Survived<'_> {
    fn reliability(&self, t: f64) -> f64 {
        (self.life.reliability(self.age + t.max(0.0)) / self.alive).min(1.0)
    }

    fn failed(&self, t: f64) -> f64 {
        if self.alive < 0.5 {
            return 1.0 - self.reliability(t);
        }
        ((self.life.failed(self.age + t.max(0.0)) - self.life.failed(self.age)) / self.alive).max(0.0)
    }

    fn typical(&self) -> f64 {
        let whole = self.life.typical();
        (whole - self.age).max(NEAR * whole)
    }

    fn ever(&self) -> f64 {
        let never = 1.0 - self.life.ever();
        1.0 - never / self.alive
    }

    fn accuracy(&self) -> f64 {
        self.life.accuracy()
    }

    fn breaks(&self) -> Vec<f64> {
        self.life.breaks().into_iter().map(|t| t - self.age).collect()
    }

    fn finite_moments(&self) -> Result<(), LifeError> {
        self.life.finite_moments()
    }

    /// Of the whole life where none of it has passed: it may know them in closed form.
    fn moments(&self) -> Result<Moments, LifeError> {
        if self.age == 0.0 { self.life.moments() } else { integrated_moments(self) }
    }

    fn hazard(&self, t: f64) -> f64 {
        self.life.hazard(self.age + t)
    }
}

#[cfg(test)]
mod tests {
    use super::super::weibull::Weibull;
    use super::*;

    #[test]
    fn an_exponential_life_does_not_age() {
        let law = Weibull { scale: 4.0, shape: 1.0 };
        let rest = Survived::new(&law, 9.0).expect("e^-2.25 survive");
        // Differences of numbers near 1: a digit or two.
        assert!((rest.quantile(0.5).expect("valid") / law.quantile(0.5).expect("valid") - 1.0).abs() < 1e-12);
        // The accuracy of the integral.
        assert!((rest.mean().expect("finite") / 4.0 - 1.0).abs() < 1e-9);
        assert!((rest.reliability(2.0) - (-0.5_f64).exp()).abs() < 1e-14);
    }

    #[test]
    fn an_ageing_life_has_the_rest_that_mathematics_give() {
        // Rayleigh's law: mean rest at age a is s exp(a^2/s^2) (sqrt(pi)/2) erfc(a/s); at a = s e sqrt(pi)/2 erfc(1).
        let law = Weibull { scale: 3.0, shape: 2.0 };
        let rest = Survived::new(&law, 3.0).expect("a third survive");
        let erfc_of_1 = 0.157_299_207_050_285_13;
        let expected = 3.0 * std::f64::consts::E * 0.5 * std::f64::consts::PI.sqrt() * erfc_of_1;
        assert!((rest.mean().expect("finite") / expected - 1.0).abs() < 1e-9);
        // B1 from exp(-((3 + t)/3)^2 + 1) = 0.99.
        let b1 = 3.0 * ((1.0 - 0.99_f64.ln()).sqrt() - 1.0);
        assert!((rest.quantile(0.01).expect("valid") / b1 - 1.0).abs() < 1e-12);
        assert_eq!(Survived::new(&law, 0.0).expect("all").quantile(0.3), law.quantile(0.3));
    }

    #[test]
    fn an_age_that_nobody_reaches_is_refused() {
        let law = Weibull { scale: 1.0, shape: 2.0 };
        for age in [6.0, f64::MAX] {
            assert!(matches!(Survived::new(&law, age), Err(LifeError::NoneSurvives { .. })), "{age}");
        }
        for age in [-1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(Survived::new(&law, age), Err(LifeError::Negative { .. })), "{age}");
        }
    }
}
