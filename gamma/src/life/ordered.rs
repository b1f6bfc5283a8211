//! Lives in order, each by itself or counted in bins. In: lives. Out: the life of a rank, how many are shorter.
//! Never knows statistics.

use super::counted::CountedLives;
use crate::order::quantile_of;

/// Lives, shortest first; at least one.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Ordered {
    /// One by one.
    Each(Vec<f64>),
    /// Lives of the bins, and the number of lives up to the end of each.
    Counted(Vec<f64>, Vec<u64>),
}

impl Ordered {
    pub(super) fn counted(lives: &CountedLives) -> Self {
        let mut total = 0;
        let bin = |(life, count)| {
            total += count;
            (life, total)
        };
        let (lives, ends) = lives.bins().map(bin).unzip();
        Self::Counted(lives, ends)
    }

    pub(super) fn count(&self) -> usize {
        match self {
            Self::Each(lives) => lives.len(),
            Self::Counted(_, ends) => {
                ends.last().map_or(0, |count| usize::try_from(*count).unwrap_or(usize::MAX))
            }
        }
    }

    /// The life of a rank, from 0.
    pub(super) fn get(&self, rank: usize) -> Option<f64> {
        match self {
            Self::Each(lives) => lives.get(rank).copied(),
            Self::Counted(lives, ends) => lives.get(ends.partition_point(|end| *end <= rank as u64)).copied(),
        }
    }

    /// How many are at most so long.
    pub(super) fn up_to(&self, life: f64) -> usize {
        match self {
            Self::Each(lives) => lives.partition_point(|one| *one <= life),
            Self::Counted(lives, ends) => {
                let before = lives.partition_point(|one| *one <= life).checked_sub(1);
                let count = before.and_then(|last| ends.get(last)).copied().unwrap_or(0);
                usize::try_from(count).unwrap_or(usize::MAX)
            }
        }
    }

    pub(super) fn quantile(&self, p: f64) -> f64 {
        quantile_of(self.count(), |rank| self.get(rank).unwrap_or(f64::NAN), p)
    }

    /// Sums of the second, third and fourth powers of what lives are off a value, in their order.
    pub(super) fn powers(&self, from: f64) -> [f64; 3] {
        let mut sums = [0.0; 3];
        let mut add = |life: f64, count: f64| {
            let (off, square) = (life - from, (life - from) * (life - from));
            for (sum, power) in sums.iter_mut().zip([square, square * off, square * square]) {
                *sum += count * power;
            }
        };
        match self {
            Self::Each(lives) => lives.iter().for_each(|life| add(*life, 1.0)),
            Self::Counted(lives, ends) => {
                let mut before = 0;
                for (life, end) in lives.iter().zip(ends) {
                    add(*life, (end - before) as f64);
                    before = *end;
                }
            }
        }
        sums
    }
}
