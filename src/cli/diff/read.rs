//! A result as columns of cells: those of a table, or the keys of a JSON or TOML file, lists being columns. In: a file. Out:
//! [`Known`]. Never knows another file.

use std::path::Path;

use linkwear_codegen::input::read_text;
use linkwear_codegen::limits;
use linkwear_codegen::spec::{Dimension, as_written, parse_expression};
use serde_json::{Map, Value};

use super::super::failure::Failure;
use super::super::life::folder::LIFE;
use super::super::shipped_schemas::SCHEMAS;
use crate::table::{CellsRead, is_table, read_table};

/// Keys that tell how long something took here: two runs never have the same.
const CLOCKS: &[&str] = &["wall_seconds", "seconds", "ns", "milliseconds_per_turn"];
/// Keys that tell what made a result and change no number of it.
const MADE: &[&str] = &["format", "backend", "file"];

/// Integers up to which numbers tell all apart.
const EXACT: u64 = 1 << 53;

/// A cell: a number, a word, or nothing.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    Number(f64),
    /// In SI, with a dimension: a second is no metre.
    Quantity(f64, Dimension),
    Text(String),
}

impl Cell {
    pub fn shown(&self) -> String {
        match self {
            Self::Number(value) if *value != 0.0 && !(1e-4..1e12).contains(&value.abs()) => {
                format!("{value:e}")
            }
            Self::Number(value) => format!("{value}"),
            Self::Quantity(value, dimension) => {
                format!("{} {}", Self::Number(*value).shown(), dimension.si_unit())
            }
            Self::Text(text) => text.clone(),
        }
    }
}

/// A column of cells with their places.
#[derive(Debug, Default)]
pub struct Column {
    pub key: String,
    /// Places within the column (`cycles[3].joints[0].wear_m`), none in a table, where they are rows.
    pub places: Vec<String>,
    pub cells: Vec<Cell>,
}

/// A result that was read.
#[derive(Debug)]
pub struct Known {
    /// What it is, for people: `a result of life`, `a table`.
    pub kind: String,
    pub is_table: bool,
    pub columns: Vec<Column>,
    /// What it is of, by key.
    pub made: Vec<(String, String)>,
}

/// Reads a file, by its extension.
pub fn read(path: &Path) -> Result<Known, Failure> {
    let inside = path.join(LIFE);
    let file = if path.is_dir() { inside.as_path() } else { path };
    if is_table(file) {
        return table(file);
    }
    let text = read_text(file, limits::DATA_BYTES).map_err(Failure::read(file))?;
    let broken = |message: String, line: Option<usize>| {
        Failure::data(file, line, message, "give JSON of --format json, a table, or a mechanism file (.toml)")
    };
    if file.extension().is_some_and(|end| end == "toml") {
        let value: toml::Table = toml::from_str(&text)
            .map_err(|error| broken(format!("this is no TOML: {}", error.message()), None))?;
        return Ok(of_keys("a mechanism file".to_owned(), of_toml(toml::Value::Table(value)), true));
    }
    let value: Value = serde_json::from_str(&text)
        .map_err(|error| broken(format!("this is no JSON: {error}"), Some(error.line())))?;
    let Some(kind) = value.as_object().and_then(kind) else {
        return Err(broken("this is no result of linkwear".to_owned(), None));
    };
    Ok(of_keys(format!("a result of {kind}"), value, false))
}

/// The same as JSON, in which words stand for numbers that are not finite: JSON has none.
fn of_toml(value: toml::Value) -> Value {
    match value {
        toml::Value::Table(table) => {
            Value::Object(table.into_iter().map(|(key, value)| (key, of_toml(value))).collect())
        }
        toml::Value::Array(list) => list.into_iter().map(of_toml).collect(),
        toml::Value::String(text) => text.into(),
        toml::Value::Integer(number) => number.into(),
        toml::Value::Float(number) if number.is_finite() => number.into(),
        toml::Value::Float(number) => number.to_string().into(),
        toml::Value::Boolean(is) => is.into(),
        toml::Value::Datetime(time) => time.to_string().into(),
    }
}

/// Which output it is: the one whose schema has all of its keys.
fn kind(object: &Map<String, Value>) -> Option<&'static str> {
    SCHEMAS.iter().find_map(|(name, schema)| {
        let schema: Value = serde_json::from_str(schema).ok()?;
        let known = schema["properties"].as_object()?;
        let required = schema["required"].as_array()?;
        let has_all = required.iter().filter_map(Value::as_str).all(|key| object.contains_key(key));
        (has_all && object.keys().all(|key| known.contains_key(key))).then_some(*name)
    })
}

fn table(file: &Path) -> Result<Known, Failure> {
    let read = read_table(file).map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound | std::io::ErrorKind::PermissionDenied => Failure::read(file)(error),
        _ => Failure::data(file, None, format!("this is no table: {error}"), "make it anew by --out"),
    })?;
    let columns = read.columns.into_iter().map(|(key, cells)| Column {
        key,
        places: Vec::new(),
        cells: match cells {
            CellsRead::Numbers(cells) => cells.into_iter().map(Cell::Number).collect(),
            CellsRead::Texts(cells) => cells.into_iter().map(Cell::Text).collect(),
        },
    });
    let columns = columns.collect();
    let mut made = Vec::new();
    provenance(&mut made, "", &read.provenance.unwrap_or_default());
    Ok(Known { kind: "a table".to_owned(), is_table: true, columns, made })
}

fn of_keys(kind: String, value: Value, is_toml: bool) -> Known {
    let mut result = Known { kind, is_table: false, columns: Vec::new(), made: Vec::new() };
    let Value::Object(object) = value else { return result };
    for (key, value) in object {
        if !is_toml && key == "provenance" {
            provenance(&mut result.made, "", &value);
        } else if !is_toml && MADE.contains(&key.as_str()) {
            result.made.push((key, plain(&value)));
        } else if is_toml || !CLOCKS.contains(&key.as_str()) {
            flatten(&mut result.columns, (&key, &key), &value, is_toml);
        }
    }
    result
}

/// Every value of a provenance by its path.
fn provenance(made: &mut Vec<(String, String)>, path: &str, value: &Value) {
    match value {
        Value::Object(object) => {
            for (key, value) in object {
                let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
                provenance(made, &path, value);
            }
        }
        Value::Null if path.is_empty() => {}
        value => made.push((path.to_owned(), plain(value))),
    }
}

fn plain(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

/// Adds the values below a key: lists are columns, so indices leave the key and go into the place.
fn flatten(columns: &mut Vec<Column>, (key, place): (&str, &str), value: &Value, is_toml: bool) {
    match value {
        // In a file an empty table is more than none.
        Value::Object(object) if is_toml && object.is_empty() => {
            add(columns, (key, place), Cell::Text("{}".to_owned()))
        }
        Value::Array(list) if is_toml && list.is_empty() => {
            add(columns, (key, place), Cell::Text("[]".to_owned()))
        }
        Value::Object(object) => {
            for (name, value) in object.iter().filter(|(name, _)| is_toml || !CLOCKS.contains(&name.as_str()))
            {
                flatten(columns, (&format!("{key}.{name}"), &format!("{place}.{name}")), value, is_toml);
            }
        }
        Value::Array(list) => {
            for (at, value) in list.iter().enumerate() {
                flatten(columns, (&format!("{key}[]"), &format!("{place}[{at}]")), value, is_toml);
            }
        }
        value => {
            let cell = match value {
                Value::Number(number) if is_rounded(number) => Cell::Text(number.to_string()),
                Value::Number(number) => Cell::Number(number.as_f64().unwrap_or(f64::NAN)),
                Value::String(text) if is_toml => quantity(text),
                value => Cell::Text(plain(value)),
            };
            add(columns, (key, place), cell);
        }
    }
}

/// Whether a number would lose digits.
fn is_rounded(number: &serde_json::Number) -> bool {
    let size = number.as_i64().map(i64::unsigned_abs).or_else(|| number.as_u64());
    size.is_some_and(|size| size > EXACT)
}

fn add(columns: &mut Vec<Column>, (key, place): (&str, &str), cell: Cell) {
    // Values of a list of objects come in turns.
    let at = columns.iter().rposition(|known| known.key == key).unwrap_or_else(|| {
        columns.push(Column { key: key.to_owned(), ..Column::default() });
        columns.len() - 1
    });
    columns[at].places.push(place.to_owned());
    columns[at].cells.push(cell);
}

/// A quantity of a mechanism file in SI, so that 10 um and 0.01 mm are one; a formula as it stands.
fn quantity(text: &str) -> Cell {
    let value = as_written(text).and_then(|_| parse_expression(text, &|_| false).ok()?.quantity());
    match value {
        Some((value, Dimension::NONE)) => Cell::Number(value),
        Some((value, dimension)) => Cell::Quantity(value, dimension),
        None => Cell::Text(text.to_owned()),
    }
}
