//! What a subcommand answers, for people and for machines. In: a text, and one of the types of this folder, from which
//! `docs/schemas` and `docs/outputs.md` are made. Never knows how it came about.

pub mod check;
pub mod common;
pub mod diff;
pub mod equations;
#[cfg(test)]
mod errors;
pub mod explain;
pub mod fit;
pub mod identify;
pub mod life;
#[cfg(test)]
mod measured;
pub mod plan;
pub mod predict;
#[cfg(test)]
mod schemas;
pub mod sensitivity;
pub mod simulate;
pub mod study;

use crate::files::{WriteError, print};
use crate::provenance::{Provenance, sealed};
use serde::Serialize;
use serde_json::{Value, json};

use super::arguments::Format;

/// An answer in both forms.
#[derive(Debug)]
pub struct Answer {
    /// For people.
    pub text: String,
    /// For machines.
    pub json: Value,
    /// Whether the answer is no to what was asked: then the exit code is 1.
    pub disagrees: bool,
}

impl Answer {
    /// With the format of its JSON, and what it is of if that has a name.
    pub fn new(text: String, answer: impl Serialize, provenance: Option<&Provenance>) -> Self {
        Self { text, json: sealed(json!(answer), provenance), disagrees: false }
    }

    /// Prints the form that was asked for.
    pub fn print(&self, format: Format) -> Result<(), WriteError> {
        match format {
            // What was asked for is on stdout already.
            Format::Text if self.text.is_empty() => Ok(()),
            Format::Text => print(&self.text.trim_end()),
            Format::Json => print(&self.json),
        }
    }
}
