//! What is wrong with a table, and several faults of one file as one. In: what was read, cell by cell, or why not. Out: all of it, or all
//! that is wrong.

use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

/// A file that is no table of what is asked for.
#[derive(Debug, Error)]
pub enum CsvError {
    /// It cannot be read.
    #[error("cannot read `{}`: {error}", .file.display())]
    Read {
        /// The file.
        file: PathBuf,
        /// Why.
        error: io::Error,
    },
    /// Something is wrong in it.
    #[error("{message}")]
    Data {
        /// The file.
        file: PathBuf,
        /// Line, from 1, if the fault has one.
        line: Option<usize>,
        /// The cause.
        message: String,
        /// What to do.
        help: String,
    },
    /// Several things are.
    #[error("{}", told(.faults, *.more))]
    Several {
        /// The first of them.
        faults: Vec<CsvError>,
        /// How many come behind those.
        more: usize,
    },
}

pub(super) fn fault(file: &Path, line: Option<usize>, message: String, help: &str) -> CsvError {
    CsvError::Data { file: file.to_path_buf(), line, message, help: help.to_owned() }
}

/// Faults that are told one by one: what is wrong in every line is wrong once.
const TOLD: usize = 20;

/// All that was read, or all faults.
pub(super) fn gather<T>(read: impl Iterator<Item = Result<T, CsvError>>) -> Result<Vec<T>, CsvError> {
    let (mut values, mut faults, mut more) = (Vec::new(), Vec::new(), 0);
    for result in read {
        match result {
            Ok(value) => values.push(value),
            Err(fault) if faults.len() < TOLD => faults.push(fault),
            Err(_) => more += 1,
        }
    }
    match faults.len() {
        0 => Ok(values),
        1 => Err(faults.remove(0)),
        _ => Err(CsvError::Several { faults, more }),
    }
}

/// Faults, each in its line.
pub(super) fn told(faults: &[CsvError], more: usize) -> String {
    let mut lines: Vec<String> = faults.iter().map(ToString::to_string).collect();
    if more > 0 {
        lines.push(format!("and {more} more"));
    }
    lines.join("\n")
}
