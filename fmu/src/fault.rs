//! Why a call has no answer, in words for the tool's log.

use linkwear_runtime::{RunError, SetupError};

/// Why a call has no answer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault(pub String);

impl From<RunError> for Fault {
    fn from(error: RunError) -> Self {
        Self(error.to_string())
    }
}

impl From<SetupError> for Fault {
    fn from(error: SetupError) -> Self {
        // In the names of the functions that a tool calls.
        let cure = match error {
            SetupError::NotOnLoops { .. } => {
                " (fmi3SetContinuousStates sets states; fmi3UpdateDiscreteStates puts them onto the loops)"
            }
            _ => "",
        };
        Self(format!("{error}{cure}"))
    }
}

/// A call without an answer.
///
/// # Errors
/// Always.
pub fn fault<T>(reason: impl Into<String>) -> Result<T, Fault> {
    Err(Fault(reason.into()))
}
