//! Reads the result of a fit back. In: FIT.json. Out: the fit, or what is wrong with the file and where. Never knows how
//! parameters are estimated.

use std::fs;
use std::path::Path;

use linkwear_gamma::{FitFile, FitFileError};

use super::failure::Failure;

/// Reads a fit.
pub fn read(file: &Path) -> Result<FitFile, Failure> {
    let text = fs::read_to_string(file).map_err(|error| Failure::Read(file.to_path_buf(), error))?;
    FitFile::parse(&text).map_err(|error| refused(file, error))
}

/// A fit that is none, or does not do for what is asked.
pub fn refused(file: &Path, error: FitFileError) -> Failure {
    let FitFileError { line, message, cure } = error;
    Failure::Data { file: file.to_path_buf(), line, message, help: cure }
}
