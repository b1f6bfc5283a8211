//! Why a file of another format is no mechanism.

use thiserror::Error;

/// A fault of a file in another format.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("{message}")]
pub struct ImportError {
    /// The file that it is in, as another one names it; None for the one that was given.
    pub file: Option<String>,
    /// Line from 1; 0 where the file has no lines.
    pub line: usize,
    /// What is wrong.
    pub message: String,
    /// What to do about it.
    pub cure: String,
}

impl ImportError {
    pub(super) fn new(line: usize, message: impl Into<String>, cure: impl Into<String>) -> Self {
        Self { file: None, line, message: message.into(), cure: cure.into() }
    }
}
