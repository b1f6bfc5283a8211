//! What is wrong with the settings of a life, or with a state of it.

use thiserror::Error;

use crate::contact::OutOfRange;

/// Settings or a state that make no sense.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SettingsError {
    /// There is nothing to wear.
    #[error("no joint wears; give a joint with clearance a `[wear]` section")]
    NoJoint,
    /// A number of a joint is out of range.
    #[error("{} of joint `{joint}` is {}; it must be {}", reason.name, reason.value, reason.need)]
    Joint {
        /// The joint.
        joint: String,
        /// Which number, its value, and what it must be.
        reason: OutOfRange,
    },
    /// A number of the run is out of range.
    #[error(transparent)]
    Run(#[from] OutOfRange),
    /// W or the feedback need a profile, and none is kept.
    #[error("joint `{joint}` needs a wear profile; give the number of its bins")]
    NoProfile {
        /// The joint.
        joint: String,
    },
    /// A table knows wear as one number.
    #[error(
        "joint `{joint}` feeds its profile back, which no table of the clearance holds; use full coupling"
    )]
    TableOfProfile {
        /// The joint.
        joint: String,
    },
    /// A saved state is that of another mechanism or other settings.
    #[error("the saved state does not fit: {what} is {found}, these settings have {expected}; start afresh")]
    State {
        /// What differs.
        what: &'static str,
        /// In the settings.
        expected: usize,
        /// In the state.
        found: usize,
    },
}
