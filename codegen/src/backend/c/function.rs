//! One entry point as a function of C over flat arrays, in parts where it is long. In: a tape and its split. Out: text.

use crate::tape::{Split, Tape};

use super::super::comment::count_text;
use super::super::interface::{blocks, cost, function_name};
use super::body;
use super::text::block;

const ARGUMENTS: &str = "const double *restrict x, double *restrict y, double *restrict w";

/// The public function and its parts; `pfx_` stands for the prefix.
pub fn functions(tape: &Tape, split: &Split) -> String {
    let name = function_name(tape);
    let read = body::read(tape);
    let mut parts: Vec<String> = split.parts.iter().map(|part| body::part(tape, part, &read)).collect();
    let mut public = body::direct(tape);
    let mut text = String::new();
    if parts.len() > 1 {
        for (number, part) in (1..).zip(&parts) {
            text.push_str(&frame(&format!("static void pfx_{name}_part_{number}"), part));
            public.push_str(&format!("    pfx_{name}_part_{number}(x, y, w);\n"));
        }
    } else {
        public.push_str(&parts.remove(0));
    }
    text.push_str(&format!("/* {}. */\n", count_text(&tape.operations())));
    text + &frame(&format!("void pfx_{name}"), &public)
}

/// A function with its arguments, those marked that it does not need.
fn frame(name: &str, statements: &str) -> String {
    let unused = ["x", "y", "w"].into_iter().filter(|argument| {
        !statements.contains(&format!("{argument}[")) && !statements.contains("(x, y, w)")
    });
    let unused: String = unused.map(|argument| format!("    (void){argument};\n")).collect();
    format!("{name}({ARGUMENTS})\n{{\n{unused}{statements}}}\n\n")
}

/// The declaration with its documentation.
pub fn declaration(tape: &Tape, split: &Split) -> String {
    let mut lines = vec![tape.doc.clone(), String::new()];
    lines.extend(blocks(tape, str::to_owned).iter().map(|line| line.replace('`', "")));
    lines.extend([String::new(), cost(tape, split).replace('`', "")]);
    let (doc, name) = (block(&lines), function_name(tape));
    format!("{doc}void pfx_{name}(const double *x, double *y, double *w);\n\n")
}
