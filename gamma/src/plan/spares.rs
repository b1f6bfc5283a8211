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
/// Smallest standard deviation that is resolved, as a part of the median: what is narrower, or parts that are replaced at an
/// age, come half a step of this too early or late, a thousandth of themselves.
const NARROWEST: f64 = 0.04;
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
    if time > MOST as f64 * (median + standstill.preventive.min(standstill.failure)) {
        return Ok(None);
    }
    let spread = spread.max(NARROWEST * median);
    let steps = (STEPS * time / spread).clamp(STEPS_BETWEEN.0, STEPS_BETWEEN.1) as usize;
    let step = time / steps as f64;
    // Parts that fail within each step, and those that are replaced at their age.
    let until = |i: usize| life.life.failed((step * i as f64).min(life.age.unwrap_or(f64::INFINITY)));
    let failed: Vec<f64> = (0..=steps).map(until).collect();
    let ended: Vec<f64> = (0..=steps).map(|i| life.failed(step * i as f64)).collect();
    let within = |all: &[f64]| all.windows(2).map(|pair| pair[1] - pair[0]).collect::<Vec<f64>>();
    let failing = within(&failed);
    let planned: Vec<f64> = within(&ended).iter().zip(&failing).map(|(all, failing)| all - failing).collect();
    // Probability that the k-th replacement comes until each point of time.
    let mut before = vec![1.0; steps + 1];
    let mut counts = Vec::new();
    for k in 0.. {
        // A life that ends within a step leaves what is left from its middle and the standstill on. The first replacement counts when it
        // begins.
        let rest = |standstill: f64| left_after(&before, if k == 0 { 0.0 } else { standstill / step });
        let [after_failure, after_plan] = [standstill.failure, standstill.preventive].map(rest);
        let mut after = vec![0.0; steps + 1];
        for (i, sum) in after.iter_mut().enumerate() {
            *sum = (0..i)
                .map(|j| failing[j] * after_failure[i - j - 1] + planned[j] * after_plan[i - j - 1])
                .sum();
        }
        counts.push((before[steps] - after[steps]).max(0.0));
        if after[steps] < LEFT_OUT {
            break;
        }
        if k == MOST {
            return Ok(None);
        }
        before = after;
    }
    Ok(Some(counts))
}

/// What a function over steps is half a step and `standstill` steps before the end of each; 0 before its begin.
fn left_after(of: &[f64], standstill: f64) -> Vec<f64> {
    let value = |end: usize| {
        let place = end as f64 - 0.5 - standstill;
        let (first, part) = (place.floor(), place - place.floor());
        let at = |place: f64| if place < 0.0 { 0.0 } else { of[place as usize] };
        (1.0 - part) * at(first) + part * at(first + 1.0)
    };
    (1..of.len()).map(value).collect()
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
