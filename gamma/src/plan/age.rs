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
/// Smallest and largest of them, but where failures cost so much that fewer have to fail.
const TAIL: f64 = 1e-6;
/// From one part that has failed to the next, where still earlier ages are tried.
const EARLIER: f64 = 0.1;
/// Part that has failed below which ages are not told from 0: numbers end at 1e-308, and laws lose digits before.
const EARLIEST: f64 = 1e-290;
/// How near the search comes to an end of its range, as a part of the age, if the least cost lies beyond: ten times where it stops.
const AT_THE_END: f64 = 1e-5;
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
    let mut tried = ages(life, TAIL, TRIED)?;
    let mut rate = |age: f64| rate(life, costs, age, mean_use.until(age));
    let (mut age, mut cost_rate) = least(&tried, &mut rate);
    if age <= (1.0 + AT_THE_END) * tried[0] {
        earlier(life, &mut tried, &mut rate)?;
        (age, cost_rate) = least(&tried, &mut rate);
    }
    if cost_rate < failure_only * (1.0 - SAVED) {
        let (fail, mean_use) = (life.failed(age), mean_use.until(age));
        return Ok(AgePlan { age: Some(age), cost_rate, failure_only, fail, mean_use });
    }
    Ok(AgePlan { age: None, cost_rate: failure_only, failure_only, fail: 1.0, mean_use: mean })
}

/// Puts earlier ages before those tried, until one costs more than the next: towards age 0 cost per unit of time grows without end, or,
/// where replacements take time, to that of replacing all the time.
fn earlier(
    life: &dyn Lifetime,
    tried: &mut Vec<f64>,
    rate: &mut dyn FnMut(f64) -> f64,
) -> Result<(), PlanError> {
    let (mut part, mut next) = (TAIL, rate(tried[0]));
    while part > EARLIEST {
        part *= EARLIER;
        let age = life.quantile(part)?;
        // Not a number is no earlier age.
        if !(age > 0.0 && age < tried[0]) {
            break;
        }
        let here = rate(age);
        tried.insert(0, age);
        if here >= next {
            break;
        }
        next = here;
    }
    Ok(())
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::life::{Clock, FirstPassage, Law, Weibull};
    use crate::process::Gamma;

    #[test]
    fn where_failures_cost_a_million_times_more_the_age_is_no_end_of_a_search() {
        // Early on F = (T / scale)^k, and c_p = (k - 1) c_f F is least: a part of 3e-7 to 3e-13 has failed by then.
        for (shape, ratio) in [(4.0, 1e6), (4.0, 1e8), (4.0, 1e12), (2.0, 1e9)] {
            let life = Weibull { scale: 50.0, shape };
            let plan = best_age(&life, &Costs::new(1.0, ratio).expect("valid")).expect("a plan");
            let part: f64 = 1.0 / (ratio * (shape - 1.0));
            let (age, expected) = (plan.age.expect("pays"), 50.0 * part.powf(1.0 / shape));
            // The search ends within 1e-6 of the age; F and 1 / ratio are left out of the formula, 1e-6 at most.
            assert!((age / expected - 1.0).abs() < 3e-6, "{shape} {ratio}: {age} {expected}");
            assert!((plan.cost_rate * expected * (1.0 - 1.0 / shape) - 1.0).abs() < 3e-6, "{plan:?}");
        }
    }

    #[test]
    fn no_age_at_all_is_cheaper_than_the_one_that_is_told() {
        let law = Law::new(&Gamma, [2.182, 1.0734]).expect("valid");
        let life = FirstPassage::new(law, Clock::linear(1.0).expect("valid"), 200.0).expect("valid");
        for ratio in [1e5, 1e6, 1e7, 1e12] {
            let costs = Costs::new(100.0, 100.0 * ratio).expect("valid").taking(0.2, 3.0).expect("valid");
            let plan = best_age(&life, &costs).expect("a plan");
            // The search ends within 1e-6 of the age, where the cost is flat.
            let least = (1..1000).map(|k| age_cost_rate(&life, &costs, 0.1 * f64::from(k)).expect("valid"));
            let least = least.fold(f64::INFINITY, f64::min);
            assert!(
                plan.cost_rate <= least * (1.0 + 1e-10) && plan.cost_rate > 0.999 * least,
                "{plan:?} {least}"
            );
        }
    }
}
