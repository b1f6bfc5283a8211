//! Statements of a tape as lines of Rust, four spaces deep. In: a tape and one of its parts. Out: text.
//! Written directly, for a parser and a formatter take twenty times as long as everything before them.

use std::collections::BTreeMap;
use std::fmt::Write;

use rustc_hash::FxHashMap;

use crate::expr::{Binary, Unary};
use crate::tape::{Op, Operand, Part, Statement, Tape};

use super::super::comment::one_line;
use super::names::Names;

/// Longer lines go through the formatter, which breaks them; shorter ones it would leave as they are (it has 89 columns).
const SURELY_ONE_LINE: usize = 80;

/// Stores of outputs that need no statement.
pub fn direct(tape: &Tape) -> String {
    let mut lines = Lines::default();
    // Most are the same number, zero: its text is made once.
    let mut last = (None, String::new());
    for (index, operand) in &tape.direct {
        let bits = if let Operand::Constant(number) = operand { Some(number.to_bits()) } else { None };
        if bits.is_none() || bits != last.0 {
            last = (bits, String::new());
            match operand {
                Operand::Input(input) => push_indexed(&mut last.1, "x", *input),
                other => push_number(&mut last.1, *other),
            }
        }
        lines.line(|line| push_store(line, *index, &last.1));
    }
    lines.text
}

/// Statements of one part, with its loads and saves.
pub fn part(tape: &Tape, part: &Part) -> String {
    let mut writer = Writer::default();
    let statements = &tape.statements[part.statements.clone()];
    writer.inputs(tape, statements);
    // Read where they are used: a `let` each would count against what compilers can take in one function.
    writer.values.extend(part.loads.iter().map(|(value, slot)| (*value, format!("w[{slot}]"))));
    let mut section = None;
    for statement in statements {
        if section != Some(statement.section) {
            section = Some(statement.section);
            writer.lines.comment(&one_line(&tape.sections[statement.section]));
        }
        writer.statement(statement);
    }
    for (value, slot) in &part.saves {
        let Writer { lines, values, .. } = &mut writer;
        lines.line(|line| {
            push_indexed(line, "w", *slot);
            line.extend([" = ", &values[value], ";"]);
        });
    }
    writer.lines.text
}

#[derive(Default)]
struct Lines {
    text: String,
}

impl Lines {
    fn comment(&mut self, text: &str) {
        let _ = writeln!(self.text, "    // {text}");
    }

    /// A statement, written at the end of the text: what is written elsewhere and copied takes as long as all the rest.
    fn line(&mut self, write: impl FnOnce(&mut String)) {
        const INDENT: &str = "    ";
        let begin = self.text.len();
        self.text.push_str(INDENT);
        let from = self.text.len();
        write(&mut self.text);
        if self.text.len() - from <= SURELY_ONE_LINE {
            self.text.push('\n');
        } else {
            let lines = formatted(&self.text[from..]);
            self.text.truncate(begin);
            self.text.push_str(&lines);
        }
    }
}

/// A statement as the formatter breaks it in a function.
fn formatted(statement: &str) -> String {
    #[expect(clippy::expect_used, reason = "the emitter's own text: a defect here, not in a user's file")]
    let file = syn::parse_str(&format!("fn f() {{ {statement} }}")).expect("a statement of Rust");
    let text = prettyplease::unparse(&file);
    let lines: Vec<&str> = text.lines().collect();
    lines[1..lines.len() - 1].iter().flat_map(|line| [line, "\n"]).collect()
}

#[derive(Default)]
struct Writer {
    names: Names,
    inputs: FxHashMap<u32, String>,
    values: FxHashMap<u32, String>,
    lines: Lines,
}

impl Writer {
    /// Names for the inputs that are read, in the order of the first reading; lines in the order of the slice.
    fn inputs(&mut self, tape: &Tape, statements: &[Statement]) {
        let mut read = BTreeMap::new();
        for operand in statements.iter().flat_map(Statement::reads) {
            if let Operand::Input(index) = operand {
                let name = || self.names.unique(&tape.input_names[index as usize]);
                read.entry(index).or_insert_with(name);
            }
        }
        for (index, name) in &read {
            self.lines.line(|line| {
                line.extend(["let ", name, " = "]);
                push_indexed(line, "x", *index);
                line.push(';');
            });
        }
        self.inputs.extend(read);
    }

    fn statement(&mut self, statement: &Statement) {
        statement
            .results()
            .zip(&statement.labels)
            .for_each(|(value, label)| self.name(value, label.as_deref()));
        let Self { inputs, values, lines, .. } = self;
        let names = Known { inputs, values };
        let name = |which: u32| values[&(statement.first + which)].as_str();
        lines.line(|line| {
            match statement.op {
                Op::SinCos(_) => line.extend(["let (", name(0), ", ", name(1), ") = "]),
                _ => line.extend(["let ", name(0), " = "]),
            }
            names.push_operation(line, &statement.op);
            line.push(';');
        });
        for (index, operand) in &statement.stores {
            lines.line(|line| match operand {
                Operand::Constant(_) => {
                    let mut value = String::new();
                    push_number(&mut value, *operand);
                    push_store(line, *index, &value);
                }
                Operand::Input(input) => push_store(line, *index, &inputs[input]),
                Operand::Value(value) => push_store(line, *index, &values[value]),
            });
        }
    }

    fn name(&mut self, value: u32, label: Option<&str>) {
        let name = match label {
            Some(label) => self.names.unique(label),
            None => {
                let mut name = "t".to_owned();
                push_digits(&mut name, value);
                self.names.unique_clean(name)
            }
        };
        self.values.insert(value, name);
    }
}

/// Names of what has been read and made so far.
struct Known<'a> {
    inputs: &'a FxHashMap<u32, String>,
    values: &'a FxHashMap<u32, String>,
}

impl Known<'_> {
    fn push(&self, text: &mut String, operand: Operand) {
        match operand {
            Operand::Constant(_) => push_number(text, operand),
            Operand::Input(index) => text.push_str(&self.inputs[&index]),
            Operand::Value(value) => text.push_str(&self.values[&value]),
        }
    }

    /// Operands with something before, between and behind them.
    fn push_call(
        &self,
        text: &mut String,
        before: &str,
        [a, b]: [Operand; 2],
        (between, behind): (&str, &str),
    ) {
        text.push_str(before);
        self.push(text, a);
        text.push_str(between);
        self.push(text, b);
        text.push_str(behind);
    }

    fn push_operation(&self, text: &mut String, op: &Op) {
        match *op {
            Op::Unary(operation, a) => {
                let behind = push_function(text, operation);
                self.push(text, a);
                text.push_str(behind);
            }
            Op::Binary(operation, a, b) => {
                let (before, between, behind) = match operation {
                    Binary::Add => ("", " + ", ""),
                    Binary::Sub => ("", " - ", ""),
                    Binary::Mul => ("", " * ", ""),
                    Binary::Div => ("", " / ", ""),
                    Binary::Atan2 => ("T::atan2(", ", ", ")"),
                    Binary::AngleOverSine => ("angle_over_sine(", ", ", ")"),
                };
                self.push_call(text, before, [a, b], (between, behind));
            }
            Op::SinCos(a) => {
                text.push_str("T::sin_cos(");
                self.push(text, a);
                text.push(')');
            }
            Op::Select(a, yes, no) => {
                text.push_str("T::select(");
                self.push(text, a);
                self.push_call(text, ".lt(T::constant(0.0)), ", [yes, no], (", ", ")"));
            }
        }
    }
}

fn push_digits(text: &mut String, number: u32) {
    let mut digits = [0_u8; 10];
    let (mut left, mut first) = (number, digits.len());
    while left > 0 || first == digits.len() {
        first -= 1;
        digits[first] = b'0' + (left % 10) as u8;
        left /= 10;
    }
    text.extend(digits[first..].iter().map(|digit| char::from(*digit)));
}

fn push_indexed(text: &mut String, list: &str, index: u32) {
    text.extend([list, "["]);
    push_digits(text, index);
    text.push(']');
}

fn push_store(text: &mut String, index: u32, value: &str) {
    push_indexed(text, "y", index);
    text.extend([" = ", value, ";"]);
}

/// A number as its shortest literal that reads back to the same bits.
fn push_number(text: &mut String, operand: Operand) {
    let _ = match operand {
        Operand::Constant(number) if number.is_nan() => write!(text, "T::constant(f64::NAN)"),
        Operand::Constant(f64::INFINITY) => write!(text, "T::constant(f64::INFINITY)"),
        Operand::Constant(f64::NEG_INFINITY) => write!(text, "T::constant(f64::NEG_INFINITY)"),
        Operand::Constant(number) => write!(text, "T::constant({number:?})"),
        Operand::Input(_) | Operand::Value(_) => Ok(()),
    };
}

/// What stands before an operand; gives back what stands behind it.
#[expect(clippy::unreachable, reason = "lowering turns sines and cosines into pairs")]
fn push_function(text: &mut String, operation: Unary) -> &'static str {
    let before = match operation {
        Unary::Neg => {
            text.push('-');
            return "";
        }
        Unary::LogCoefficient(rank) => {
            let _ = write!(text, "log_coefficient({rank}, ");
            return ")";
        }
        Unary::Sqrt => "T::sqrt(",
        Unary::Exp => "T::exp(",
        Unary::Ln => "T::ln(",
        Unary::Floor => "T::floor(",
        Unary::Sin | Unary::Cos => unreachable!("lowering turns sines and cosines into pairs"),
    };
    text.push_str(before);
    ")"
}
