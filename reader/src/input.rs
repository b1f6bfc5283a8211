//! Text from files: of bounded size, and where a file names another, of that folder only.
//! In: paths. Out: text, or what the system says. Never knows what the text means.

use std::fs::{self, File};
use std::io::{self, ErrorKind, Read as _};
use std::path::{Path, PathBuf};
use std::string::FromUtf8Error;

use thiserror::Error;

use crate::limits::Limit;

/// Where a file may lie that another file names.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Reach {
    /// In the folder of the file that names it, or below, symbolic links followed.
    #[default]
    Below,
    /// Anywhere: for files that are trusted as their author is.
    Anywhere,
}

/// The text at a path that a person gives: a file, or a stream up to its end.
///
/// # Errors
/// Those of the system; more bytes than `most`, of which no more are read; text that is not UTF-8.
pub fn read_text(path: &Path, most: Limit) -> io::Result<String> {
    text(read_bytes(path, most)?)
}

/// The bytes at a path that a person gives: a file, or a stream up to its end.
///
/// # Errors
/// Those of the system; more bytes than `most`, of which no more are read.
pub fn read_bytes(path: &Path, most: Limit) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    File::open(path)?.take(most.most as u64 + 1).read_to_end(&mut bytes)?;
    if bytes.len() > most.most {
        let Limit { what, most, help } = most;
        return Err(io::Error::new(
            ErrorKind::FileTooLarge,
            format!("it has more than {most} {what}; {help}"),
        ));
    }
    Ok(bytes)
}

fn text(bytes: Vec<u8>) -> io::Result<String> {
    String::from_utf8(bytes).map_err(|error| io::Error::new(ErrorKind::InvalidData, NotUtf8::of(&error)))
}

/// Bytes that are no text in UTF-8; the cause of an [`io::Error`].
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[error("{}, from line {line} on", if *.is_utf16 { "it is UTF-16 text, not UTF-8" } else { "it is not UTF-8 text" })]
pub struct NotUtf8 {
    /// Line of the first of them, from 1.
    pub line: usize,
    is_utf16: bool,
}

impl NotUtf8 {
    fn of(error: &FromUtf8Error) -> Self {
        let (bytes, good) = (error.as_bytes(), error.utf8_error().valid_up_to());
        let line = 1 + bytes.iter().take(good).filter(|byte| **byte == b'\n').count();
        Self { line, is_utf16: bytes.starts_with(&[0xFF, 0xFE]) || bytes.starts_with(&[0xFE, 0xFF]) }
    }
}

/// The text of a file that the file `from` names, and its path.
///
/// # Errors
/// As [`read_text`]; a file out of reach; what is no regular file, and could keep its reader waiting.
pub fn read_named(from: &Path, name: &str, reach: Reach, most: Limit) -> io::Result<(PathBuf, String)> {
    let (path, bytes) = read_named_bytes(from, name, reach, most)?;
    Ok((path, text(bytes)?))
}

/// The bytes of a file that the file `from` names, and its path.
///
/// # Errors
/// As [`read_bytes`]; a file out of reach; what is no regular file, and could keep its reader waiting.
pub fn read_named_bytes(
    from: &Path,
    name: &str,
    reach: Reach,
    most: Limit,
) -> io::Result<(PathBuf, Vec<u8>)> {
    let folder = from.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let path = folder.join(name);
    let real = path.canonicalize()?;
    if reach == Reach::Below && !real.starts_with(folder.canonicalize()?) {
        return Err(io::Error::other("it lies outside the folder of the file that names it"));
    }
    if !fs::metadata(&real)?.is_file() {
        return Err(io::Error::other("it is no regular file"));
    }
    Ok((path, read_bytes(&real, most)?))
}
