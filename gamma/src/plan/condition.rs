//! Looking at a part at even intervals, and replacing it when it is worn to a threshold below failure.
//! In: a law of wear that never falls, costs, interval and threshold. Out: cost per unit of time with its parts; the best
//! interval and threshold. Never knows how the law was estimated.
//!
//! A cycle begins with a new part. At look k, at time k tau, a part worn below M stays in use, between M and the threshold
//! of failure L it is replaced in time, beyond L it has failed. With X_k the wear at look k,
//!
//! ```text
//! S_k = P(X_k < M)              F_k = P(X_(k-1) < M, X_k >= L)              P_k = S_(k-1) - S_k - F_k
//! D   = sum_k int over interval k of P(X_(k-1) < M, X(t) >= L) dt           time in use after failure
//! ```
//!
//! The same policy is that of K. S. Park, Optimal wear-limit replacement with wear-dependent failures, IEEE Trans. Reliab. 37
//! (1988) 293-294, and of section 5 of J. M. van Noortwijk, A survey of the application of gamma processes in maintenance,
//! Reliab. Eng. Syst. Saf. 94 (2009) 2-21.

use super::costs::{Costs, Looks};
use super::error::PlanError;
use super::search::least;
use crate::error::{LifeError, positive};
use crate::life::{Clock, FirstPassage, Law, Lifetime};
use crate::quadrature::integrate;

/// Parts that are still in use after so many looks are too few to count.
const GONE: f64 = 1e-10;
/// Looks of one cycle; more come only with an interval far below every life.
const MOST: usize = 20_000;
/// Accuracy of a probability: costs of failures are some ten times those of looks, and plans are told to four digits.
const ACCURACY: f64 = 1e-7;
/// The interval is looked for between the mean life over the first and times the second.
const INTERVALS: (f64, f64) = (64.0, 3.0);
/// Points of the first search along the interval and along the threshold.
const TRIED: (usize, usize) = (14, 9);
/// Turns of the search along both; each at least halves what is left to gain.
const TURNS: usize = 4;
/// Wear below the threshold of failure at which replacements are tried, as parts of it.
const THRESHOLDS: (f64, f64) = (0.02, 1.0);

/// Wear of a part from new to failure.
#[derive(Clone, Debug)]
pub struct Monitored {
    law: Law,
    clock: Clock,
    failure: f64,
}

/// A plan of looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConditionPlan {
    /// Time from look to look.
    pub interval: f64,
    /// Wear from which a part is replaced \[unit of wear\].
    pub threshold: f64,
    /// What it costs.
    pub cost: ConditionCost,
    /// Whether the interval is at an end of the range that was searched: the cheapest plan looks still more often, or never.
    pub at_an_end: bool,
}

/// What a plan of looks costs and brings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConditionCost {
    /// Cost per unit of time.
    pub rate: f64,
    /// Mean length of a cycle, standstill included \[time\].
    pub cycle: f64,
    /// Looks in a cycle, mean.
    pub looks: f64,
    /// Share of cycles that end with a failure.
    pub fail: f64,
    /// Mean time in a cycle with a failure that nobody has noticed \[time\]; 0 where it is noticed at once.
    pub unnoticed: f64,
}

/// Refuses a law by which the wear at a look does not say all that there is to know of a part.
pub(super) fn known_by_its_wear(law: &Law) -> Result<(), PlanError> {
    match (law.is_increasing(), law.units_differ()) {
        (false, _) => Err(PlanError::FallingWear),
        (_, true) => Err(PlanError::UnitsDiffer),
        _ => Ok(()),
    }
}

impl Monitored {
    /// A new part that fails at wear `failure`.
    ///
    /// # Errors
    /// [`PlanError::FallingWear`], [`PlanError::UnitsDiffer`], [`PlanError::Life`] for a threshold that is not positive.
    pub fn new(law: Law, clock: Clock, failure: f64) -> Result<Self, PlanError> {
        positive("the threshold", failure)?;
        known_by_its_wear(&law)?;
        Ok(Self { law, clock, failure })
    }

    /// Its life if nobody looks.
    ///
    /// # Errors
    /// [`LifeError`].
    pub fn life(&self) -> Result<FirstPassage, LifeError> {
        FirstPassage::new(self.law, self.clock.clone(), self.failure)
    }

    /// Cost of a plan.
    ///
    /// # Errors
    /// [`PlanError::Life`] for an interval or threshold out of range, [`PlanError::TooOften`].
    pub fn cost(
        &self,
        costs: &Costs,
        looks: &Looks,
        interval: f64,
        threshold: f64,
    ) -> Result<ConditionCost, PlanError> {
        positive("the interval", interval)?;
        positive("the threshold of replacement", threshold)?;
        if threshold > self.failure {
            return Err(LifeError::Failed { threshold: self.failure, current: threshold }.into());
        }
        if self.law.survival(self.clock.exposure(interval * MOST as f64), threshold) >= GONE {
            return Err(PlanError::TooOften { interval, looks: MOST });
        }
        Ok(self.cycle(costs, looks, interval, threshold))
    }

    fn cycle(&self, costs: &Costs, looks: &Looks, interval: f64, threshold: f64) -> ConditionCost {
        let (mut use_time, mut unnoticed, mut looked, mut fail) = (0.0, 0.0, 0.0, 0.0);
        let mut alive = 1.0;
        for k in 0..MOST {
            let start = interval * k as f64;
            let (failed, late) = self.within(start, interval, threshold, alive);
            use_time += interval * alive - late;
            unnoticed += late;
            fail += failed;
            // What has failed at once is not looked at any more.
            looked += if looks.downtime.is_none() { alive - failed } else { alive };
            alive = self.law.survival(self.clock.exposure(start + interval), threshold);
            if alive < GONE {
                break;
            }
        }
        let preventive = 1.0 - fail;
        let mut cost = looks.inspection * looked + costs.preventive * preventive + costs.failure * fail;
        let mut cycle = use_time + costs.preventive_time * preventive + costs.failure_time * fail;
        match looks.downtime {
            Some(downtime) => {
                cost += downtime * unnoticed;
                cycle += unnoticed;
            }
            None => unnoticed = 0.0,
        }
        ConditionCost { rate: cost / cycle, cycle, looks: looked, fail, unnoticed }
    }

    /// Probability to be below `threshold` at `start` (which is `alive`) and beyond failure one interval later, and the mean
    /// time beyond failure within it.
    fn within(&self, start: f64, interval: f64, threshold: f64, alive: f64) -> (f64, f64) {
        let before = self.clock.exposure(start);
        let gained = |t: f64| (self.clock.exposure(start + t) - before).max(0.0);
        let whole = gained(interval);
        let from = |worn: f64| {
            let left = self.failure - worn;
            let failed = self.law.failure(whole, left);
            // What grows is never beyond its value at the end.
            if failed < ACCURACY {
                return [failed, 0.0];
            }
            let tolerance = [ACCURACY * interval];
            [failed, integrate(&|t| [self.law.failure(gained(t), left)], &[0.0, interval], tolerance).0[0]]
        };
        if before <= 0.0 {
            let [failed, late] = from(0.0);
            return (failed, late);
        }
        // Over probability, where the wear at the look is evenly spread; most that fail were near the threshold.
        let limits = [0.0, 0.5 * alive, 0.9 * alive, 0.99 * alive, alive];
        let at = |p: f64| from(self.law.quantile(before, p).clamp(0.0, threshold));
        let ([failed, late], _) = integrate(&at, &limits, [ACCURACY, ACCURACY * interval]);
        (failed, late)
    }
}

/// The cheapest interval and threshold; `interval` or `threshold` may be given.
///
/// # Errors
/// [`PlanError`]; a look that costs nothing is refused, because looking without end would be best.
pub fn best_inspection(
    part: &Monitored,
    costs: &Costs,
    looks: &Looks,
    interval: Option<f64>,
    threshold: Option<f64>,
) -> Result<ConditionPlan, PlanError> {
    positive("the cost of an inspection", looks.inspection)?;
    let mean = part.life()?.moments()?.mean;
    let ends = (mean / INTERVALS.0, mean * INTERVALS.1);
    let even = |(low, high): (f64, f64), count: usize| -> Vec<f64> {
        (0..count).map(|i| low + (high - low) * i as f64 / (count - 1) as f64).collect()
    };
    // Intervals in even ratios.
    let logs = interval.map_or_else(
        || even((libm::log(ends.0), libm::log(ends.1)), TRIED.0),
        |interval| vec![libm::log(interval)],
    );
    let levels = threshold.map_or_else(
        || even((THRESHOLDS.0 * part.failure, THRESHOLDS.1 * part.failure), TRIED.1),
        |threshold| vec![threshold],
    );
    // The most looks that a life can have: if they can be counted, all can.
    part.cost(costs, looks, libm::exp(logs[0]), levels[levels.len() - 1])?;
    let rate = |log: f64, level: f64| part.cycle(costs, looks, libm::exp(log), level).rate;
    let mut best = (f64::INFINITY, logs[0], levels[0]);
    for log in &logs {
        for level in &levels {
            let found = rate(*log, *level);
            if found < best.0 {
                best = (found, *log, *level);
            }
        }
    }
    for _ in 0..TURNS {
        let before = best.0;
        if interval.is_none() {
            let (log, found) = least(&around(&logs, best.1), &mut |log| rate(log, best.2));
            if found < best.0 {
                best = (found, log, best.2);
            }
        }
        if threshold.is_none() {
            let (level, found) = least(&around(&levels, best.2), &mut |level| rate(best.1, level));
            if found < best.0 {
                best = (found, best.1, level);
            }
        }
        if before - best.0 <= ACCURACY * before {
            break;
        }
    }
    let (_, log, threshold) = best;
    let near = |end: f64| (libm::exp(log) / end - 1.0).abs() < 1e-3;
    let chosen = libm::exp(log);
    Ok(ConditionPlan {
        interval: chosen,
        threshold,
        cost: part.cycle(costs, looks, chosen, threshold),
        at_an_end: interval.is_none() && (near(ends.0) || near(ends.1)),
    })
}

/// The point and its neighbours on the grid.
fn around(grid: &[f64], at: f64) -> Vec<f64> {
    let above = grid.partition_point(|x| *x <= at).min(grid.len() - 1);
    let below = grid.partition_point(|x| *x < at).saturating_sub(1);
    let mut near = vec![grid[below], at, grid[above]];
    near.dedup();
    near
}
