//! What possible laws of life leave open of a plan. In: lives as the data leave them possible, all equally probable; a plan. Out:
//! intervals, the same on any number of threads. Never knows where the lives are from.

use std::num::NonZero;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;

use super::age::{AgePlan, age_cost_rate, best_age};
use super::condition::Monitored;
use super::condition_search::{ConditionPlan, cheapest};
use super::costs::{Costs, Looks};
use super::error::PlanError;
use crate::life::{FirstPassage, Lifetime};
use crate::order::sorted_quantile;

/// Part of the lives that may be left out because their parameters are beyond what can be computed.
const LEFT_OUT: f64 = 0.01;

/// Lower and upper end.
pub type Ends = (f64, f64);

/// What is open of a plan by age.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AgeBands {
    /// Of the age of least cost; infinite where waiting for failure may be cheapest.
    pub age: Ends,
    /// Of what the plan costs per unit of time, at the age that it says.
    pub cost_rate: Ends,
    /// Of what waiting for failure costs per unit of time.
    pub failure_only: Ends,
    /// Part of the lives for which replacement at some age pays.
    pub pays: f64,
}

/// Intervals of probability `level` around a plan by age. None where too many of the lives cannot be planned for.
pub fn age_bands(lives: &[FirstPassage], costs: &Costs, plan: &AgePlan, level: f64) -> Option<AgeBands> {
    let one = |life: &FirstPassage| -> Result<[f64; 3], PlanError> {
        let best = best_age(life, costs)?;
        let own = plan.age.map_or(Ok(best.failure_only), |age| age_cost_rate(life, costs, age))?;
        Ok([best.age.unwrap_or(f64::INFINITY), own, best.failure_only])
    };
    let [ages, rates, waiting] = sorted(&on_threads(lives, &one), lives.len())?;
    let pays = ages.iter().filter(|age| age.is_finite()).count() as f64 / ages.len() as f64;
    Some(AgeBands {
        age: ends(&ages, level),
        cost_rate: ends(&rates, level),
        failure_only: ends(&waiting, level),
        pays,
    })
}

/// What is open of a plan of looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LookBands {
    /// Of the interval of least cost; the plan's own where that is given.
    pub interval: Ends,
    /// Of the threshold of least cost, likewise.
    pub threshold: Ends,
    /// Of what the plan costs per unit of time, at the interval and threshold that it says.
    pub cost_rate: Ends,
}

/// Intervals of probability `level` around a plan of looks; parts fail at wear `failure`. What is given of the plan is kept: interval,
/// threshold. The cheapest plan of each life is its own, wherever it lies. None as in [`age_bands`].
pub fn look_bands(
    lives: &[FirstPassage],
    failure: f64,
    (costs, looks): (&Costs, &Looks),
    (plan, is_given): (&ConditionPlan, [bool; 2]),
    level: f64,
) -> Option<LookBands> {
    let parts: Vec<Monitored> = lives
        .iter()
        .filter_map(|life| Monitored::new(*life.law(), life.clock().clone(), failure).ok())
        .collect();
    let given = [plan.interval, plan.threshold].into_iter().zip(is_given);
    let given: Vec<Option<f64>> = given.map(|(value, is_given)| is_given.then_some(value)).collect();
    let one = |part: &Monitored| -> Result<[f64; 3], PlanError> {
        let own = part.cost(costs, looks, plan.interval, plan.threshold)?.rate;
        let (interval, threshold) = cheapest(part, (costs, looks), (given[0], given[1]))?;
        Ok([interval, threshold, own])
    };
    let [intervals, thresholds, rates] = sorted(&on_threads(&parts, &one), lives.len())?;
    Some(LookBands {
        interval: ends(&intervals, level),
        threshold: ends(&thresholds, level),
        cost_rate: ends(&rates, level),
    })
}

/// Cost per unit of time by the age of replacement: age, cost by the estimate, what the lives leave open of it.
pub type Course = Vec<(f64, f64, Option<Ends>)>;

/// The course of the cost over ages; without lives as by the estimate alone.
///
/// # Errors
/// As [`age_cost_rate`].
pub fn age_course(
    life: &dyn Lifetime,
    lives: &[FirstPassage],
    (costs, ages): (&Costs, &[f64]),
    level: f64,
) -> Result<Course, PlanError> {
    let one = |age: f64| {
        let rates = lives.iter().filter_map(|life| age_cost_rate(life, costs, age).ok());
        let rates: Vec<[f64; 1]> = rates.map(|rate| [rate]).collect();
        let band = sorted(&rates, lives.len()).map(|[rates]| ends(&rates, level));
        Ok((age, age_cost_rate(life, costs, age)?, band))
    };
    ages.iter().copied().map(one).collect()
}

/// What `one` says of the lives that it can be asked of, in any order: ends of intervals do not know it.
fn on_threads<T: Sync, const N: usize>(
    lives: &[T],
    one: &(dyn Fn(&T) -> Result<[f64; N], PlanError> + Sync),
) -> Vec<[f64; N]> {
    let next = AtomicUsize::new(0);
    let found = Mutex::new(Vec::with_capacity(lives.len()));
    let work = || {
        while let Some(life) = lives.get(next.fetch_add(1, Ordering::Relaxed)) {
            if let Ok(values) = one(life) {
                found.lock().unwrap_or_else(PoisonError::into_inner).push(values);
            }
        }
    };
    thread::scope(|scope| {
        let threads = thread::available_parallelism().map_or(1, NonZero::get).min(lives.len());
        // A system that gives no more threads gives time.
        let _ = (1..threads).take_while(|_| thread::Builder::new().spawn_scoped(scope, work).is_ok()).count();
        work();
    });
    found.into_inner().unwrap_or_else(PoisonError::into_inner)
}

/// What was found of so many lives, number by number, ascending; none if too many are missing.
fn sorted<const N: usize>(found: &[[f64; N]], count: usize) -> Option<[Vec<f64>; N]> {
    let missing = count.saturating_sub(found.len()) as f64;
    if found.is_empty() || missing > LEFT_OUT * count as f64 {
        return None;
    }
    Some(std::array::from_fn(|at| {
        let mut values: Vec<f64> = found.iter().map(|values| values[at]).collect();
        values.sort_by(f64::total_cmp);
        values
    }))
}

fn ends(sorted: &[f64], level: f64) -> Ends {
    let tail = 0.5 - 0.5 * level;
    // Between a number and infinity there is none.
    let at =
        |p: f64| Some(sorted_quantile(sorted, p)).filter(|value| !value.is_nan()).unwrap_or(f64::INFINITY);
    (at(tail), at(1.0 - tail))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::life::{Estimate, OperatingState};
    use crate::process::Gamma;

    fn lives(rates: &[f64]) -> Vec<FirstPassage> {
        let state = OperatingState::new(50.0).expect("valid");
        let life = |rate: &f64| {
            let estimate = Estimate::new(&Gamma, [2.0 * rate, 2.0], None).expect("valid");
            state.life(&estimate).expect("valid")
        };
        rates.iter().map(life).collect()
    }

    #[test]
    fn ages_and_costs_of_faster_wear_are_the_ends() {
        let costs = Costs::new(1.0, 8.0).expect("valid");
        let lives = lives(&[0.5, 1.0, 2.0]);
        let plan = best_age(&lives[1], &costs).expect("a plan");
        let bands = age_bands(&lives, &costs, &plan, 1.0).expect("lives");
        let of = |at: usize| best_age(&lives[at], &costs).expect("a plan");
        assert_eq!(bands.age, (of(2).age.expect("pays"), of(0).age.expect("pays")));
        assert_eq!(bands.failure_only, (of(0).failure_only, of(2).failure_only));
        assert_eq!(bands.pays, 1.0);
        // The same age costs less where wear is slow, and nearly a failure each where it is twice as fast.
        let own = |at: usize| age_cost_rate(&lives[at], &costs, plan.age.expect("pays")).expect("valid");
        assert_eq!(bands.cost_rate, (own(0), own(2)));
        assert!(own(0) < own(1) && own(2) > 5.0 * own(1));
    }

    #[test]
    fn a_law_for_which_no_age_pays_leaves_the_age_open() {
        let costs = Costs::new(4.0, 8.0).expect("valid");
        // The first is a part that fails by one jump at any time: no age pays.
        let state = OperatingState::new(50.0).expect("valid");
        let jump = Estimate::new(&Gamma, [1e-3, 1e-3], None).expect("valid");
        let lives = [vec![state.life(&jump).expect("valid")], lives(&[1.0])].concat();
        let plan = best_age(&lives[1], &costs).expect("a plan");
        let bands = age_bands(&lives, &costs, &plan, 0.95).expect("lives");
        assert_eq!((bands.age.1, bands.pays), (f64::INFINITY, 0.5));
        assert!(age_bands(&[], &costs, &plan, 0.95).is_none());
    }
}
