//! What is wrong with a fit's file, where, and what to do.

use thiserror::Error;

pub(super) const WRITE_ONE: &str = "give the file that `linkwear fit DATA.csv .. --out FIT.json` writes";

/// What is wrong with a fit's file, or with what it is asked for.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("{message}")]
pub struct FitFileError {
    /// Line of the file, from 1, where there is one to blame.
    pub line: Option<usize>,
    /// The cause.
    pub message: String,
    /// What to do.
    pub cure: String,
}

pub(super) fn fault(text: &str, key: &str, message: &str, cure: &str) -> FitFileError {
    let quoted = format!("\"{key}\"");
    // A key that is missing is missed where the file begins.
    let found = text.lines().position(|line| line.contains(&quoted)).unwrap_or(0);
    let line = (!text.is_empty()).then_some(found + 1);
    FitFileError { line, message: message.to_owned(), cure: cure.to_owned() }
}
