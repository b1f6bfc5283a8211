//! What a subcommand answers, for people and for machines. Never knows how it came about.

use crate::files::{WriteError, print};
use crate::provenance::{Provenance, sealed};
use serde_json::Value;

use super::arguments::Format;

/// An answer in both forms.
#[derive(Debug)]
pub struct Answer {
    /// For people.
    pub text: String,
    /// For machines.
    pub json: Value,
}

impl Answer {
    /// With the format of its JSON, and what it is of if that has a name.
    pub fn new(text: String, json: Value, provenance: Option<&Provenance>) -> Self {
        Self { text, json: sealed(json, provenance) }
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
