//! `diff --format json`.

#[cfg(test)]
use schemars::JsonSchema;
use serde::Serialize;

/// What two results of one kind have different.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct DiffAnswer {
    /// What they are: `a table`, `a mechanism file`, `a result of life`.
    pub kind: String,
    /// Whether nothing differs but, perhaps, what they are of.
    pub identical: bool,
    /// What was given as `--tolerance`; null without.
    pub tolerance: Option<f64>,
    /// Whether all agree within it; null without.
    pub agree: Option<bool>,
    /// Columns or keys that both have.
    pub keys: usize,
    /// Rows of both tables; null for others.
    pub rows: Option<[usize; 2]>,
    /// What they are of, where it differs: version, seed, options, parameters, back end.
    pub made: Vec<MadeAnswer>,
    /// Columns or keys that differ, the largest part of their range first, words before numbers.
    pub differences: Vec<DifferenceAnswer>,
    /// Columns or keys that only the first has.
    pub only_in_a: Vec<String>,
    /// Columns or keys that only the second has.
    pub only_in_b: Vec<String>,
}

/// Something that two results are of.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct MadeAnswer {
    /// Its name, as `options.tol`.
    pub key: String,
    /// Of the first; empty where it has none.
    pub a: String,
    /// Of the second; empty where it has none.
    pub b: String,
}

/// A column or key that differs.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct DifferenceAnswer {
    /// Its name; `[]` stands for all indices of a list.
    pub key: String,
    /// Largest absolute difference, in the unit of the column; null between words, and where one is no number.
    pub largest: Option<f64>,
    /// The same over the range of the column in both, or the size of a constant; null as `largest`.
    pub relative: Option<f64>,
    /// The value of the first there.
    pub a: String,
    /// The value of the second there.
    pub b: String,
    /// Where it is; null for a single value.
    pub place: Option<PlaceAnswer>,
}

/// Where the largest difference is.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct PlaceAnswer {
    /// The row (`row 12`, counted from 1), or the key with its indices.
    pub key: String,
    /// First column of a table, often the time; null for others.
    pub column: Option<String>,
    /// Its value there; null for others.
    pub value: Option<String>,
}
