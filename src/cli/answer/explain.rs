//! `explain --format json`.

#[cfg(test)]
use schemars::JsonSchema;
use serde::Serialize;

/// What a code means, with an example and its cure.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct ExplainAnswer {
    /// The code.
    pub code: &'static str,
    /// `error` or `warning`.
    pub severity: &'static str,
    /// What it is, in a sentence.
    pub title: &'static str,
    /// What it means and why it is a fault.
    pub text: &'static str,
    /// Lines of a mechanism file, or a command line, with the fault.
    pub wrong: &'static str,
    /// The same, cured.
    pub right: &'static str,
    /// The whole file with the wrong lines; null for codes of the command line.
    pub wrong_file: Option<String>,
    /// The whole file with the right lines; null for codes of the command line.
    pub right_file: Option<String>,
    /// Files that these lie beside, because they name them.
    pub beside: Vec<BesideAnswer>,
}

/// A file that an example names.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct BesideAnswer {
    /// Its name.
    pub name: &'static str,
    /// What stands in it.
    pub text: &'static str,
}
