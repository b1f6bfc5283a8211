//! What field data say beside numbers: bounds of wear, parts replaced or reground, limits of entry. In: cells of a table. Out: typed
//! words; or what is wrong, with its line. Never knows how they are fitted.

use crate::csv_table::CsvTable;
use linkwear_gamma::data::{Reset, Seen};

use super::super::arguments::FitArguments;
use super::super::failure::Failure;

/// Marks before a number that make a bound of it; of two that begin alike the longer one first.
const MARKS: [(&str, Seen); 4] =
    [(">=", Seen::AtLeast), (">", Seen::AtLeast), ("<=", Seen::Below), ("<", Seen::Below)];

/// Wear, or bounds of it.
pub fn wears(arguments: &FitArguments, table: &CsvTable<'_>) -> Result<Vec<(Seen, f64)>, Failure> {
    let marks = MARKS.map(|(mark, _)| mark);
    let found = table.numbers_after(&arguments.wear, &marks)?;
    Ok(found.into_iter().map(|(mark, number)| (mark.map_or(Seen::Exact, |at| MARKS[at].1), number)).collect())
}

/// What was done to the parts, if a column says so.
pub fn resets(arguments: &FitArguments, table: &CsvTable<'_>) -> Result<Vec<Option<Reset>>, Failure> {
    let Some(column) = &arguments.reset else { return Ok(vec![None; table.lines().count()]) };
    let cells = table.texts(column)?;
    let read = cells.iter().zip(table.lines()).map(|(cell, line)| {
        let refused = || {
            let message = format!("line {line}: `{column}` is `{cell}`, no reset of a part");
            let help = "write `replaced`, `replaced=LEVEL`, `reground=LEVEL`, or `?` for the same part at an unknown level; \
                        leave it empty where nothing was done";
            Failure::data(&arguments.file, Some(line), message, help)
        };
        reset(cell).map_err(|()| refused())
    });
    let found = read.collect::<Result<Vec<_>, _>>()?;
    let replaced = found.iter().position(|reset| matches!(reset, Some(Reset::Replaced(_))));
    match (&arguments.lambda, replaced) {
        (Some(lambda), Some(at)) if !table.has(lambda) => {
            let message = format!("`{lambda}` has Lambda of one part from new; a part was replaced");
            let help = "give Lambda as a column of the readings, or --exposure alone";
            Err(Failure::data(&arguments.file, table.lines().nth(at), message, help))
        }
        _ => Ok(found),
    }
}

fn reset(cell: &str) -> Result<Option<Reset>, ()> {
    let level = |text: &str| match text.trim() {
        "?" => Ok(None),
        text => text.parse::<f64>().map(Some).map_err(|_| ()),
    };
    match cell.split_once('=') {
        None if cell.is_empty() => Ok(None),
        None if cell == "?" => Ok(Some(Reset::Reground(None))),
        None if cell == "replaced" => Ok(Some(Reset::Replaced(Some(0.0)))),
        Some((word, text)) if word.trim() == "replaced" => Ok(Some(Reset::Replaced(level(text)?))),
        Some((word, text)) if word.trim() == "reground" => Ok(Some(Reset::Reground(level(text)?))),
        _ => Err(()),
    }
}

/// Limits of wear that units entered below: one for all, or a column's.
pub fn limits(arguments: &FitArguments, table: &CsvTable<'_>) -> Result<Vec<Option<f64>>, Failure> {
    let count = table.lines().count();
    let Some(given) = &arguments.entered_below else { return Ok(vec![None; count]) };
    if let Ok(limit) = given.parse::<f64>() {
        return Ok(vec![Some(limit); count]);
    }
    Ok(table.numbers_or_none(given)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_resets_are_read_and_others_refused() {
        for (cell, expected) in [
            ("", None),
            ("?", Some(Reset::Reground(None))),
            ("replaced", Some(Reset::Replaced(Some(0.0)))),
            ("replaced=0.02", Some(Reset::Replaced(Some(0.02)))),
            ("replaced = ?", Some(Reset::Replaced(None))),
            ("reground=1e-3", Some(Reset::Reground(Some(1e-3)))),
        ] {
            assert_eq!(reset(cell), Ok(expected), "{cell}");
        }
        // A part that was reground has a level, known or not.
        for cell in ["reground", "new", "replaced=", "reground=x", "=1"] {
            assert_eq!(reset(cell), Err(()), "{cell}");
        }
    }
}
