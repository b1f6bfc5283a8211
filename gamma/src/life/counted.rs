//! Lives too many to list, counted in fixed bins. In: lives, in any order and in any parts. Out: counts, the exact sum; the same
//! bits for the same lives. Never knows statistics.
//!
//! A bin has the leading 32 bits of its lives as doubles in common, of them 20 after the point: it is between 2^-21 and 2^-20 (9.6e-7)
//! of a life wide, at the same place for all lives of all runs. The sum is a whole number of 2^-64.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::error::LifeError;

/// Bits of a double below those of its bin.
const BELOW: u32 = 32;
/// Bits of a bin's number within its page.
const PAGE: u32 = 12;
/// The sum counts in parts of two to the power of this, negative; so many are 1.
const PARTS: i64 = 64;
const WHOLE: f64 = 18_446_744_073_709_551_616.0;
/// Lives are below two to the power of this, so that no sum of 2^23 times 2^40 of them is too large.
const LARGEST: f64 = 1_099_511_627_776.0;

/// Counts of lives. A decade of lives takes 27 MB at most, however many they are.
#[derive(Clone, Debug, Default, Deserialize, PartialEq, Serialize)]
pub struct CountedLives {
    /// Counts of 2^12 bins each, where there are any.
    pages: BTreeMap<u32, Vec<u64>>,
    count: u64,
    sum: i128,
}

impl CountedLives {
    /// Largest part of itself that a life may be off in its bin, of which the middle is taken.
    pub const ERROR: f64 = 0.5 / (1 << 20) as f64;

    /// Counts a life.
    ///
    /// # Errors
    /// [`LifeError::Life`] unless it is positive and below 2^40.
    pub fn add(&mut self, life: f64) -> Result<(), LifeError> {
        if !(life > 0.0 && life < LARGEST) {
            let row = usize::try_from(self.count).unwrap_or(usize::MAX).saturating_add(1);
            return Err(LifeError::Life { row, value: life });
        }
        let bin = (life.to_bits() >> BELOW) as u32;
        let page = self.pages.entry(bin >> PAGE).or_insert_with(|| vec![0; 1 << PAGE]);
        page[(bin & ((1 << PAGE) - 1)) as usize] += 1;
        self.count += 1;
        self.sum += in_parts(life);
        Ok(())
    }

    /// Counts those of another count too.
    pub fn merge(&mut self, other: &Self) {
        for (at, counts) in &other.pages {
            let page = self.pages.entry(*at).or_insert_with(|| vec![0; 1 << PAGE]);
            page.iter_mut().zip(counts).for_each(|(count, more)| *count += more);
        }
        self.count += other.count;
        self.sum += other.sum;
    }

    /// Number of lives.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// The mean of the lives, not of their bins: exact but for the last roundings. Not a number without lives.
    pub fn mean(&self) -> f64 {
        self.sum as f64 / WHOLE / self.count as f64
    }

    /// Middles of the bins that have lives, rising, and how many they have.
    pub fn bins(&self) -> impl Iterator<Item = (f64, u64)> {
        let bins = |(page, counts): (&u32, &[u64])| {
            let first = page << PAGE;
            let filled = counts.iter().zip(first..).filter(|(count, _)| **count > 0);
            let middle = |bin: u32| f64::from_bits((u64::from(bin) << BELOW) | (1 << (BELOW - 1)));
            filled.map(|(count, bin)| (middle(bin), *count)).collect::<Vec<_>>()
        };
        self.pages.iter().flat_map(move |(page, counts)| bins((page, counts)))
    }
}

/// A positive number in parts of 2^-64, rounded to the nearest: exact from 2^-12 on.
fn in_parts(life: f64) -> i128 {
    let bits = life.to_bits();
    let exponent = (bits >> 52) as i64;
    let (digits, exponent) = match exponent {
        0 => (bits, 1),
        _ => ((bits & ((1 << 52) - 1)) | (1 << 52), exponent),
    };
    let digits = i128::from(digits);
    match exponent - 1075 + PARTS {
        up @ 0.. => digits << up,
        down @ -60..0 => (digits + (1 << (-down - 1))) >> -down,
        _ => 0,
    }
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::*;
    use crate::life::LifeStatistics;
    use crate::random::{StandardNormal, Stream};

    fn lives(count: usize) -> Vec<f64> {
        let mut draws = Stream::new(21, 0, 0);
        (0..count).map(|_| 25.0 * libm::exp(0.2 * draws.sample(StandardNormal))).collect()
    }

    fn counted(lives: &[f64]) -> CountedLives {
        let mut counted = CountedLives::default();
        lives.iter().for_each(|life| counted.add(*life).expect("a life"));
        counted
    }

    #[test]
    fn order_and_parts_change_no_bit() {
        let lives = lives(5000);
        let whole = counted(&lives);
        let backwards: Vec<f64> = lives.iter().rev().copied().collect();
        assert_eq!(whole, counted(&backwards));
        for size in [1, 7, 1024, 4999] {
            let mut merged = CountedLives::default();
            lives.chunks(size).rev().for_each(|part| merged.merge(&counted(part)));
            assert_eq!(whole, merged, "parts of {size}");
        }
        assert_eq!(whole.count(), 5000);
        assert_eq!(whole.bins().map(|(_, count)| count).sum::<u64>(), 5000);
    }

    #[test]
    fn statistics_are_those_of_the_lives_one_by_one() {
        let lives = lives(100_000);
        let each = LifeStatistics::of(&lives).expect("lives");
        let bins = LifeStatistics::counted(&counted(&lives)).expect("lives");
        assert_eq!((each.count(), bins.count()), (100_000, 100_000));
        let close = |a: f64, b: f64, part: f64| assert!((a / b - 1.0).abs() <= part, "{a} {b}");
        for p in [0.001, 0.1, 0.25, 0.5, 0.9, 0.999] {
            let [exact, found] = [&each, &bins].map(|lives| lives.quantile(p).expect("a probability"));
            close(found.value, exact.value, CountedLives::ERROR);
            // A difference of two quantiles.
            assert!((found.error - exact.error).abs() <= CountedLives::ERROR * exact.value);
            let [exact, found] =
                [&each, &bins].map(|lives| lives.quantile_interval(p).expect("a probability"));
            for (exact, found) in exact.into_iter().zip(found) {
                close(found.expect("many lives"), exact.expect("many lives"), CountedLives::ERROR);
            }
        }
        // Sums of 1e5 numbers one by one round; the exact one does once.
        close(bins.mean().value, each.mean().value, 1e-13);
        // What the middle of a bin is off is as good as independent: 100,000 cancel by far more than tenfold.
        close(bins.std().value, each.std().value, 0.1 * CountedLives::ERROR);
        close(bins.cov().error, each.cov().error, CountedLives::ERROR);
        // A bin is counted by its middle.
        let inside = each.reliability(25.0).value - bins.reliability(25.0).value;
        assert!(inside.abs() <= 3.0 / 100_000.0, "{inside}");
        close(bins.shortest(), each.shortest(), CountedLives::ERROR);
        close(bins.longest(), each.longest(), CountedLives::ERROR);
    }

    #[test]
    fn sums_are_exact() {
        let lives = [1e9, 0.1, 3e-3, 1e9 + 0.25, 7.0];
        let mut counted = CountedLives::default();
        (0..1000).for_each(|_| lives.iter().for_each(|life| counted.add(*life).expect("a life")));
        // Multiples of 2^-61 below 2^31: all digits by whole numbers.
        let digits: i128 = lives.iter().map(|life| (life * 2.0_f64.powi(61)) as i128).sum();
        assert_eq!(counted.mean(), (1000 * digits) as f64 / 2.0_f64.powi(61) / 5000.0);
        let tiny = 2.0_f64.powi(-70);
        assert_eq!((in_parts(tiny), in_parts(0.75 * 2.0_f64.powi(-64)), in_parts(5e-324)), (0, 1, 0));
        for wrong in [0.0, -1.0, f64::NAN, f64::INFINITY, 2.0 * LARGEST] {
            assert!(matches!(counted.add(wrong), Err(LifeError::Life { row: 5001, .. })), "{wrong}");
        }
    }
}
