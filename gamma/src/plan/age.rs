//! Replacement at an age, or at failure if that comes first. In: a law of life, costs. Out: the age of the least cost per
//! unit of time, or that it does not pay. Never knows wear.
//!
//! Barlow and Proschan, Mathematical Theory of Reliability (1965), chapter 4; with times of replacement: Jardine and Tsang,
//! Maintenance, Replacement and Reliability, chapter 2:
//!
//! ```text
//!          c_p S(T) + c_f F(T)
//! C(T) = -------------------------------------
//!        int_0^T S dt + t_p S(T) + t_f F(T)
//! ```

use super::costs::Costs;
use super::error::PlanError;
use super::mean_use::{MeanUse, ages};
use super::search::least;
use crate::error::positive;
use crate::life::Lifetime;

/// Probabilities of failure at which ages are tried; between the best and its neighbours the minimum is searched. Where a
/// hazard rises, C(T) has one minimum at most; others are found if they are wider than these steps.
const TRIED: usize = 200;
/// Smallest and largest of them.
const TAIL: f64 = 1e-6;
/// What must be saved against waiting for failure, as a part: less is rounding of the integrals.
const SAVED: f64 = 1e-9;

/// What replacing at an age costs and brings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AgePlan {
    /// Age of replacement \[time\]; None if waiting for failure is cheapest.
    pub age: Option<f64>,
    /// Cost per unit of time by this plan.
    pub cost_rate: f64,
    /// Cost per unit of time if parts are replaced when they fail.
    pub failure_only: f64,
    /// Share of parts that fail before they are replaced.
    pub fail: f64,
    /// Mean time in use of a part \[time\].
    pub mean_use: f64,
}

/// Cost per unit of time where parts are replaced at `age`.
///
/// # Errors
/// [`PlanError::Life`] for an age that is not positive.
pub fn age_cost_rate(life: &dyn Lifetime, costs: &Costs, age: f64) -> Result<f64, PlanError> {
    positive("the age of replacement", age)?;
    Ok(rate(life, costs, age, MeanUse::new(life, life.accuracy()).until(age)))
}

fn rate(life: &dyn Lifetime, costs: &Costs, age: f64, mean_use: f64) -> f64 {
    let (alive, failed) = (life.reliability(age), life.failed(age));
    (costs.preventive * alive + costs.failure * failed)
        / (mean_use + costs.preventive_time * alive + costs.failure_time * failed)
}

/// The age of the least cost per unit of time.
///
/// # Errors
/// [`PlanError::Life`] for a law without a mean.
pub fn best_age(life: &dyn Lifetime, costs: &Costs) -> Result<AgePlan, PlanError> {
    let mean = life.moments()?.mean;
    let failure_only = costs.failure / (mean + costs.failure_time);
    let mut mean_use = MeanUse::new(life, life.accuracy());
    let (age, cost_rate) =
        least(&ages(life, TAIL, TRIED)?, &mut |age| rate(life, costs, age, mean_use.until(age)));
    if cost_rate < failure_only * (1.0 - SAVED) {
        let (fail, mean_use) = (life.failed(age), mean_use.until(age));
        return Ok(AgePlan { age: Some(age), cost_rate, failure_only, fail, mean_use });
    }
    Ok(AgePlan { age: None, cost_rate: failure_only, failure_only, fail: 1.0, mean_use: mean })
}

/// How long parts are in use that are replaced at an age at the latest.
pub struct PlannedLife<'a> {
    /// The life until failure.
    pub life: &'a dyn Lifetime,
    /// The age; None: at failure only.
    pub age: Option<f64>,
}

impl Lifetime for PlannedLife<'_> {
    fn reliability(&self, t: f64) -> f64 {
        if self.age.is_some_and(|age| t >= age) { 0.0 } else { self.life.reliability(t) }
    }

    fn failed(&self, t: f64) -> f64 {
        if self.age.is_some_and(|age| t >= age) { 1.0 } else { self.life.failed(t) }
    }

    fn typical(&self) -> f64 {
        self.age.map_or(f64::INFINITY, |age| age).min(self.life.typical())
    }

    fn accuracy(&self) -> f64 {
        self.life.accuracy()
    }

    fn breaks(&self) -> Vec<f64> {
        self.life.breaks().into_iter().chain(self.age).collect()
    }
}
