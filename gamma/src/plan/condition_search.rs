//! The cheapest interval and threshold of looks. In: wear of a part, costs. Out: a plan. Never knows how a plan's cost is found.

use super::condition::{ConditionCost, Monitored};
use super::costs::{Costs, Looks};
use super::error::PlanError;
use super::search::least;
use crate::error::positive;
use crate::life::Lifetime;

/// Part of the cost below which nothing is left to gain.
const ACCURACY: f64 = 1e-7;
/// The interval is looked for between the mean life over the first and times the second.
const INTERVALS: (f64, f64) = (64.0, 3.0);
/// Points of the first search along the interval and along the threshold.
const TRIED: (usize, usize) = (14, 9);
/// Turns of the search along both; each at least halves what is left to gain.
const TURNS: usize = 4;
/// Wear below the threshold of failure at which replacements are tried, as parts of it.
const THRESHOLDS: (f64, f64) = (0.02, 1.0);
/// Of the search nearby: first steps, of the logarithm of the interval and of the threshold over that of failure; where steps end.
const FIRST_STEPS: [f64; 2] = [0.25, 0.06];
const CLOSE: f64 = 0.02;
const MOST_TURNS: usize = 20;

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
        || even((THRESHOLDS.0 * part.failure(), THRESHOLDS.1 * part.failure()), TRIED.1),
        |threshold| vec![threshold],
    );
    // The most looks that a life can have: if they can be counted, all can.
    part.cost(costs, looks, libm::exp(logs[0]), levels[levels.len() - 1])?;
    let rate = |log: f64, level: f64| part.rate((costs, looks), libm::exp(log), level);
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
        cost: part.cost(costs, looks, chosen, threshold)?,
        at_an_end: interval.is_none() && (near(ends.0) || near(ends.1)),
    })
}

/// Interval and threshold of the least cost near a plan, each if it is free: by parabolas with steps that are halved until they are
/// below a hundredth of the interval and of the threshold of failure.
pub(super) fn nearby(
    part: &Monitored,
    asked: (&Costs, &Looks),
    from: (f64, f64),
    is_free: [bool; 2],
) -> (f64, f64) {
    let mut at = [libm::log(from.0), from.1];
    let mut steps = [FIRST_STEPS[0], FIRST_STEPS[1] * part.failure()];
    let lowest = THRESHOLDS.0 * part.failure();
    let rate = |at: [f64; 2]| match (lowest..=part.failure()).contains(&at[1]) {
        true => part.rate(asked, libm::exp(at[0]), at[1]),
        false => f64::INFINITY,
    };
    let mut best = rate(at);
    for _ in 0..MOST_TURNS {
        for k in (0..2).filter(|k| is_free[*k]) {
            let moved = |by: f64| {
                let mut next = at;
                next[k] += by;
                next
            };
            let (down, up) = (rate(moved(-steps[k])), rate(moved(steps[k])));
            if down.min(up) < best {
                at = moved(if down < up { -steps[k] } else { steps[k] });
                best = down.min(up);
                continue;
            }
            let bend = down + up - 2.0 * best;
            let shift =
                if bend > 0.0 && bend.is_finite() { 0.5 * steps[k] * (down - up) / bend } else { 0.0 };
            let there = rate(moved(shift));
            if there < best {
                (at, best) = (moved(shift), there);
            }
            steps[k] *= 0.4;
        }
        let is_done = |k: usize| !is_free[k] || steps[k] < CLOSE * if k == 0 { 1.0 } else { part.failure() };
        if is_done(0) && is_done(1) {
            break;
        }
    }
    (libm::exp(at[0]), at[1])
}

/// The point and its neighbours on the grid.
fn around(grid: &[f64], at: f64) -> Vec<f64> {
    let above = grid.partition_point(|x| *x <= at).min(grid.len() - 1);
    let below = grid.partition_point(|x| *x < at).saturating_sub(1);
    let mut near = vec![grid[below], at, grid[above]];
    near.dedup();
    near
}
