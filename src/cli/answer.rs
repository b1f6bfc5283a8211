//! What a subcommand answers, for people and for machines. Never knows how it came about.

use linkwear::files::{WriteError, print};
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
    /// Prints the form that was asked for.
    pub fn print(&self, format: Format) -> Result<(), WriteError> {
        match format {
            Format::Text => print(&self.text.trim_end()),
            Format::Json => print(&self.json),
        }
    }
}
