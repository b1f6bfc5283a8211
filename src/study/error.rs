//! Why there is no study. In: a study. Out: [`StudyError`], before a point is run where that can be.

use linkwear_runtime::SampledSignals;
use thiserror::Error;

use super::cases::Cases;
use super::points::Points;
use super::quantity::{Needs, Quantity};
use crate::journal::JournalError;

/// Why there is no study.
#[derive(Debug, Error)]
pub enum StudyError {
    /// Its journal cannot be used.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// What varies is given over time, so that its values would change nothing.
    #[error("the input `{name}` varies and is given over time")]
    GivenOverTime {
        /// The input.
        name: String,
    },
    /// What is set is given over time, so that its value would change nothing.
    #[error("the input `{name}` is set and given over time")]
    SetOverTime {
        /// The input.
        name: String,
    },
    /// A life does not follow inputs over time: its turns repeat, at constant inputs.
    #[error(
        "`{name}` is of a life, in which inputs are constants: it does not follow those that are given over time"
    )]
    LifeOverTime {
        /// What is asked of a life.
        name: String,
    },
    /// Stopped on request.
    #[error("stopped on request after {done} of {of} points")]
    Interrupted {
        /// Points that were finished.
        done: u64,
        /// Points there are.
        of: u64,
    },
}

/// Whether inputs over time go with what varies and what is asked.
pub(super) fn check_signals(
    signals: &SampledSignals,
    (cases, points, of): (&Cases, &Points, &[Quantity]),
) -> Result<(), StudyError> {
    let inputs = cases.base().description.input_infos().enumerate();
    let mut connected = inputs.filter(|(at, _)| signals.connects(*at)).map(|(_, (info, _))| &*info.name);
    if let Some(name) = connected.find(|name| points.axes().iter().any(|axis| axis.name == *name)) {
        return Err(StudyError::GivenOverTime { name: name.to_owned() });
    }
    if let Some(name) = cases.base().given_over_time(signals) {
        return Err(StudyError::SetOverTime { name: name.to_owned() });
    }
    match of.iter().find(|quantity| quantity.needs() == Needs::Life) {
        Some(quantity) => Err(StudyError::LifeOverTime { name: quantity.name.clone() }),
        None => Ok(()),
    }
}
