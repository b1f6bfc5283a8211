//! Lines for people, on stderr. In: a text. Out: its line, if stderr can be written. Never ends a program.

use std::fmt::Display;
use std::io::{Write, stderr};

/// Writes a line to stderr, if it can be written: who does not hear of a remark still gets results and exit code.
pub(crate) fn remark(text: &impl Display) {
    let _ = stderr().lock().write_all(format!("{text}\n").as_bytes());
}
