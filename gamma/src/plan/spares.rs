//! Spare parts for a fleet over a time. In: law of the time in use, standstills, parts, time. Out: how many replacements there will be,
//! and how many spares are enough with a given probability. Never knows wear, costs.
//!
//! Replacements of one part are a renewal process: the k-th comes after k lives with k - 1 standstills between them, whose law is a
//! convolution. Those of a fleet are a sum over its parts.

use super::error::PlanError;
use crate::error::{LifeError, non_negative, positive, probability};
use crate::life::Lifetime;

use super::age::PlannedLife;

/// Steps within a standard deviation of the lives, over which they are convolved. The rule of trapezia is exact to the square
/// of a step: for exponential lives, ten of them within the time, probabilities come out to 1e-6.
const STEPS: f64 = 20.0;
/// Steps at least and at most; at most, one convolution takes 20 ms.
const STEPS_BETWEEN: (f64, f64) = (1000.0, 8000.0);
/// Standard deviations of a normal law between its quartiles.
const QUARTILES: f64 = 1.349;
/// Smallest standard deviation that is resolved, as a part of the median. Of a narrower law the mean is kept.
const NARROWEST: f64 = 0.04;
/// Part of the lives that end within a step from which on its middle is not where they end: a normal law that is resolved has 0.02.
const MUCH: f64 = 0.03;
/// Halvings of such a step at most: its lives end within a thousandth of it.
const HALVINGS: u32 = 10;
/// Part of a step by which a replacement may come after the end and counts: the end may be a whole number of ages, but for rounding.
const AT_THE_END: f64 = 1e-6;
/// Probability of more replacements that is left out, of one part and of the fleet.
const LEFT_OUT: f64 = 1e-12;
/// Replacements of one part that are still counted.
const MOST: usize = 100;
/// Most parts that spares are planned for.
pub const FLEET: usize = 1_000_000;

/// Replacements of a fleet within a time.
#[derive(Clone, Debug, PartialEq)]
pub struct Spares {
    /// Expected number.
    pub mean: f64,
    /// Smallest number that is enough with at least the probability asked for.
    pub needed: usize,
    /// Probability that so many are enough.
    pub enough: f64,
    /// Probability of `first + i` replacements.
    pub counts: Vec<f64>,
    /// The first number in `counts`.
    pub first: usize,
}

/// How long a replacement takes, while nothing wears, in the unit of the life.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Standstill {
    /// One at the age that is planned.
    pub preventive: f64,
    /// One after a failure.
    pub failure: f64,
}

/// Replacements of `parts` parts, all new at the start, within `time`, and the spares that are enough with probability
/// `confidence`.
///
/// # Errors
/// [`PlanError::Life`] for a time, a standstill or a probability out of range, [`PlanError::NoParts`], [`PlanError::TooMany`].
pub fn spares(
    life: &PlannedLife<'_>,
    standstill: Standstill,
    (parts, time): (usize, f64),
    confidence: f64,
) -> Result<Spares, PlanError> {
    positive("the time planned for", time)?;
    non_negative("the time of a planned replacement", standstill.preventive)?;
    non_negative("the standstill after a failure", standstill.failure)?;
    probability(confidence)?;
    let too_many = |each| PlanError::TooMany { parts, each };
    if parts == 0 {
        return Err(PlanError::NoParts);
    }
    if parts > FLEET {
        return Err(too_many(0));
    }
    let one = replacements(life, standstill, time)?.ok_or(too_many(MOST))?;
    let mean_of_one: f64 = one.iter().enumerate().map(|(k, p)| k as f64 * p).sum();
    let fleet = many(Counts { first: 0, of: one }, parts);
    let (mut enough, mut needed) = (0.0, fleet.first + fleet.of.len().saturating_sub(1));
    for (at, p) in fleet.of.iter().enumerate() {
        enough += p;
        if enough >= confidence {
            needed = fleet.first + at;
            break;
        }
    }
    Ok(Spares {
        mean: mean_of_one * parts as f64,
        needed,
        enough: enough.min(1.0),
        counts: fleet.of,
        first: fleet.first,
    })
}

/// Probabilities of 0, 1, 2, .. replacements of one part within `time`; None if they are too many.
fn replacements(
    life: &PlannedLife<'_>,
    standstill: Standstill,
    time: f64,
) -> Result<Option<Vec<f64>>, LifeError> {
    let spread = (life.quantile(0.75)? - life.quantile(0.25)?) / QUARTILES;
    let median = life.quantile(0.5)?;
    // A life of half of the parts and what comes behind it.
    let planned = life.age.is_some_and(|age| life.life.reliability(age) >= 0.5);
    if time > MOST as f64 * (median + if planned { standstill.preventive } else { standstill.failure }) {
        return Ok(None);
    }
    let spread = spread.max(NARROWEST * median);
    let coarsest = time / (STEPS * time / spread).clamp(STEPS_BETWEEN.0, STEPS_BETWEEN.1);
    // From one planned replacement to the next there are whole steps: all parts are replaced at one age, and what that is off adds up.
    let turn = life.age.map(|age| age + standstill.preventive).filter(|turn| *turn >= coarsest);
    let step = turn.map_or(coarsest, |turn| turn / (turn / coarsest).ceil());
    // Times count from the end back, which they meet with both.
    let steps = (time / step) as usize;
    let times = (0..=steps).map(|i| time - step * (steps - i) as f64 + AT_THE_END * step);
    // Probability that the k-th replacement comes until each of them. The first counts when it begins, before its standstill.
    let mut before: Vec<f64> = times.map(|t| life.failed(t)).collect();
    let mut counts = vec![1.0 - before[steps]];
    let ended = between_replacements(life, standstill, step, steps);
    for k in 1.. {
        if before[steps] < LEFT_OUT {
            break;
        }
        if k > MOST {
            return Ok(None);
        }
        let mut after = vec![0.0; steps + 1];
        for (j, part) in ended.iter().enumerate().filter(|(_, part)| **part > 0.0) {
            for (sum, left) in after[j..].iter_mut().zip(&before) {
                *sum += part * left;
            }
        }
        counts.push((before[steps] - after[steps]).max(0.0));
        before = after;
    }
    Ok(Some(counts))
}

/// Probability that from one replacement to the next there are 0, 1, .. steps: a life and the standstill before it. What ends between
/// two whole numbers is shared so that its mean is kept: the rule of trapezia.
fn between_replacements(life: &PlannedLife<'_>, standstill: Standstill, step: f64, steps: usize) -> Vec<f64> {
    let mut ended = vec![0.0; steps + 1];
    let mut add = |after: f64, part: f64| {
        let (whole, rest) = (after.floor() as usize, after - after.floor());
        for (place, share) in [(whole, 1.0 - rest), (whole.saturating_add(1), rest)] {
            if let Some(sum) = ended.get_mut(place) {
                *sum += share * part;
            }
        }
    };
    let age = life.age.unwrap_or(f64::INFINITY);
    let mut from = (0.0, 0.0);
    for i in 1..=steps + 1 {
        let t = age.min(step * i as f64);
        let to = (t, life.life.failed(t));
        add((middle(life, from, to, HALVINGS) + standstill.failure) / step, to.1 - from.1);
        from = to;
        if t >= age {
            add((age + standstill.preventive) / step, life.life.reliability(age));
            break;
        }
    }
    ended
}

/// When those fail, in the mean, that fail between two times, each with the part that has failed until then.
fn middle(life: &PlannedLife<'_>, from: (f64, f64), to: (f64, f64), halvings: u32) -> f64 {
    let (half, part) = (0.5 * (from.0 + to.0), to.1 - from.1);
    if part < MUCH || halvings == 0 {
        return half;
    }
    let at = (half, life.life.failed(half));
    let [first, second] = [(from, at), (at, to)].map(|(from, to)| middle(life, from, to, halvings - 1));
    (first * (at.1 - from.1) + second * (to.1 - at.1)) / part
}

/// Probabilities of `first`, `first + 1`, ..
#[derive(Clone)]
struct Counts {
    first: usize,
    of: Vec<f64>,
}

/// Of the sum over `parts` independent parts, by doubling.
fn many(one: Counts, parts: usize) -> Counts {
    let mut sum = Counts { first: 0, of: vec![1.0] };
    let (mut doubled, mut left) = (one, parts);
    loop {
        if left & 1 == 1 {
            sum = added(&sum, &doubled);
        }
        left >>= 1;
        if left == 0 {
            return sum;
        }
        doubled = added(&doubled, &doubled);
    }
}

/// Of a sum of two; tails without weight are left out.
fn added(a: &Counts, b: &Counts) -> Counts {
    let mut of = vec![0.0; a.of.len() + b.of.len() - 1];
    for (i, p) in a.of.iter().enumerate() {
        for (j, q) in b.of.iter().enumerate() {
            of[i + j] += p * q;
        }
    }
    let mut first = a.first + b.first;
    let tail = |values: &mut dyn Iterator<Item = &f64>| {
        let mut weight = 0.0;
        values
            .take_while(|p| {
                weight += **p;
                weight < LEFT_OUT
            })
            .count()
    };
    let (head, end) = (tail(&mut of.iter()), tail(&mut of.iter().rev()));
    of.truncate(of.len() - end.min(of.len() - 1));
    of.drain(..head.min(of.len() - 1));
    first += head;
    Counts { first, of }
}
