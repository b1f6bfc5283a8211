//! Operating time for people. In: seconds. Out: text.

use super::super::table::count;
use crate::life::HOUR;
use crate::number::number;

/// Whole hours, or four digits of fewer than a hundred.
pub fn hours(seconds: f64) -> String {
    let hours = seconds / HOUR;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between a hundred and 1e15")]
    if (100.0..1e15).contains(&hours) { count(hours.round() as u64) } else { number(hours) }
}
