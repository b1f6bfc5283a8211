//! Rows of a run for a script: columns with their units, and all numbers in one text. In: a run. Out: [`Motion`]. Never knows
//! what columns mean.

use linkwear_runtime::Run;
use serde::Serialize;

/// Numbers that a page holds at most: with four bytes each, a third more as text, less than two megabytes.
const NUMBERS: usize = 350_000;
const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// A run for a script.
#[derive(Debug, Serialize)]
pub struct Motion {
    /// Name and unit.
    pub columns: Vec<[String; 2]>,
    /// Times of the rows [s].
    pub times: Vec<f64>,
    /// Row by row: numbers of 32 bits, the lowest byte first, in base 64.
    pub values: String,
}

impl Motion {
    /// All rows, or as many of them evenly as a page holds.
    pub fn new(run: &Run) -> Self {
        let most = (NUMBERS / run.channels.len().max(1)).max(2);
        let count = run.rows.len();
        let shown = count.min(most);
        let at = |index: usize| index * count.saturating_sub(1) / shown.saturating_sub(1).max(1);
        let kept: Vec<usize> = (0..shown).map(at).collect();
        #[allow(clippy::cast_possible_truncation, reason = "seven digits are enough to draw")]
        let bytes = |row: &usize| {
            run.rows[*row].iter().flat_map(|value| (*value as f32).to_le_bytes()).collect::<Vec<_>>()
        };
        let bytes: Vec<u8> = kept.iter().flat_map(bytes).collect();
        Self {
            columns: run
                .channels
                .iter()
                .map(|channel| [channel.name.to_string(), channel.unit.to_string()])
                .collect(),
            times: kept.iter().map(|row| run.times[*row]).collect(),
            values: base64(&bytes),
        }
    }
}

fn base64(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for group in bytes.chunks(3) {
        let byte = |at: usize| u32::from(group.get(at).copied().unwrap_or_default());
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for digit in 0..4 {
            let index = (bits >> (18 - 6 * digit) & 63) as usize;
            text.push(if digit > group.len() { '=' } else { char::from(DIGITS[index]) });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_is_that_of_the_standard() {
        let known = [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")];
        known.iter().for_each(|(text, coded)| assert_eq!(base64(text.as_bytes()), *coded));
    }
}
