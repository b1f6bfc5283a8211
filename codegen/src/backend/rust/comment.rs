//! Texts of comments. Formatters drop `//`, so markers stand in for section comments until the text is formatted.

use crate::tape::Operations;

/// Name of the marker statement; `__section!(3);` stands for the title of section 3.
pub const MARKER: &str = "__section";

/// Replaces marker statements by comments.
pub fn with_comments(text: &str, titles: &[String]) -> String {
    let mut result = String::with_capacity(text.len());
    for line in text.lines() {
        let trimmed = line.trim_start();
        let title = trimmed
            .strip_prefix(MARKER)
            .and_then(|rest| rest.strip_prefix("!(")?.strip_suffix(");")?.parse::<usize>().ok())
            .and_then(|index| titles.get(index));
        match title {
            Some(title) => {
                result.push_str(&line[..line.len() - trimmed.len()]);
                result.push_str("// ");
                result.push_str(&one_line(title));
            }
            None => result.push_str(line),
        }
        result.push('\n');
    }
    result
}

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
