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
//! Where units differ, each of these is its mean over the law of the unit's own parameter: the cost of a cycle over its length is that
//! of both means. The threshold is the same for all units; what looks tell of the rate of one is not used.
//!
//! The same policy is that of K. S. Park, Optimal wear-limit replacement with wear-dependent failures, IEEE Trans. Reliab. 37
//! (1988) 293-294, and of section 5 of J. M. van Noortwijk, A survey of the application of gamma processes in maintenance,
//! Reliab. Eng. Syst. Saf. 94 (2009) 2-21.

use super::costs::{Costs, Looks};
use super::error::PlanError;
use crate::error::{LifeError, positive};
use crate::life::{Clock, FirstPassage, Law};
use crate::quadrature::integrate;

/// Parts that are still in use after so many looks are too few to count.
const GONE: f64 = 1e-10;
/// Looks of one cycle; more come only with an interval far below every life.
pub(super) const MOST: usize = 20_000;
/// Accuracy of a probability: costs of failures are some ten times those of looks, and plans are told to four digits.
const ACCURACY: f64 = 1e-7;
/// Failures between two looks that are passed over: a thousandth of what is told, over a hundred looks.
pub(super) const SKIPPED: f64 = 1e-9;
/// From place to place of what differs between units, in standard deviations and in its logarithm, where its law is summed over; ln
/// of its density below which no place counts: good to 1e-5 of a probability, and costs are told to four digits.
const SPACING: (f64, f64) = (1.0, 0.5);
const DEPTH: f64 = 12.0;
/// The same while the best plan is looked for: near it all cost the same.
const COARSE: (f64, f64, f64) = (1.4, 0.8, 8.0);

/// Wear of a part from new to failure.
#[derive(Clone, Debug)]
pub struct Monitored {
    law: Law,
    clock: Clock,
    failure: f64,
    /// Laws of units with the probabilities of each; one where units are alike.
    units: Vec<(f64, Law)>,
    /// The same, fewer.
    few: Vec<(f64, Law)>,
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

/// Sums over a cycle: time in use, time with a failure that nobody has noticed, looks, failures.
#[derive(Clone, Copy, Default)]
pub(super) struct Cycle {
    pub used: f64,
    pub unnoticed: f64,
    pub looked: f64,
    pub fail: f64,
}

impl Cycle {
    /// Adds such a part of another.
    pub fn add(&mut self, part: f64, other: Self) {
        self.used += part * other.used;
        self.unnoticed += part * other.unnoticed;
        self.looked += part * other.looked;
        self.fail += part * other.fail;
    }

    /// Adds an interval that begins with such a part of the units in use: by its end `failed` have failed, for a time of `late` in all.
    pub fn add_interval(&mut self, looks: &Looks, interval: f64, alive: f64, (failed, late): (f64, f64)) {
        self.used += interval * alive - late;
        self.unnoticed += late;
        self.fail += failed;
        // What has failed at once is not looked at any more.
        self.looked += if looks.downtime.is_none() { alive - failed } else { alive };
    }

    /// What it costs.
    pub fn cost(self, (costs, looks): (&Costs, &Looks)) -> ConditionCost {
        let Self { used, mut unnoticed, looked, fail } = self;
        let preventive = 1.0 - fail;
        let mut cost = looks.inspection * looked + costs.preventive * preventive + costs.failure * fail;
        let mut cycle = used + costs.preventive_time * preventive + costs.failure_time * fail;
        match looks.downtime {
            Some(downtime) => {
                cost += downtime * unnoticed;
                cycle += unnoticed;
            }
            None => unnoticed = 0.0,
        }
        ConditionCost { rate: cost / cycle, cycle, looks: looked, fail, unnoticed }
    }
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
    /// [`PlanError::FallingWear`], [`PlanError::Life`] for a threshold that is not positive.
    pub fn new(law: Law, clock: Clock, failure: f64) -> Result<Self, PlanError> {
        positive("the threshold", failure)?;
        if !law.is_increasing() {
            return Err(PlanError::FallingWear);
        }
        let units = law.units(SPACING, DEPTH);
        let few = law.units((COARSE.0, COARSE.1), COARSE.2);
        Ok(Self { law, clock, failure, units, few })
    }

    /// Wear at failure.
    pub(super) fn failure(&self) -> f64 {
        self.failure
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
    /// [`PlanError::Life`] for an interval or threshold that is not positive, [`PlanError::ReplacedTooLate`], [`PlanError::TooOften`].
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
            return Err(PlanError::ReplacedTooLate { from: threshold, failure: self.failure });
        }
        if self.law.survival(self.clock.exposure(interval * MOST as f64), threshold) >= GONE {
            return Err(PlanError::TooOften { interval, looks: MOST });
        }
        Ok(self.mean_cycle(&self.units, (costs, looks), interval, threshold))
    }

    /// The clock of its wear, and laws of units with the probabilities of each, for a search.
    pub(super) fn few(&self) -> (&Clock, &[(f64, Law)]) {
        (&self.clock, &self.few)
    }

    /// What a plan costs per unit of time, fast.
    pub(super) fn rate(&self, asked: (&Costs, &Looks), interval: f64, threshold: f64) -> f64 {
        self.mean_cycle(&self.few, asked, interval, threshold).rate
    }

    fn mean_cycle(
        &self,
        units: &[(f64, Law)],
        asked: (&Costs, &Looks),
        interval: f64,
        threshold: f64,
    ) -> ConditionCost {
        let mut mean = Cycle::default();
        for (part, law) in units {
            mean.add(*part, self.cycle(law, asked.1, interval, threshold));
        }
        mean.cost(asked)
    }

    /// Of units of one law.
    fn cycle(&self, law: &Law, looks: &Looks, interval: f64, threshold: f64) -> Cycle {
        let mut sums = Cycle::default();
        let mut alive = 1.0;
        for k in 0..MOST {
            let start = interval * k as f64;
            let failures = self.within(law, start, interval, (threshold, alive));
            sums.add_interval(looks, interval, alive, failures);
            alive = law.survival(self.clock.exposure(start + interval), threshold);
            if alive < GONE {
                break;
            }
        }
        sums
    }

    /// Probability to be below `threshold` at `start` (which is `alive`) and beyond failure one interval later, and the mean
    /// time beyond failure within it.
    fn within(&self, law: &Law, start: f64, interval: f64, (threshold, alive): (f64, f64)) -> (f64, f64) {
        let before = self.clock.exposure(start);
        let gained = |t: f64| self.clock.gained(start, t).max(0.0);
        let whole = gained(interval);
        // No more fail than have failed by then, nor than would if all were worn to the threshold.
        let most = law.failure(before + whole, self.failure);
        let most = most.min(alive * law.failure(whole, (self.failure - threshold).max(0.0)));
        if most < SKIPPED {
            return (0.0, 0.0);
        }
        let from = |worn: f64| {
            let left = self.failure - worn;
            let failed = law.failure(whole, left);
            // What grows is never beyond its value at the end.
            if failed < ACCURACY {
                return [failed, 0.0];
            }
            let tolerance = [ACCURACY * interval];
            [failed, integrate(&|t| [law.failure(gained(t), left)], &[0.0, interval], tolerance).0[0]]
        };
        if before <= 0.0 {
            let [failed, late] = from(0.0);
            return (failed, late);
        }
        // Over probability, where the wear at the look is evenly spread; most that fail were near the threshold.
        let limits = [0.0, 0.5 * alive, 0.9 * alive, 0.99 * alive, alive];
        let at = |p: f64| from(law.quantile(before, p).clamp(0.0, threshold));
        let ([failed, late], _) = integrate(&at, &limits, [ACCURACY, ACCURACY * interval]);
        (failed, late)
    }
}
