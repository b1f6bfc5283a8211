//! Why a robot is no mechanism. Never knows its file.

use thiserror::Error;

/// A fault of a file in another format.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("{message}")]
pub struct ImportError {
    /// Line from 1.
    pub line: usize,
    /// What is wrong.
    pub message: String,
    /// What to do about it.
    pub cure: String,
}

impl ImportError {
    pub(super) fn new(line: usize, message: impl Into<String>, cure: impl Into<String>) -> Self {
        Self { line, message: message.into(), cure: cure.into() }
    }
}
