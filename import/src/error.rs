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
    /// Other faults of the file.
    pub others: Vec<Self>,
}

impl ImportError {
    pub(super) fn new(line: usize, message: impl Into<String>, cure: impl Into<String>) -> Self {
        Self { file: None, line, message: message.into(), cure: cure.into(), others: Vec::new() }
    }
}

/// Faults that are kept until all of a file is read.
#[derive(Debug, Default)]
pub(super) struct Faults(Vec<ImportError>);

impl Faults {
    pub(super) fn push(&mut self, fault: ImportError) {
        self.0.push(fault);
    }

    /// What was read, unless it is a fault.
    pub(super) fn keep<T>(&mut self, read: Result<T, ImportError>) -> Option<T> {
        read.map_err(|fault| self.push(fault)).ok()
    }

    /// Whether there are none.
    pub(super) fn none(mut self) -> Result<(), ImportError> {
        if self.0.is_empty() {
            return Ok(());
        }
        let first = self.0.remove(0);
        Err(ImportError { others: self.0, ..first })
    }
}
