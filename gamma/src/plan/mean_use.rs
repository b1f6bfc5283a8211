//! Mean time in use of parts that are replaced at an age or at failure: the integral of the reliability. In: a law of life, ages.
//! Out: means. Never knows costs.

use crate::error::LifeError;
use crate::life::Lifetime;
use crate::quadrature::integrate;

/// The integral until any age; ages that are asked for in rising order each go on from the one before.
pub(super) struct MeanUse<'a> {
    life: &'a dyn Lifetime,
    /// Of the age.
    accuracy: f64,
    /// Ages and their integrals, ascending.
    known: Vec<(f64, f64)>,
}

impl<'a> MeanUse<'a> {
    /// Good to `accuracy` times the age.
    pub fn new(life: &'a dyn Lifetime, accuracy: f64) -> Self {
        Self { life, accuracy, known: vec![(0.0, 0.0)] }
    }

    /// Until `age` >= 0.
    pub fn until(&mut self, age: f64) -> f64 {
        let at = self.known.partition_point(|(from, _)| *from <= age).max(1);
        let (from, used) = self.known[at - 1];
        if age <= from {
            return used;
        }
        let mut limits = self.life.limits(age, &[from]);
        limits.retain(|t| *t >= from);
        let more = integrate(&|t| [self.life.reliability(t)], &limits, [self.accuracy * age]).0[0];
        if at == self.known.len() {
            self.known.push((age, used + more));
        }
        used + more
    }
}

/// Ages until which parts from `tail` to 1 - `tail` have failed, in even parts, ascending.
///
/// # Errors
/// [`LifeError::Probability`].
pub(super) fn ages(life: &dyn Lifetime, tail: f64, count: usize) -> Result<Vec<f64>, LifeError> {
    let part = |k: usize| tail + (1.0 - 2.0 * tail) * k as f64 / (count - 1) as f64;
    let mut ages = (0..count).map(|k| life.quantile(part(k))).collect::<Result<Vec<f64>, _>>()?;
    ages.dedup_by(|b, a| b <= a);
    Ok(ages)
}
