//! Files and stdout as the command line uses them: what fails is a [`Failure`] with its path.

use std::fmt::Display;
use std::fs::File;
use std::io::{self, BufWriter};
use std::path::Path;

use linkwear::files::{self, WriteError};

use super::failure::Failure;

/// As [`files::print`].
pub fn print(text: &impl Display) -> Result<(), Failure> {
    files::print(text).map_err(|error| Failure::Write("stdout".into(), error))
}

/// As [`files::write_whole`].
pub fn write_whole(
    path: &Path,
    fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<(), Failure> {
    files::write_whole(path, fill).map_err(|error| Failure::Write(path.to_path_buf(), error))
}

/// As [`files::claim_folder`].
pub fn claim_folder(path: &Path) -> Result<(), Failure> {
    files::claim_folder(path).map_err(|error| match error {
        WriteError::Exists => Failure::Exists(path.to_path_buf()),
        WriteError::System(error) => Failure::Write(path.to_path_buf(), error),
    })
}

/// Refuses to write over the input.
pub fn refuse_same(input: &Path, output: &Path) -> Result<(), Failure> {
    match (input.canonicalize(), output.canonicalize()) {
        (Ok(a), Ok(b)) if a == b => Err(Failure::Exists(output.to_path_buf())),
        _ => Ok(()),
    }
}
