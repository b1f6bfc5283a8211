//! What a function of generated code reads and writes, as lines for a reader, in every language. In: a tape. Out: text.

use crate::tape::{Block, Split, Tape};

use super::comment::{count_text, one_line};

/// Every block of the input `x` and the output `y`; `escape` is for what is written about it.
pub fn blocks(tape: &Tape, escape: impl Fn(&str) -> String) -> Vec<String> {
    let mut lines = Vec::new();
    let mut list = |title: &str, blocks: &[Block]| {
        let mut first = 0;
        for block in blocks {
            let end = first + block.len();
            let range = if first == end { "empty".to_owned() } else { format!("{first}..{end}") };
            first = end;
            let text = one_line(&escape(&format!("{}{}", block.doc, block.cited())));
            lines.push((format!("{title}[{range}]"), format!("{} ({}): {text}", block.name, block.shape())));
        }
    };
    list("x", &tape.inputs);
    list("y", &tape.outputs);
    lines.into_iter().map(|(place, text)| format!("- `{place}` {text}")).collect()
}

/// Operations, parts and what they hand over.
pub fn cost(tape: &Tape, split: &Split) -> String {
    format!(
        "{} in {} {}; `w` holds {} values between parts.",
        count_text(&tape.operations()),
        split.parts.len(),
        if split.parts.len() == 1 { "part" } else { "parts" },
        split.slots
    )
}
