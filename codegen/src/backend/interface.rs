//! What a function of generated code reads and writes, as lines for a reader, in every language. In: a tape. Out: text.

use std::borrow::Cow;

use linkwear_runtime::Entry;

use crate::tape::{Block, Operand, Split, Tape};

use super::comment::{count_text, one_line};

/// What is written about a mechanism whose mass matrix is left out.
pub const MASS_LEFT_OUT: &str =
    "The mass matrix is left out, as of all mechanisms that are as long: zeros stand in its place.";

/// Whether zeros stand in the place of the mass matrix.
pub fn mass_is_left_out(tape: &Tape) -> bool {
    let length = tape.outputs.first().map_or(0, Block::len);
    let is_zero = |operand: &Operand| matches!(operand, Operand::Constant(number) if *number == 0.0);
    let zeros = tape.direct.iter().filter(|(index, operand)| (*index as usize) < length && is_zero(operand));
    tape.name == Entry::EquationsOfMotion.name() && length > 0 && zeros.count() == length
}

/// What a function is called: who asks for masses that are not there has to read so.
pub fn function_name(tape: &Tape) -> Cow<'_, str> {
    match mass_is_left_out(tape) {
        true => Cow::Owned(format!("{}_without_mass", tape.name)),
        false => Cow::Borrowed(&tape.name),
    }
}

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
