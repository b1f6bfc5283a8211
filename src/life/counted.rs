//! Random lives that are too many to list. In: ends of lives, in any order and in any parts. Out: counts and sums, the same
//! bits for the same lives. Never knows how they were lived.

use std::ops::Range;

use linkwear_gamma::life::{CountedLives, LifeError};
use linkwear_runtime::life::FailureEvent;
use serde::{Deserialize, Serialize};

/// Lives up to which each is kept, so that statistics are exact: 32 MB of them. More are counted.
pub const LISTED_LIVES: u64 = 1_000_000;

/// Numbers of lives in parts of at most so many.
pub(super) fn parts(lives: Range<u64>, most: u64) -> impl Iterator<Item = Range<u64>> {
    let (most, count) = (most.max(1), lives.end.saturating_sub(lives.start));
    (0..count.div_ceil(most)).map(move |part| {
        let first = lives.start + part * most;
        first..lives.end.min(first.saturating_add(most))
    })
}

/// Ends of lives, counted.
#[derive(Clone, Debug, Default, Deserialize, PartialEq, Serialize)]
pub struct CountedEnds {
    cycles: CountedLives,
    whole_cycles: u128,
    /// How many each joint ended.
    by_joint: Vec<u64>,
}

impl CountedEnds {
    /// Counts a life.
    ///
    /// # Errors
    /// [`LifeError::Life`].
    pub fn add(&mut self, end: &FailureEvent) -> Result<(), LifeError> {
        self.cycles.add(end.cycles)?;
        self.whole_cycles += u128::from(end.whole_cycles);
        self.by_joint.resize(self.by_joint.len().max(end.joint + 1), 0);
        self.by_joint[end.joint] += 1;
        Ok(())
    }

    /// Counts those of another count too.
    pub fn merge(&mut self, other: &Self) {
        self.cycles.merge(&other.cycles);
        self.whole_cycles += other.whole_cycles;
        self.by_joint.resize(self.by_joint.len().max(other.by_joint.len()), 0);
        self.by_joint.iter_mut().zip(&other.by_joint).for_each(|(count, more)| *count += more);
    }

    /// The lives in cycles.
    pub fn cycles(&self) -> &CountedLives {
        &self.cycles
    }

    /// Mean life as inspections after whole cycles see it.
    pub fn mean_whole_cycles(&self) -> f64 {
        self.whole_cycles as f64 / self.cycles.count() as f64
    }

    /// Part of the lives that a joint ended.
    pub fn failed_first(&self, joint: usize) -> f64 {
        *self.by_joint.get(joint).unwrap_or(&0) as f64 / self.cycles.count() as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_in_any_order_count_as_the_whole() {
        let end = |at: u64| {
            let cycles = 20.0 + (at as f64).sqrt();
            FailureEvent {
                joint: usize::from(at.is_multiple_of(5)) * 2,
                cycles,
                whole_cycles: cycles.ceil() as u64,
            }
        };
        let counted = |numbers: Range<u64>| {
            let mut counted = CountedEnds::default();
            numbers.for_each(|at| counted.add(&end(at)).expect("a life"));
            counted
        };
        let mut merged = counted(300..1000);
        merged.merge(&counted(1..300));
        merged.merge(&counted(0..1));
        assert_eq!(merged, counted(0..1000));
        assert_eq!([0, 1, 2, 3].map(|joint| merged.failed_first(joint)), [0.8, 0.0, 0.2, 0.0]);
        let whole: u64 = (0..1000).map(|at| end(at).whole_cycles).sum();
        assert_eq!(merged.mean_whole_cycles(), whole as f64 / 1000.0);
    }
}
