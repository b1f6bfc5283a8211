//! Texts of comments, in every language.

use crate::tape::Operations;

/// User text for a comment: one line, no control characters.
pub fn one_line(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

/// Counts for a reader.
pub fn count_text(operations: &Operations) -> String {
    format!(
        "{} operations ({} mul, {} add, {} div, {} sqrt, {} sincos, {} other)",
        operations.total,
        operations.mul,
        operations.add,
        operations.div,
        operations.sqrt,
        operations.sincos,
        operations.other
    )
}
