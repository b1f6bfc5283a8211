//! What became of a study. In: rows as they are run. Out: columns with names and units, a table. Never knows how rows are run.

use std::borrow::Cow;

use linkwear_runtime::{Cells, Table};
use serde::{Deserialize, Serialize};

use crate::provenance::Provenance;

/// What a column has.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// A parameter that varies.
    Parameter,
    /// What became of the point.
    Result,
    /// Why nothing became of it: the code of its error.
    Error,
}

/// A column of the rows.
#[derive(Clone, Debug, Deserialize, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct StudyColumn {
    /// Its name, `speed`, `life.mean`.
    pub name: String,
    /// SI unit, or that of the name; `1` if it has none, nothing for words.
    pub unit: String,
    /// What it has.
    pub kind: Kind,
}

impl StudyColumn {
    pub(super) fn parameter(name: &str, unit: String) -> Self {
        Self { name: name.to_owned(), unit, kind: Kind::Parameter }
    }

    /// `speed [1/s]`; the code of an error has no unit.
    pub fn title(&self) -> String {
        if self.kind == Kind::Error { self.name.clone() } else { format!("{} [{}]", self.name, self.unit) }
    }
}

/// What is told of a study whatever becomes of its points.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct StudyFacts {
    /// The mechanism.
    pub name: String,
    /// Columns: parameters, results, the error.
    pub columns: Vec<StudyColumn>,
    /// What the result is of.
    pub provenance: Provenance,
}

/// Why there is nothing at a point.
#[derive(Clone, Debug, Deserialize, PartialEq, Eq, Serialize)]
pub struct PointError {
    /// Code of the diagnostic.
    pub code: String,
    /// What is wrong.
    pub message: String,
    /// What to do about it; may be empty.
    pub help: String,
}

/// What became of a point. A number that is not there is none: it never stands for another.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Row {
    /// Values of the parameters [SI].
    pub parameters: Vec<Option<f64>>,
    /// Results; none of them with an error.
    pub results: Vec<Option<f64>>,
    /// Why there are no results.
    pub error: Option<PointError>,
    /// Where the results are not to be trusted.
    pub warnings: Vec<String>,
}

impl Row {
    /// Its numbers, in the order of the columns.
    pub fn numbers(&self) -> impl Iterator<Item = Option<f64>> + '_ {
        self.parameters.iter().chain(&self.results).copied()
    }

    /// Code of its error; empty without.
    pub fn code(&self) -> &str {
        self.error.as_ref().map_or("", |error| &error.code)
    }
}

/// What became of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct StudyResult {
    /// What is told with the rows.
    pub facts: StudyFacts,
    /// One for each point, in the order of their numbers.
    pub rows: Vec<Row>,
}

impl StudyResult {
    /// Points at which nothing could be run, with their numbers from 0.
    pub fn failed(&self) -> impl Iterator<Item = (usize, &PointError)> {
        self.rows.iter().enumerate().filter_map(|(at, row)| Some((at, row.error.as_ref()?)))
    }

    /// What is doubtful about results, with the numbers of their points from 0.
    pub fn warnings(&self) -> impl Iterator<Item = (usize, &str)> {
        let rows = self.rows.iter().enumerate();
        rows.flat_map(|(at, row)| row.warnings.iter().map(move |warning| (at, &**warning)))
    }

    /// The rows as a table: numbers that are not there are empty cells in text, and not a number in files of numbers.
    pub fn table(&self) -> Table<'_> {
        let numbers = self.facts.columns.iter().filter(|column| column.kind != Kind::Error).enumerate();
        let table = numbers.fold(Table::new(self.rows.len()), |table, (at, column)| {
            let cell = move |row: usize| self.rows[row].numbers().nth(at).flatten().unwrap_or(f64::NAN);
            table.column(&*column.name, Cow::Borrowed(&*column.unit), Cells::numbers(cell))
        });
        table.column("error", "", Cells::names(|row| self.rows[row].code()))
    }
}
