//! Tables as files, in the format that the extension names. A format is a file of this folder and its entry in
//! [`FORMATS`]; command line and help find it there.

mod npy;

use std::io::{self, Write};
use std::path::Path;

use linkwear_runtime::{Table, write_csv};

use crate::files::{WriteError, write_whole};

/// A format of tables.
pub struct TableFormat {
    /// Extension of its files.
    pub extension: &'static str,
    /// What it is for.
    pub purpose: &'static str,
    /// Writes a whole file.
    pub write: fn(&mut dyn Write, &Table<'_>) -> io::Result<()>,
}

/// All formats; the first is taken where the extension is none of these.
pub static FORMATS: [TableFormat; 2] = [
    TableFormat { extension: "csv", purpose: "text", write: write_csv },
    TableFormat { extension: "npy", purpose: "NumPy structured array", write: npy::write },
];

/// Writes a table to a file that is there whole or not at all.
///
/// # Errors
/// As [`write_whole`].
pub fn write_table(file: &Path, table: &Table<'_>) -> Result<(), WriteError> {
    let is_named = |format: &&TableFormat| file.extension().is_some_and(|given| given == format.extension);
    let format = FORMATS.iter().find(is_named).unwrap_or(&FORMATS[0]);
    write_whole(file, |out| (format.write)(out, table))
}
