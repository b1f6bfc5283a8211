//! What is said of a table: its columns, and what it is of. In: a table, its provenance. Out: JSON, by the standard "CSV on the Web"
//! (<https://www.w3.org/TR/tabular-metadata/>) where it stands beside a file. Never knows where files lie: results that are merged
//! elsewhere have the same bytes.

use std::path::Path;

use linkwear_runtime::{Cells, Table, TableColumn};
use serde_json::{Map, Value, json};

use crate::provenance::{Provenance, sealed};

/// For the file itself, where its format has room.
pub fn in_file(table: &Table<'_>, provenance: Option<&Provenance>) -> Value {
    sealed(json!({ "columns": columns(table) }), provenance)
}

/// For a file beside it. `format`, `unit` and `provenance` are linkwear's own; readers of the standard pass over them.
pub fn beside(file: &Path, table: &Table<'_>, provenance: Option<&Provenance>) -> Value {
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    let schema = json!({
        "@context": "http://www.w3.org/ns/csvw", "url": name, "tableSchema": { "columns": columns(table) },
    });
    sealed(schema, provenance)
}

fn columns(table: &Table<'_>) -> Vec<Value> {
    table.columns.iter().map(column).collect()
}

fn column(column: &TableColumn<'_>) -> Value {
    let datatype = match column.cells {
        Cells::Numbers(_) => "double",
        Cells::Counts(_) => "unsignedLong",
        Cells::Names(_) => "string",
    };
    let mut about = Map::new();
    about.insert("name".to_owned(), json!(variable(&column.name)));
    about.insert("titles".to_owned(), json!(column.title()));
    about.insert("datatype".to_owned(), json!(datatype));
    if !column.unit.is_empty() {
        about.insert("unit".to_owned(), json!(column.unit));
    }
    about.into()
}

/// A name in the letters that the standard has for names.
fn variable(name: &str) -> String {
    name.chars().map(|c| if c.is_ascii_alphanumeric() || c == '.' { c } else { '_' }).collect()
}
