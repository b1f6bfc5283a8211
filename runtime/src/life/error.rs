//! Why a life stopped before its end, as data.
//! What was computed until then stands in the state and went to the observer.

use thiserror::Error;

use super::settings_error::SettingsError;

/// A life that cannot go on. Cycles are counted from 1; the state is that of the last whole cycle before.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum LifeError<E> {
    /// Settings, or a state that is not of these settings.
    #[error(transparent)]
    Settings(#[from] SettingsError),
    /// The first cycle already wears down to the threshold.
    #[error(
        "the first cycle wears {increment:.4e} m at joint `{joint}`, its threshold is {threshold:.4e} m; take \
         fewer revolutions per cycle, or check the unit of the threshold"
    )]
    ThresholdBelowFirstIncrement {
        /// The joint.
        joint: String,
        /// Its threshold [m].
        threshold: f64,
        /// Wear of the first cycle [m].
        increment: f64,
    },
    /// The gap is wider than the journal.
    #[error(
        "cycle {cycle}: the clearance of joint `{joint}`, {clearance:.4e} m, is not below its journal radius \
         {journal_radius:.4e} m; check the clearance, the feedback factor and the threshold"
    )]
    ClearanceAboveJournal {
        /// The joint.
        joint: String,
        /// The cycle.
        cycle: u64,
        /// Clearance, with the deepest wear of a profile fed back [m].
        clearance: f64,
        /// Radius of the journal [m].
        journal_radius: f64,
    },
    /// Journal and bearing are apart for most of the revolution.
    #[error(
        "cycle {cycle}: joint `{joint}` is without contact for {:.0} % of a revolution; sliding wear means \
         nothing there, drive slower or load the joint",
        (1.0 - touching) * 100.0
    )]
    ContactLost {
        /// The joint.
        joint: String,
        /// The cycle.
        cycle: u64,
        /// Part of the revolution in contact.
        touching: f64,
    },
    /// Nothing wears, so nothing fails.
    #[error(
        "cycle {cycle}: no joint wears (no load, no sliding, or a wear coefficient of zero); the life has no end"
    )]
    NoWear {
        /// The cycle.
        cycle: u64,
    },
    /// A measurement gave a number that means nothing.
    #[error("cycle {cycle}: {name} of joint `{joint}` was measured as {value}; take shorter time steps")]
    Measured {
        /// The joint.
        joint: String,
        /// The cycle.
        cycle: u64,
        /// What was measured.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// A measurement is of other joints or profiles than the settings ask for.
    #[error(
        "the fine scale gave {found} {what}, the settings have {expected}; both must be of one mechanism"
    )]
    Shape {
        /// What was counted.
        what: &'static str,
        /// In the settings.
        expected: usize,
        /// In the measurement.
        found: usize,
    },
    /// A drawn increment is negative or not a number.
    #[error("cycle {cycle}: the increment drawn for joint `{joint}` is {value} m; it must not be below 0")]
    Drawn {
        /// The joint.
        joint: String,
        /// The cycle.
        cycle: u64,
        /// The increment [m].
        value: f64,
    },
    /// The watch asked to stop.
    #[error("stopped on request")]
    Interrupted,
    /// The fine scale failed.
    #[error("cycle {cycle}: {error}")]
    Fine {
        /// The cycle.
        cycle: u64,
        /// Why.
        error: E,
    },
}
