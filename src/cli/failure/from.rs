//! What failures come of errors of every stage: codes, places, cures. In: typed errors. Out: [`Failure`].

use std::fmt::Write as _;
use std::path::Path;

use linkwear_codegen::diagnostic::Diagnostics;

use super::{FAILED, Failure, entries};
use crate::backend::BackendError;
use crate::csv_table::CsvError;
use crate::files::{STDOUT, WriteError};
use crate::mechanism::LoadError;

impl From<Diagnostics> for Failure {
    fn from(wrong: Diagnostics) -> Self {
        let text = wrong.to_string().trim_end().to_owned();
        let coloured = Some(wrong.in_colours());
        Self { exit: FAILED, text, coloured, errors: entries(&wrong), cycles: None }
    }
}

impl From<WriteError> for Failure {
    fn from(error: WriteError) -> Self {
        let (code, file, help) = match &error {
            WriteError::System { file, .. } if file == Path::new(STDOUT) => {
                ("C0003", file, "make room where it goes, or send it elsewhere")
            }
            WriteError::System { file, .. } => (
                "C0003",
                file,
                "nothing was written there; give a file in a folder that exists, can be written and has room",
            ),
            WriteError::Exists(file) => ("C0004", file, "choose another name"),
        };
        Self::new(code, Some(file), &error, help)
    }
}

impl From<CsvError> for Failure {
    fn from(error: CsvError) -> Self {
        match error {
            CsvError::Read { file, error } => Self::read(&file)(error),
            CsvError::Data { file, line, message, help } => Self::data(&file, line, message, help),
            CsvError::Several { faults, more } => {
                let all = faults.into_iter().map(Self::from).reduce(Self::and);
                let mut all = all.unwrap_or_else(|| Self::new("C0011", None, "the file is wrong", ""));
                if more > 0 {
                    let _ = write!(all.text, "\n\nand {more} more of them");
                }
                all
            }
        }
    }
}

impl From<LoadError> for Failure {
    fn from(error: LoadError) -> Self {
        match error {
            LoadError::Read { file, error } => Self::read(&file)(error),
            LoadError::Mechanism(diagnostics) => diagnostics.into(),
            LoadError::Backend(error) => error.into(),
        }
    }
}

impl From<BackendError> for Failure {
    fn from(error: BackendError) -> Self {
        let (name, help) = match error {
            BackendError::Compiled { .. } => (
                "compiled",
                "use --backend auto, or compile the mechanism into a program of yours (README, Embedding)",
            ),
            BackendError::Native(_) => {
                ("native", "use --backend auto: the interpreter gives the same results, in more time")
            }
        };
        Self::new("C0007", None, format!("--backend {name}: {error}"), help)
    }
}
