//! The parametric bootstrap. In: a fit, a seed. Out: estimates of data drawn from it, and with them intervals
//! and p-values. Never knows files.
//!
//! P-values of goodness of fit come from here and not from tables: the parameters were estimated from the same data,
//! and the tables of Kolmogorov would then call bad fits good.

use std::ops::Range;

use rand::RngExt;
use rand::distr::Open01;
use serde::{Deserialize, Serialize};

use super::error::FitError;
use super::estimate::{Fit, estimate_increments};
use super::goodness::goodness;
use super::heterogeneity::estimate_units;
use super::interval::Interval;
use crate::data::{Increment, Known, Observations, Rounding};
use crate::order::sorted_quantile;
use crate::random::{StandardNormal, Stream};

/// Replicates of an estimate.
#[derive(Clone, Debug, Default, Deserialize, PartialEq, Serialize)]
pub struct Bootstrap {
    /// [`Fit::parameters`] of each replicate that could be fitted.
    pub estimates: Vec<Vec<f64>>,
    /// Kolmogorov-Smirnov distance of each, against its own estimate.
    pub kolmogorov_smirnov: Vec<f64>,
    /// Anderson-Darling distance of each, against its own estimate.
    pub anderson_darling: Vec<f64>,
    /// Replicates without a maximum.
    pub failed: usize,
}

/// Units drawn for one that enters.
const MOST_UNITS: u32 = 100_000;

/// Draws data from the fit, with the spans, covariates and gauge of the observations, and estimates again.
/// Replicate r draws from [`Stream::new`]`(seed, r, 0)`, increment i at cycle i, what differs between units from
/// `(seed, r, 1 + unit)`: replicates may be drawn in parts, by their numbers. Of data with bounds of wear every replicate fails: which
/// readings would have been bounds in drawn data nobody knows.
pub fn bootstrap(fit: &Fit, observations: &Observations, replicates: Range<u64>, seed: u64) -> Bootstrap {
    let mut drawn = Bootstrap::default();
    if observations.has_bounds() {
        drawn.failed = replicates.count();
        return drawn;
    }
    for replicate in replicates {
        let increments = draw(fit, &observations.increments, seed, replicate);
        match again(fit, observations, &increments) {
            Ok(again) => {
                let distances = goodness(&again, &increments, seed ^ replicate);
                let mut parameters = again.parameters();
                // No difference found.
                parameters.resize(fit.model.parameters(), 0.0);
                drawn.estimates.push(parameters);
                drawn.kolmogorov_smirnov.push(distances.kolmogorov_smirnov);
                drawn.anderson_darling.push(distances.anderson_darling);
            }
            Err(_) => drawn.failed += 1,
        }
    }
    drawn
}

/// The estimate of drawn data.
fn again(fit: &Fit, observations: &Observations, increments: &[Increment]) -> Result<Fit, FitError> {
    if !fit.model.units_differ {
        return estimate_increments(increments, &fit.model, Some(&fit.phi));
    }
    let drawn = Observations { units: observations.units.clone(), increments: increments.to_vec() };
    estimate_units(&drawn, &fit.model).map(|found| found.fit)
}

/// A seed that goes by the data: errors of what is drawn beside them must not be the same for all data.
pub(super) fn own_seed(seed: u64, like: &[Increment]) -> u64 {
    // Multiplied as by D. Knuth's hash, so that a step more in one reading gives other numbers.
    let mixed = |seed: u64, one: &Increment| {
        (seed ^ one.wear.to_bits()).rotate_left(23).wrapping_mul(0x9e37_79b9_7f4a_7c15)
    };
    like.iter().fold(seed, mixed)
}

/// One data set of the estimated process; with a gauge's step, of its readings.
pub(super) fn draw(fit: &Fit, like: &[Increment], seed: u64, replicate: u64) -> Vec<Increment> {
    let mut stream = Stream::new(seed, replicate, 0);
    let process = fit.model.process;
    // True wear of the unit at hand, beside its first reading, and its reading in steps.
    let (mut level, mut last): (f64, f64) = (0.0, 0.0);
    let mut before: Option<&Increment> = None;
    let mut logs = fit.logs();
    // Wear at entry of a unit that was drawn until it might enter.
    let mut entered: Option<f64> = None;
    let drawn = like.iter().enumerate().map(|(at, increment)| {
        if before.is_none_or(|last| last.unit != increment.unit) {
            (logs, entered) = unit(fit, increment, seed, replicate);
        }
        if !increment.is_growth() {
            before = Some(increment);
            return increment.clone();
        }
        let own = fit.model.sized(&logs, fit.model.ln_size(&fit.phi, increment));
        let drawn = match entered.take() {
            Some(wear) => wear,
            None => process.draw(own, fit.lambda(increment), stream.at(at as u64)),
        };
        let wear = match fit.model.resolution {
            Some(Rounding { step, error }) => {
                let read = |level: f64, stream: &mut Stream| {
                    let off = if error > 0.0 { error * stream.sample(StandardNormal) } else { 0.0 };
                    libm::round((level + off) / step)
                };
                let is_other =
                    before.is_none_or(|last| last.unit != increment.unit || last.to != increment.from);
                if is_other || increment.known != Known::Exact {
                    let free = step * (stream.sample::<f64, _>(Open01) - 0.5);
                    let is_read = increment.from > 0.0 && increment.known != Known::FromLevel;
                    level = if is_read { free } else { 0.0 };
                    last = if is_read { read(level, &mut stream) } else { 0.0 };
                }
                level += drawn;
                let from = core::mem::replace(&mut last, read(level, &mut stream));
                step * (last - from)
            }
            // A wear too small for a double is as small as a double gets.
            None if process.is_increasing() => drawn.max(f64::MIN_POSITIVE),
            None => drawn,
        };
        before = Some(increment);
        Increment { wear, ..increment.clone() }
    });
    drawn.collect()
}

/// Logarithms of the parameters of a unit whose first increment or entry this is, and what it wore when it entered, if it was new
/// before: units that would not have entered are drawn again.
fn unit(fit: &Fit, first: &Increment, seed: u64, replicate: u64) -> ([f64; 2], Option<f64>) {
    let process = fit.model.process;
    let mut stream = Stream::new(seed, replicate, 1 + first.unit as u64);
    let mut own = || match (fit.cv(), process.random_effect()) {
        (Some(cv), Some(effect)) => effect.draw(fit.logs(), cv, &mut stream),
        _ => fit.logs(),
    };
    let Known::Entered { from_new } = first.known else { return (own(), None) };
    let mut draws = Stream::new(seed, replicate, u64::MAX - first.unit as u64);
    let ln_size = fit.model.ln_size(&fit.phi, first);
    for _ in 0..MOST_UNITS {
        let logs = own();
        let wear = process.draw(fit.model.sized(&logs, ln_size), fit.lambda(first), &mut draws);
        if wear < first.wear {
            return (logs, from_new.then_some(wear));
        }
    }
    // Hardly any unit enters: a replicate without an estimate.
    (fit.logs(), Some(f64::NAN))
}

impl Bootstrap {
    /// The replicates that come next.
    pub fn append(&mut self, next: Self) {
        self.estimates.extend(next.estimates);
        self.kolmogorov_smirnov.extend(next.kolmogorov_smirnov);
        self.anderson_darling.extend(next.anderson_darling);
        self.failed += next.failed;
    }

    /// How many were drawn.
    pub fn replicates(&self) -> usize {
        self.estimates.len() + self.failed
    }

    /// The basic interval (A. C. Davison, D. V. Hinkley, Bootstrap Methods (1997), 5.2) of parameter `index` of the fit: as far as
    /// replicates lie above the estimate the truth may lie below it, and the other way round; in logarithms of what is positive by its
    /// nature. Between quantiles of the replicates themselves an estimate that is too large on average would count twice. Where
    /// replicates find no difference between units the upper end is open. None without replicates.
    pub fn interval(&self, fit: &Fit, index: usize, level: f64) -> Option<Interval> {
        self.estimates.first()?;
        let is_logarithm = fit.model.is_logarithm(index);
        let phi = |value: f64| if is_logarithm { libm::log(value) } else { value };
        let mut values: Vec<f64> = self.estimates.iter().map(|estimate| phi(estimate[index])).collect();
        values.sort_by(f64::total_cmp);
        // Between a number and the logarithm of 0 there is none.
        let quantile =
            |p: f64| Some(sorted_quantile(&values, p)).filter(|q| !q.is_nan()).unwrap_or(f64::NEG_INFINITY);
        let mirrored = |p: f64| fit.model.natural(index, 2.0 * fit.phi[index] - quantile(p));
        let (low, high) = (mirrored(0.5 + 0.5 * level), mirrored(0.5 - 0.5 * level));
        // An exponent stands in phi as it is, but is positive.
        let is_exponent = fit.model.power_law && index == 2;
        Some(Interval { low: if is_exponent { low.max(0.0) } else { low }, high })
    }

    /// Mean of the replicates' parameter `index`; none without replicates.
    pub fn mean(&self, index: usize) -> Option<f64> {
        let count = self.estimates.len();
        (count > 0).then(|| self.estimates.iter().map(|estimate| estimate[index]).sum::<f64>() / count as f64)
    }

    /// Probability of a distance at least as large, (1 + number of them) / (1 + replicates).
    pub fn p_value(replicated: &[f64], seen: f64) -> f64 {
        let above = replicated.iter().filter(|value| **value >= seen).count();
        (1 + above) as f64 / (1 + replicated.len()) as f64
    }
}
