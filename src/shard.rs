//! Which part of a large work a machine of many does. In: `I/N`. Out: numbers of lives or points. Never knows how they are done.

use std::fmt;
use std::ops::Range;
use std::str::FromStr;

use serde::{Deserialize, Serialize};
use thiserror::Error;

/// One of several parts of the random lives, or of the points of a study, of nearly the same length.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, Serialize)]
pub struct Shard {
    /// Its number, from 1.
    pub index: u64,
    /// How many there are.
    pub of: u64,
}

/// What is no shard.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum ShardError {
    /// There is no slash between two whole numbers.
    #[error("write I/N, the number of the shard and of all shards, as 2/8")]
    Form,
    /// The number is not among those there are.
    #[error("shards are numbered from 1 to {of}")]
    Number {
        /// How many there are.
        of: u64,
    },
}

impl Shard {
    /// The part of this number, from 1, of so many.
    ///
    /// # Errors
    /// [`ShardError::Number`].
    pub fn new(index: u64, of: u64) -> Result<Self, ShardError> {
        if (1..=of).contains(&index) { Ok(Self { index, of }) } else { Err(ShardError::Number { of }) }
    }

    /// Numbers of its things, of so many: all shards together have each once.
    pub fn numbers(self, count: u64) -> Range<u64> {
        let end = |index: u64| {
            let end = u128::from(count) * u128::from(index) / u128::from(self.of.max(1));
            u64::try_from(end).unwrap_or(count)
        };
        end(self.index.saturating_sub(1))..end(self.index)
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.of)
    }
}

impl FromStr for Shard {
    type Err = ShardError;

    fn from_str(text: &str) -> Result<Self, ShardError> {
        let whole = |text: &str| text.trim().parse::<u64>().map_err(|_| ShardError::Form);
        let (index, of) = text.split_once('/').ok_or(ShardError::Form)?;
        Self::new(whole(index)?, whole(of)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_have_each_number_once_and_differ_by_one_at_most() {
        for (count, of) in [(1000, 7), (3, 7), (0, 2), (u64::MAX, 3), (16, 1)] {
            let ranges: Vec<Range<u64>> = (1..=of).map(|index| Shard { index, of }.numbers(count)).collect();
            assert_eq!((ranges[0].start, ranges[ranges.len() - 1].end), (0, count));
            assert!(ranges.windows(2).all(|pair| pair[0].end == pair[1].start));
            let lengths = || ranges.iter().map(|range| range.end - range.start);
            assert!(lengths().max().unwrap_or(0) - lengths().min().unwrap_or(0) <= 1, "{count} {of}");
        }
    }

    #[test]
    fn what_is_no_shard_is_refused() {
        assert_eq!("2/8".parse(), Ok(Shard { index: 2, of: 8 }));
        for text in ["", "2", "2/", "/8", "-1/8", "1.5/8", "2:8"] {
            assert_eq!(text.parse::<Shard>(), Err(ShardError::Form), "{text}");
        }
        for text in ["0/8", "9/8"] {
            assert_eq!(text.parse::<Shard>(), Err(ShardError::Number { of: 8 }), "{text}");
        }
        assert_eq!("1/0".parse::<Shard>(), Err(ShardError::Number { of: 0 }));
    }
}
