//! Why a step cannot be made. Never knows who asked.

use core::error::Error;
use core::fmt;

use crate::contact::OutOfRange;

/// Why a [`FixedStep`](super::FixedStep) does not go on. The state is as it was before the step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Halt {
    /// An array, table or list is not as long as the mechanism wants it.
    Length,
    /// A controller acts at sampled times, which steps here know nothing of.
    Samples,
    /// A constant of a law of contact or wear is out of range.
    Law(OutOfRange),
    /// The position is singular, or nearly so: the elimination cannot be trusted. A run with std goes through many such positions.
    NearlySingular,
    /// Loops stay open after all corrections.
    OpenLoop,
    /// Closing the loops moved the mechanism by more than a step may: it would go on in another assembly. Take shorter steps.
    Jumped,
    /// A number is infinite, or none.
    NotFinite,
}

impl fmt::Display for Halt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let text = match self {
            Self::Length => "an array is not as long as the mechanism wants it",
            Self::Samples => "a controller acts at sampled times: run it with std",
            Self::Law(reason) => return reason.fmt(f),
            Self::NearlySingular => "the position is nearly singular",
            Self::OpenLoop => "loops stay open: take shorter steps",
            Self::Jumped => "closing the loops moved the mechanism too far: take shorter steps",
            Self::NotFinite => "a number is infinite, or none: take shorter steps",
        };
        f.write_str(text)
    }
}

impl Error for Halt {}
