//! What is said of a table: its columns, and what it is of. In: a table, its provenance. Out: JSON, by the standard "CSV on the Web"
//! (<https://www.w3.org/TR/tabular-metadata/>) where it stands beside a file. Never knows where files lie: results that are merged
//! elsewhere have the same bytes.

use std::path::Path;

use linkwear_runtime::{Cells, Table, TableColumn};
use serde::Serialize;
use serde_json::{Value, json};

use crate::provenance::{FORMAT, Provenance, sealed};

/// What is said of a table within a file, under the key `linkwear` of its metadata.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct TableWithin {
    /// The columns, in order.
    columns: Vec<ColumnAbout>,
}

/// What is said of a table beside its file, by the standard "CSV on the Web".
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct TableBeside {
    /// `http://www.w3.org/ns/csvw`: the standard.
    #[serde(rename = "@context")]
    context: &'static str,
    /// Name of the table's file.
    url: String,
    /// How the table is made up.
    #[serde(rename = "tableSchema")]
    schema: TableWithin,
    /// One object: the standard's place for what it does not know.
    notes: [Note; 1],
}

/// What linkwear adds.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct Note {
    /// Version of the form of all JSON, as everywhere.
    format: u64,
    /// What the table is of: what decides its numbers.
    #[serde(skip_serializing_if = "Option::is_none")]
    provenance: Option<Provenance>,
}

/// A column.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct ColumnAbout {
    /// Its name without the unit, `R1.q`, other signs than letters, digits and points as `_`.
    name: String,
    /// Its head in the table: `R1.q [rad]`.
    titles: String,
    /// `double`; `unsignedLong`, a whole number; `string`.
    datatype: &'static str,
    /// Its unit, in the words of schema.org as the standard asks for; absent where it has none.
    #[serde(rename = "schema:unitText", skip_serializing_if = "Option::is_none")]
    unit: Option<String>,
}

/// For the file itself, where its format has room.
pub fn in_file(table: &Table<'_>, provenance: Option<&Provenance>) -> Value {
    sealed(json!(TableWithin::of(table)), provenance)
}

/// For a file beside it.
pub fn beside(file: &Path, table: &Table<'_>, provenance: Option<&Provenance>) -> Value {
    let url = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let context = "http://www.w3.org/ns/csvw";
    let notes = [Note { format: FORMAT, provenance: provenance.cloned() }];
    json!(TableBeside { context, url, schema: TableWithin::of(table), notes })
}

impl TableWithin {
    fn of(table: &Table<'_>) -> Self {
        Self { columns: table.columns.iter().map(ColumnAbout::of).collect() }
    }
}

impl ColumnAbout {
    fn of(column: &TableColumn<'_>) -> Self {
        Self {
            name: variable(&column.name),
            titles: column.title(),
            datatype: match column.cells {
                Cells::Numbers(_) => "double",
                Cells::Counts(_) => "unsignedLong",
                Cells::Names(_) => "string",
            },
            unit: (!column.unit.is_empty()).then(|| column.unit.clone().into_owned()),
        }
    }
}

/// A name in the letters that the standard has for names.
fn variable(name: &str) -> String {
    name.chars().map(|c| if c.is_ascii_alphanumeric() || c == '.' { c } else { '_' }).collect()
}
