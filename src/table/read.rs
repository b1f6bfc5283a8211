//! Cells that are read back, and CSV. In: a file. Out: its columns. Never knows what the numbers mean.

use std::fs;
use std::io::{self, ErrorKind};
use std::path::Path;

use serde_json::Value;

use crate::csv_table::rows::{BrokenRow, Rows};

/// The cells of a column.
#[derive(Debug, PartialEq)]
pub enum CellsRead {
    /// Numbers; NaN where a cell is empty.
    Numbers(Vec<f64>),
    /// Words.
    Texts(Vec<String>),
}

/// What cannot be read, in a sentence.
pub(super) fn broken(message: impl Into<String>) -> io::Error {
    io::Error::new(ErrorKind::InvalidData, message.into())
}

/// Columns, and what the file says about itself.
pub(super) type Read = (Vec<(String, CellsRead)>, Option<Value>);

/// Reads CSV: a line of titles, then rows.
pub(super) fn read_csv(file: &Path) -> io::Result<Read> {
    let text = fs::read_to_string(file)?;
    let mut rows = Rows::new(&text, false);
    let wrong = |BrokenRow { line, why, .. }: BrokenRow| broken(format!("line {line}: {why}"));
    let titles = rows.next().transpose().map_err(wrong)?.map(|(_, titles)| titles).unwrap_or_default();
    let titles: Vec<String> = titles.iter().map(str::to_owned).collect();
    let mut texts: Vec<Vec<String>> = titles.iter().map(|_| Vec::new()).collect();
    for row in rows {
        for (column, cell) in texts.iter_mut().zip(&row.map_err(wrong)?.1) {
            column.push(cell.to_owned());
        }
    }
    Ok((titles.into_iter().zip(texts.into_iter().map(cells)).collect(), None))
}

/// Numbers, if all cells with anything in them are.
fn cells(texts: Vec<String>) -> CellsRead {
    let number = |text: &String| if text.is_empty() { Some(f64::NAN) } else { text.parse().ok() };
    let numbers: Option<Vec<f64>> = texts.iter().map(number).collect();
    match numbers {
        Some(numbers) if texts.iter().any(|text| !text.is_empty()) => CellsRead::Numbers(numbers),
        _ => CellsRead::Texts(texts),
    }
}
