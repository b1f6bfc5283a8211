//! What can be wrong with inspections. Every message names the row and the cure. Never knows files.

use crate::life::LifeError;

/// Why inspections cannot be used. Rows count readings from 1.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum InspectionError {
    /// A value is no finite number of zero or more.
    #[error(
        "reading {row}: the {what} is {value}; a finite number of zero or more is needed: correct it or leave the reading out"
    )]
    NoNumber {
        /// Reading.
        row: usize,
        /// `time` or `wear`.
        what: &'static str,
        /// The value.
        value: f64,
    },
    /// Times do not rise.
    #[error(
        "reading {row}: its time {time} is not after the {before} of the reading before; sort the readings by time, one for each time"
    )]
    Order {
        /// Reading.
        row: usize,
        /// Its time.
        time: f64,
        /// Time of the one before.
        before: f64,
    },
    /// Wear falls.
    #[error(
        "reading {row}: wear falls from {before} to {wear}, which no process that only grows can do; correct it, leave the reading out, or give the gauge's standard error"
    )]
    Falls {
        /// Reading.
        row: usize,
        /// Its wear.
        wear: f64,
        /// Wear of the one before.
        before: f64,
    },
    /// Wear stands still.
    #[error(
        "reading {row}: wear stays at {wear}, to which a process that only grows gives no probability; leave the reading out or give the gauge's standard error"
    )]
    StandsStill {
        /// Reading.
        row: usize,
        /// Its wear.
        wear: f64,
    },
    /// Too few readings to learn from.
    #[error(
        "{readings} reading(s): at least {needed} are needed {why}; time 0, wear 0 of the new joint counts as one"
    )]
    TooFew {
        /// Readings given.
        readings: usize,
        /// Readings needed.
        needed: usize,
        /// Why so many.
        why: &'static str,
    },
    /// No scatter at all.
    #[error(
        "wear rises in exact proportion to exposure over {readings} readings: without scatter and without a fit as prior there is no variance to learn; give readings with more digits, or a fit as prior"
    )]
    Proportional {
        /// Readings given.
        readings: usize,
    },
    /// Wear cannot be followed with a gauge error of this size.
    #[error("the gauge's standard error is {value}: a positive, finite number is needed")]
    Gauge {
        /// The value.
        value: f64,
    },
    /// Readings and prior contradict each other, or too few particles.
    #[error(
        "only {distinct} of {particles} particles explain the readings: give more particles; if that does not help, the readings contradict the fit (row {row} is where they part)"
    )]
    Degenerate {
        /// Different particles left.
        distinct: usize,
        /// Particles at the start.
        particles: usize,
        /// Reading that left the fewest.
        row: usize,
    },
    /// Readings and prior contradict each other.
    #[error(
        "only {distinct} of the fit's parameter sets explain the readings: they contradict the fit; correct them, or fit again with this unit's readings among the data"
    )]
    Contradiction {
        /// Sets left.
        distinct: usize,
        /// The last reading.
        row: usize,
    },
    /// Threshold, rate or parameters.
    #[error(transparent)]
    Life(#[from] LifeError),
}

impl InspectionError {
    /// The reading it is about, from 1.
    pub fn row(&self) -> Option<usize> {
        match self {
            Self::NoNumber { row, .. }
            | Self::Order { row, .. }
            | Self::Falls { row, .. }
            | Self::StandsStill { row, .. }
            | Self::Contradiction { row, .. }
            | Self::Degenerate { row, .. } => Some(*row),
            Self::TooFew { .. } | Self::Proportional { .. } | Self::Gauge { .. } | Self::Life(_) => None,
        }
    }
}
