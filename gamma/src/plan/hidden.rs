//! Looking at parts whose failure only a look finds, by their law of life alone. In: a law of life, costs. Out: cost per unit of time
//! with its parts; the best interval. Never knows wear.
//!
//! A part is looked at every tau. One that has failed is replaced; one that works stays, or is replaced as well at the n-th look:
//!
//! ```text
//!         c_i sum_(k<n) S(k tau) + c_d D + c_p S(n tau) + c_f F(n tau)
//! C = -----------------------------------------------------------------      D = tau sum_(k<n) S(k tau) - int_0^(n tau) S dt
//!            tau sum_(k<n) S(k tau) + t_p S(n tau) + t_f F(n tau)
//! ```
//!
//! Without an n: R. E. Barlow, F. Proschan, Mathematical Theory of Reliability (1965), chapter 4.3. With n = 1, and costs that are times,
//! C is what lacks of the availability of equipment for emergencies, as A. K. S. Jardine, A. H. C. Tsang, Maintenance, Replacement and
//! Reliability, chapter 3, have it.

use super::condition::ConditionCost;
use super::costs::{Costs, Looks};
use super::error::PlanError;
use super::mean_use::MeanUse;
use super::search::least;
use crate::error::positive;
use crate::life::Lifetime;

/// Parts that are still in use after so many looks are too few to count.
const GONE: f64 = 1e-10;
/// Looks of one cycle; more come only with an interval far below every life.
const MOST: usize = 20_000;
/// The interval is looked for between the mean life over the first and times the second.
const INTERVALS: (f64, f64) = (256.0, 3.0);
/// Intervals of the first search.
const TRIED: usize = 24;
/// The look at which parts that work are replaced is sought upwards, until so many in a row cost more than the one before, ...
const RISES: usize = 3;
/// ... or less than this part of them comes so far, and replacing these hardly differs from never doing it; ...
const SELDOM: f64 = 1e-2;
/// ... or here: intervals are not shorter than the mean life over [`INTERVALS`], and later parts have failed.
const LOOKS: usize = 512;
/// What a replacement of parts that work must save, as a part: less is rounding.
const SAVED: f64 = 1e-9;

/// A plan of looks by which failures are found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HiddenPlan {
    /// Time from look to look.
    pub interval: f64,
    /// The look at which a part is replaced that still works; None: only what has failed is replaced.
    pub last: Option<usize>,
    /// What it costs.
    pub cost: ConditionCost,
    /// Whether the interval is at an end of the range that was searched.
    pub at_an_end: bool,
}

/// Cost of looking every `interval`, and of replacing parts that still work at look `last`.
///
/// # Errors
/// [`PlanError::Life`] for an interval out of range, [`PlanError::ShowsAtOnce`], [`PlanError::TooOften`].
pub fn hidden_cost(
    life: &dyn Lifetime,
    costs: &Costs,
    looks: &Looks,
    interval: f64,
    last: Option<usize>,
) -> Result<ConditionCost, PlanError> {
    positive("the interval", interval)?;
    let downtime = looks.downtime.ok_or(PlanError::ShowsAtOnce)?;
    let most = last.unwrap_or(MOST).max(1);
    let (mut looked, mut alive, mut count) = (0.0, 1.0, 0);
    while count < most && alive >= GONE {
        looked += alive;
        count += 1;
        alive = life.reliability(interval * count as f64);
    }
    if last.is_none() && alive >= GONE {
        return Err(PlanError::TooOften { interval, looks: MOST });
    }
    let end = interval * count as f64;
    let (fail, used) = (life.failed(end), MeanUse::new(life, life.accuracy()).until(end));
    let unnoticed = (interval * looked - used).max(0.0);
    let cost =
        looks.inspection * looked + downtime * unnoticed + costs.preventive * alive + costs.failure * fail;
    let cycle = interval * looked + costs.preventive_time * alive + costs.failure_time * fail;
    Ok(ConditionCost { rate: cost / cycle, cycle, looks: looked, fail, unnoticed })
}

/// The cheapest interval, and the look at which parts that work are replaced if that pays; `interval` may be given.
///
/// # Errors
/// As [`hidden_cost`]; a look that costs nothing is refused, because looking without end would be best.
pub fn best_hidden(
    life: &dyn Lifetime,
    costs: &Costs,
    looks: &Looks,
    interval: Option<f64>,
) -> Result<HiddenPlan, PlanError> {
    positive("the cost of an inspection", looks.inspection)?;
    let mean = life.moments()?.mean;
    let ends = (mean / INTERVALS.0, mean * INTERVALS.1);
    let step = libm::log(ends.1 / ends.0) / (TRIED - 1) as f64;
    let logs = match interval {
        Some(interval) => vec![libm::log(interval)],
        None => (0..TRIED).map(|at| libm::log(ends.0) + step * at as f64).collect(),
    };
    // One that is given is taken as it is, digit by digit.
    let told = |log: f64| interval.unwrap_or_else(|| libm::exp(log));
    let best_of = |last: Option<usize>| -> Result<HiddenPlan, PlanError> {
        // The most looks that a life can have: if they can be counted, all can.
        hidden_cost(life, costs, looks, told(logs[0]), last)?;
        let rate = |log: f64| {
            hidden_cost(life, costs, looks, told(log), last).map_or(f64::INFINITY, |cost| cost.rate)
        };
        let log = least(&logs, &mut |log| rate(log)).0;
        let chosen = told(log);
        let near = |end: f64| (chosen / end - 1.0).abs() < 1e-3;
        let cost = hidden_cost(life, costs, looks, chosen, last)?;
        Ok(HiddenPlan {
            interval: chosen,
            last,
            cost,
            at_an_end: interval.is_none() && (near(ends.0) || near(ends.1)),
        })
    };
    let mut best = best_of(None)?;
    let (mut before, mut rises) = (f64::INFINITY, 0);
    for last in 1..=LOOKS {
        let found = best_of(Some(last))?;
        if found.cost.rate < best.cost.rate * (1.0 - SAVED) {
            best = found;
        }
        rises = if found.cost.rate >= before { rises + 1 } else { 0 };
        before = found.cost.rate;
        if rises == RISES || 1.0 - found.cost.fail < SELDOM {
            break;
        }
    }
    Ok(best)
}
