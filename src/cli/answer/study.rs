//! `study --format json`.

#[cfg(test)]
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value;

use super::life::ShardAnswer;
use crate::study::{PointError, StudyColumn, StudyResult};

/// A mechanism at many points: what its runs and lives come to at each.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct StudyAnswer<'a> {
    /// Name of the mechanism.
    pub name: &'a str,
    /// Columns of the rows: parameters, results, the error.
    pub columns: &'a [StudyColumn],
    /// A row for each point, in the order of the columns: numbers, null where there is none; last the code of the error, null
    /// without one.
    pub rows: Vec<Vec<Value>>,
    /// Number of points at which nothing could be run.
    pub failed: usize,
    /// Why, for each of them.
    pub failures: Vec<PointFailure<'a>>,
    /// What is doubtful about results.
    pub warnings: Vec<PointWarning<'a>>,
    /// Which shard of the study this is of; absent where it is of all.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shard: Option<ShardAnswer>,
}

/// Why there is nothing at a point.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct PointFailure<'a> {
    /// The row, from 0.
    row: usize,
    /// Code of the diagnostic.
    code: &'a str,
    /// What is wrong.
    message: &'a str,
    /// What to do about it; may be empty.
    help: &'a str,
}

/// What is doubtful about the results at a point.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct PointWarning<'a> {
    /// The row, from 0.
    row: usize,
    /// `study`.
    code: &'static str,
    /// What is doubtful.
    message: &'a str,
}

impl<'a> StudyAnswer<'a> {
    /// Of all points, or of a shard.
    pub fn new(result: &'a StudyResult, shard: Option<ShardAnswer>) -> Self {
        let failure = |(row, PointError { code, message, help }): (usize, &'a PointError)| PointFailure {
            row,
            code,
            message,
            help,
        };
        let warning = |(row, message): (usize, &'a str)| PointWarning { row, code: "study", message };
        let row = |row: &'a crate::study::Row| {
            let error = row.error.as_ref().map(|error| Value::from(&*error.code));
            row.numbers().map(Value::from).chain([error.unwrap_or_default()]).collect()
        };
        Self {
            name: &result.facts.name,
            columns: &result.facts.columns,
            rows: result.rows.iter().map(row).collect(),
            failed: result.failed().count(),
            failures: result.failed().map(failure).collect(),
            warnings: result.warnings().map(warning).collect(),
            shard,
        }
    }
}
