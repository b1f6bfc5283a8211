//! Tables as files, in the format that the extension names. A format is a file of this folder and its entry in
//! [`FORMATS`]; command line and help find it there. In: a table, what it is of. Out: a file, and beside it what the format has no
//! room for. Never knows what the numbers mean.

#[cfg(test)]
pub(crate) mod about;
#[cfg(not(test))]
mod about;
mod columns;
mod npy;
#[cfg(feature = "parquet")]
mod parquet;
#[cfg(feature = "cli")]
mod read;

use std::ffi::OsString;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

pub use columns::{ColumnForm, tables};
use linkwear_runtime::{Table, write_csv};
#[cfg(feature = "cli")]
pub use read::CellsRead;
use serde_json::Value;

use crate::files::{WriteError, check_target, write_stdout, write_whole};
use crate::provenance::Provenance;

/// A format of tables.
pub struct TableFormat {
    /// Extension of its files.
    pub extension: &'static str,
    /// What it is for.
    pub purpose: &'static str,
    /// Writes a whole file, with what is known about it where the format has room for that.
    pub write: fn(&mut (dyn Write + Send), &Table<'_>, &Value) -> io::Result<()>,
    /// Whether it has.
    pub has_room: bool,
    /// Reads a file back.
    #[cfg(feature = "cli")]
    read: fn(&Path) -> io::Result<read::Read>,
}

/// All formats; the first is taken where the extension is none of these.
pub static FORMATS: &[TableFormat] = &[
    TableFormat {
        extension: "csv",
        purpose: "text",
        write: |out, table, _| write_csv(out, table),
        has_room: false,
        #[cfg(feature = "cli")]
        read: read::read_csv,
    },
    TableFormat {
        extension: "npy",
        purpose: "NumPy structured array",
        write: |out, table, _| npy::write(out, table),
        has_room: false,
        #[cfg(feature = "cli")]
        read: npy::read,
    },
    #[cfg(feature = "parquet")]
    TableFormat {
        extension: "parquet",
        purpose: "Apache Parquet",
        write: parquet::write,
        has_room: true,
        #[cfg(feature = "cli")]
        read: parquet::read,
    },
];

/// A table in memory.
#[cfg(feature = "cli")]
#[derive(Debug, Default)]
pub struct TableRead {
    /// Its columns with their titles, as `R1.q [rad]`.
    pub columns: Vec<(String, CellsRead)>,
    /// What it is of, if that is known.
    pub provenance: Option<Value>,
}

/// Whether the extension is that of a table.
#[cfg(feature = "cli")]
pub fn is_table(file: &Path) -> bool {
    file.extension().is_some_and(|end| FORMATS.iter().any(|format| end == format.extension))
}

/// Reads a table, by the extension of its file, with what stands beside it.
///
/// # Errors
/// If the file cannot be read or is none.
#[cfg(feature = "cli")]
pub fn read_table(file: &Path) -> io::Result<TableRead> {
    let format = FORMATS.iter().find(|format| file.extension().is_some_and(|end| end == format.extension));
    let format = format.ok_or_else(|| read::broken("its extension is that of no table"))?;
    let (columns, about) = (format.read)(file)?;
    let provenance = about.and_then(|about| about.get("provenance").cloned()).or_else(|| told_beside(file));
    Ok(TableRead { columns, provenance })
}

/// What `FILE-metadata.json` says that the table is of.
#[cfg(feature = "cli")]
fn told_beside(file: &Path) -> Option<Value> {
    let about: Value = serde_json::from_str(&fs::read_to_string(beside(file)).ok()?).ok()?;
    about["notes"].get(0)?.get("provenance").cloned()
}

/// Whether rows go to stdout, as text and alone.
pub fn is_stdout(file: &Path) -> bool {
    file == Path::new("-")
}

/// The format of a file.
fn format(file: &Path) -> &'static TableFormat {
    let is_named = |format: &&TableFormat| file.extension().is_some_and(|given| given == format.extension);
    FORMATS.iter().find(is_named).unwrap_or(&FORMATS[0])
}

/// Writes a table to a file that is there whole or not at all, and what it is of: in the file where its format has room, else beside
/// it in `<file>-metadata.json`, by the W3C's standard "CSV on the Web". A stream has the rows
/// alone, as has stdout for `-`.
///
/// # Errors
/// As [`write_whole`].
pub fn write_table(
    file: &Path,
    table: &Table<'_>,
    provenance: Option<&Provenance>,
) -> Result<(), WriteError> {
    if is_stdout(file) {
        return write_stdout(|out| write_csv(out, table));
    }
    let format = format(file);
    let beside = (!format.has_room && !check_target(file)?).then(|| beside(file));
    // A signal that ends the program waits until both are there.
    #[cfg(feature = "cli")]
    let _held = crate::progress::Held::new();
    write_whole(file, |out| {
        (format.write)(out, table, &about::in_file(table, provenance))?;
        out.flush()?;
        // What is said of the rows before goes with them.
        match beside.as_deref().map(fs::remove_file) {
            Some(Err(error)) if error.kind() != io::ErrorKind::NotFound => Err(error),
            _ => Ok(()),
        }
    })?;
    let Some(beside) = beside else { return Ok(()) };
    let about = about::beside(file, table, provenance);
    write_whole(&beside, |out| writeln!(out, "{about:#}"))
}

/// Where readers of "CSV on the Web" look for what is said of a file.
pub(crate) fn beside(file: &Path) -> PathBuf {
    let mut name = OsString::from(file);
    name.push("-metadata.json");
    name.into()
}
