//! Why readings cannot be fitted: rows, causes, cures. Never knows files.

use std::fmt;

use thiserror::Error;

/// Rows that are named; more are counted.
const NAMED: usize = 10;

/// An increment that a Gamma process cannot have.
#[derive(Clone, Debug, PartialEq)]
pub struct NotIncreasing {
    /// Name of the unit.
    pub unit: String,
    /// Row of the later reading.
    pub row: usize,
    /// Wear before.
    pub before: f64,
    /// Wear after, not above `before`.
    pub after: f64,
}

impl fmt::Display for NotIncreasing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "row {} (unit {}: {} after {})", self.row, self.unit, self.after, self.before)
    }
}

/// Why readings cannot be fitted.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum DataError {
    /// There is nothing.
    #[error("there are no readings")]
    Empty,
    /// A number is not finite, or out of the range of its kind.
    #[error("row {row}: {what} is {value}")]
    BadNumber {
        /// The row.
        row: usize,
        /// What the number is.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// Exposure goes back.
    #[error("row {row}: unit {unit} goes back from {before} to {after}")]
    Unsorted {
        /// Name of the unit.
        unit: String,
        /// Row of the later line.
        row: usize,
        /// Exposure before.
        before: f64,
        /// Exposure after.
        after: f64,
    },
    /// Two readings of a unit at one exposure.
    #[error("rows {first} and {row}: unit {unit} is read twice at {exposure}")]
    Duplicate {
        /// Name of the unit.
        unit: String,
        /// Row of the first.
        first: usize,
        /// Row of the second.
        row: usize,
        /// The exposure.
        exposure: f64,
    },
    /// A unit with one reading has no increment.
    #[error("row {row}: unit {unit} has one reading only, so no increment")]
    OneReading {
        /// Name of the unit.
        unit: String,
        /// Its row.
        row: usize,
    },
    /// Too few increments for the number of parameters.
    #[error("row {row}: the data give {increments} increment(s); {parameters} parameters need at least {}", parameters + 1)]
    TooFew {
        /// Row of the last reading.
        row: usize,
        /// How many there are.
        increments: usize,
        /// How many parameters are sought.
        parameters: usize,
    },
    /// Wear never changes.
    #[error("rows {first} to {last}: wear is constant")]
    Constant {
        /// First row.
        first: usize,
        /// Last row.
        last: usize,
    },
    /// Increments that are zero or negative.
    #[error("{} increment(s) of wear are not positive: {}", .0.len(), listed(.0))]
    NotIncreasing(Vec<NotIncreasing>),
    /// Readings of a unit that do not differ by a multiple of the gauge's step.
    #[error(
        "row {row}: unit {unit} grew by {wear} since its reading before, no multiple of the resolution {step}"
    )]
    NotMultiple {
        /// Name of the unit.
        unit: String,
        /// Row of the later reading.
        row: usize,
        /// Wear between both.
        wear: f64,
        /// The gauge's step.
        step: f64,
    },
    /// Readings that cannot be, or whose likelihood has no closed form.
    #[error("row {row}: unit {unit} has {why}")]
    Contradiction {
        /// Name of the unit.
        unit: String,
        /// Row of the reading.
        row: usize,
        /// What is there that cannot be taken.
        why: &'static str,
    },
    /// A bound, or a limit of entry, of readings that a gauge rounds.
    #[error("row {row}: {what} cannot be taken together with a resolution")]
    WithResolution {
        /// What is there.
        what: &'static str,
        /// Its row.
        row: usize,
    },
    /// The name of a part that took the place of another is a unit's name.
    #[error("row {row}: the part that replaces another would be called {name}, as another unit is")]
    PartName {
        /// The name.
        name: String,
        /// First row of the unit whose part was replaced.
        row: usize,
    },
    /// A covariate never changes, so its effect cannot be seen.
    #[error("covariate {index} is the same in all rows ({value})")]
    ConstantCovariate {
        /// Which, from 1.
        index: usize,
        /// Its value.
        value: f64,
    },
}

fn listed(rows: &[NotIncreasing]) -> String {
    let named: Vec<String> = rows.iter().take(NAMED).map(ToString::to_string).collect();
    let more = rows.len() - named.len();
    let named = named.join(", ");
    if more == 0 { named } else { format!("{named}, and {more} more") }
}

impl DataError {
    /// The row to look at first, when one is to blame.
    pub fn row(&self) -> Option<usize> {
        match self {
            Self::Empty | Self::ConstantCovariate { .. } => None,
            Self::BadNumber { row, .. }
            | Self::Unsorted { row, .. }
            | Self::Duplicate { row, .. }
            | Self::OneReading { row, .. }
            | Self::NotMultiple { row, .. }
            | Self::Contradiction { row, .. }
            | Self::WithResolution { row, .. }
            | Self::PartName { row, .. }
            | Self::TooFew { row, .. } => Some(*row),
            Self::Constant { first, .. } => Some(*first),
            Self::NotIncreasing(rows) => rows.first().map(|increment| increment.row),
        }
    }

    /// What to do.
    pub fn cure(&self) -> &'static str {
        match self {
            Self::Empty => "give at least two readings of a unit",
            Self::BadNumber { .. } => "correct or delete the row",
            Self::Unsorted { .. } => "sort the readings of each unit by exposure",
            Self::Duplicate { .. } => "delete one of the two rows, or write their mean",
            Self::OneReading { .. } => "delete the row, add readings, or begin each unit at (0, 0)",
            Self::TooFew { .. } => "add readings or units, or estimate fewer parameters",
            Self::Constant { .. } => "nothing can be learnt from it: wear has to grow",
            Self::NotIncreasing(_) => {
                "wear cannot shrink: correct the rows or leave them out; if all are zero, state the gauge's resolution, and if it errs, its error too"
            }
            Self::NotMultiple { .. } => {
                "state the step that the readings were rounded to, in their unit; leave the resolution out if they were not"
            }
            Self::Contradiction { .. } => {
                "correct the row, or say by a reset what was done to the part before it; a bound stands alone after a known wear"
            }
            Self::WithResolution { .. } => "leave the resolution out, or the row",
            Self::PartName { .. } => "rename that unit",
            Self::ConstantCovariate { .. } => "leave the covariate out",
        }
    }
}
