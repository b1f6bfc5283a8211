//! The cheapest interval and threshold of looks. In: wear of a part, costs. Out: a plan. Never knows how a plan's cost is found.

use super::condition::{ConditionCost, Monitored};
use super::condition_levels::{SAME, least_rate};
use super::costs::{Costs, Looks};
use super::error::PlanError;
use super::search::least;
use crate::error::positive;
use crate::life::Lifetime;

/// Part of the cost below which nothing is left to gain.
const ACCURACY: f64 = 1e-7;
/// The interval is looked for between the mean life over the first and times the second.
const INTERVALS: (f64, f64) = (64.0, 3.0);
/// Ratios from interval to interval of the first search, from the mean life over this on and below it: a plan of one look is cheap within
/// a few percent of its interval, and next to it one of two looks; many looks hardly differ from one more.
const RATIOS: [f64; 2] = [1.1, 1.25];
const MANY_LOOKS: f64 = 8.0;
/// Thresholds of the first search, closer to each other near failure.
const LEVELS: usize = 32;
/// Cheapest intervals among their neighbours that are looked at closely, by cost beside the least.
const RIVALS: usize = 3;
const NEARLY_BEST: f64 = 1.05;
/// Where that ends, in the logarithm of the interval: a plan is worth the same then.
const CLOSE: f64 = 0.01;
/// Turns of the search along both; each at least halves what is left to gain.
const TURNS: usize = 6;
/// Wear below the threshold of failure at which replacements are tried, as a part of it.
const LOWEST: f64 = 0.02;

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
    let grid = Grid::new(part, interval, threshold)?;
    // One that is given is taken as it is, digit by digit.
    let told = |log: f64| interval.unwrap_or_else(|| libm::exp(log));
    // The most looks that a life can have: if they can be counted, all can.
    part.cost(costs, looks, told(grid.logs[0]), grid.levels[grid.levels.len() - 1])?;
    let rate = |log: f64, level: f64| part.rate((costs, looks), libm::exp(log), level);
    let tops = grid.rivals(part, (costs, looks));
    let known = tops.into_iter().map(|(_, log, level)| (rate(log, level), log, level));
    let mut best =
        known.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((f64::INFINITY, grid.logs[0], part.failure()));
    let Grid { logs, levels, .. } = &grid;
    for _ in 0..TURNS {
        let before = best.0;
        if interval.is_none() {
            let (log, found) = least(&around(logs, best.1), &mut |log| rate(log, best.2));
            if found < best.0 {
                best = (found, log, best.2);
            }
        }
        if threshold.is_none() {
            let (level, found) = least(&around(levels, best.2), &mut |level| rate(best.1, level));
            if found < best.0 {
                best = (found, best.1, level);
            }
        }
        if before - best.0 <= ACCURACY * before {
            break;
        }
    }
    if threshold.is_none() {
        best.2 = highest(best, levels[grid.first], part.failure(), &rate);
    }
    let (_, log, threshold) = best;
    let near = |end: Option<&f64>| end.is_some_and(|end| (log - end).abs() < 1e-3);
    let chosen = told(log);
    Ok(ConditionPlan {
        interval: chosen,
        threshold,
        cost: part.cost(costs, looks, chosen, threshold)?,
        at_an_end: interval.is_none() && (near(logs.first()) || near(logs.last())),
    })
}

/// Of thresholds that cost the same, as the lowest does, the highest.
fn highest(best: (f64, f64, f64), lowest: f64, failure: f64, rate: &dyn Fn(f64, f64) -> f64) -> f64 {
    let same = (1.0 + SAME) * best.0;
    if rate(best.1, lowest) > same {
        return best.2;
    }
    let (mut low, mut high) = (best.2, failure);
    while high - low > 1e-4 * failure {
        let middle = 0.5 * (low + high);
        if rate(best.1, middle) <= same { low = middle } else { high = middle }
    }
    low
}

/// Interval and threshold of the least cost, each as it is given, good to a percent or so.
///
/// # Errors
/// [`PlanError`].
pub(super) fn cheapest(
    part: &Monitored,
    asked: (&Costs, &Looks),
    (interval, threshold): (Option<f64>, Option<f64>),
) -> Result<(f64, f64), PlanError> {
    let rivals = Grid::new(part, interval, threshold)?.rivals(part, asked);
    let best = rivals.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
    let (_, log, level) = best.ok_or(PlanError::TooOften { interval: interval.unwrap_or(0.0), looks: 0 })?;
    Ok((interval.unwrap_or_else(|| libm::exp(log)), threshold.unwrap_or(level)))
}

/// Where the first search looks.
struct Grid {
    /// Logarithms of intervals, ascending.
    logs: Vec<f64>,
    /// Wear at looks, ascending.
    levels: Vec<f64>,
    /// The first level that may be a threshold.
    first: usize,
}

impl Grid {
    fn new(part: &Monitored, interval: Option<f64>, threshold: Option<f64>) -> Result<Self, PlanError> {
        let logs = match interval {
            Some(interval) => vec![libm::log(interval)],
            None => {
                let mean = part.life()?.moments()?.mean;
                let (low, few, high) = (mean / INTERVALS.0, mean / MANY_LOOKS, mean * INTERVALS.1);
                let even = |(low, high): (f64, f64), ratio: f64| {
                    let count = libm::ceil(libm::log(high / low) / libm::log(ratio)).max(1.0);
                    (0..)
                        .map(f64::from)
                        .take_while(move |at| *at < count)
                        .map(move |at| libm::log(low) + libm::log(high / low) * at / count)
                };
                let [few_looks, many] = RATIOS;
                even((low, few), many).chain(even((few, high), few_looks)).chain([libm::log(high)]).collect()
            }
        };
        // Half as far apart at the last as in the middle.
        let most = threshold.unwrap_or(part.failure());
        let level = |at: usize| {
            let left = 1.0 - (at as f64 + 1.0) / LEVELS as f64;
            most * (1.0 - 0.5 * left * (1.0 + left))
        };
        let levels: Vec<f64> = (0..LEVELS).map(level).collect();
        let first = match threshold {
            Some(_) => LEVELS - 1,
            None => levels.partition_point(|level| *level < LOWEST * most),
        };
        Ok(Self { logs, levels, first })
    }

    /// The cheapest intervals among their neighbours: cost, logarithm of the interval, threshold.
    fn rivals(&self, part: &Monitored, asked: (&Costs, &Looks)) -> Vec<(f64, f64, f64)> {
        let Self { logs, levels, first } = self;
        let at = |log: f64| least_rate(part, asked, libm::exp(log), (levels, *first));
        let found: Vec<(f64, f64)> = logs.iter().map(|log| at(*log)).collect();
        let rate = |at: usize| found.get(at).map_or(f64::INFINITY, |found| found.0);
        let least = (0..logs.len()).map(rate).fold(f64::INFINITY, f64::min);
        let is_top = |at: &usize| {
            rate(*at) <= rate(at + 1)
                && at.checked_sub(1).is_none_or(|before| rate(*at) < rate(before))
                && rate(*at) <= NEARLY_BEST * least
        };
        let mut tops: Vec<usize> = (0..logs.len()).filter(is_top).collect();
        tops.sort_by(|a, b| rate(*a).total_cmp(&rate(*b)));
        tops.truncate(RIVALS);
        let closely = |top: usize| {
            let mut near = (rate(top), logs[top], found[top].1);
            let ends = [top.saturating_sub(1), (top + 1).min(logs.len() - 1)].map(|at| logs[at]);
            let mut width = 0.5 * (ends[1] - ends[0]);
            while width > CLOSE {
                width *= 0.5;
                for log in [near.1 - width, near.1 + width] {
                    let (rate, level) = at(log.clamp(ends[0], ends[1]));
                    if rate < near.0 {
                        near = (rate, log.clamp(ends[0], ends[1]), level);
                    }
                }
            }
            near
        };
        tops.into_iter().map(closely).collect()
    }
}

/// The point and its neighbours on the grid.
fn around(grid: &[f64], at: f64) -> Vec<f64> {
    let above = grid.partition_point(|x| *x <= at).min(grid.len() - 1);
    let below = grid.partition_point(|x| *x < at).saturating_sub(1);
    let mut near = vec![grid[below], at, grid[above]];
    near.dedup();
    near
}
