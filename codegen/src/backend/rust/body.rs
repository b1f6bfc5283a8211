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
            let value = match operand {
                Operand::Input(input) => format!("x[{input}]"),
                other => number(*other),
            };
            last = (bits, value);
        }
        lines.push(&format!("y[{index}] = {};", last.1));
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
        writer.lines.push(&format!("w[{slot}] = {};", writer.values[value]));
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

    fn push(&mut self, statement: &str) {
        if statement.len() <= SURELY_ONE_LINE {
            self.text.extend(["    ", statement, "\n"]);
        } else {
            self.text.push_str(&formatted(statement));
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
            self.lines.push(&format!("let {name} = x[{index}];"));
        }
        self.inputs.extend(read);
    }

    fn statement(&mut self, statement: &Statement) {
        let right = match statement.op {
            Op::Unary(operation, a) => unary(operation, &self.operand(a)),
            Op::Binary(operation, a, b) => binary(operation, &self.operand(a), &self.operand(b)),
            Op::SinCos(a) => format!("T::sin_cos({})", self.operand(a)),
            Op::Select(a, yes, no) => {
                let [a, yes, no] = [a, yes, no].map(|operand| self.operand(operand));
                format!("T::select({a}.lt(T::constant(0.0)), {yes}, {no})")
            }
        };
        let left = match statement.op {
            Op::SinCos(_) => format!("({}, {})", self.named(statement, 0), self.named(statement, 1)),
            _ => self.named(statement, 0),
        };
        self.lines.push(&format!("let {left} = {right};"));
        for (index, operand) in &statement.stores {
            self.lines.push(&format!("y[{index}] = {};", self.operand(*operand)));
        }
    }

    fn named(&mut self, statement: &Statement, which: u32) -> String {
        let value = statement.first + which;
        let name = match &statement.labels[which as usize] {
            Some(label) => self.names.unique(label),
            None => self.names.unique(&format!("t{value}")),
        };
        self.values.insert(value, name.clone());
        name
    }

    fn operand(&self, operand: Operand) -> String {
        match operand {
            Operand::Constant(_) => number(operand),
            Operand::Input(index) => self.inputs[&index].clone(),
            Operand::Value(value) => self.values[&value].clone(),
        }
    }
}

/// A number as its shortest literal that reads back to the same bits.
fn number(operand: Operand) -> String {
    match operand {
        Operand::Constant(number) if number.is_nan() => "T::constant(f64::NAN)".to_owned(),
        Operand::Constant(f64::INFINITY) => "T::constant(f64::INFINITY)".to_owned(),
        Operand::Constant(f64::NEG_INFINITY) => "T::constant(f64::NEG_INFINITY)".to_owned(),
        Operand::Constant(number) => format!("T::constant({number:?})"),
        Operand::Input(_) | Operand::Value(_) => String::new(),
    }
}

#[expect(clippy::unreachable, reason = "lowering turns sines and cosines into pairs")]
fn unary(operation: Unary, a: &str) -> String {
    match operation {
        Unary::Neg => format!("-{a}"),
        Unary::Sqrt => format!("T::sqrt({a})"),
        Unary::Exp => format!("T::exp({a})"),
        Unary::Ln => format!("T::ln({a})"),
        Unary::Floor => format!("T::floor({a})"),
        Unary::LogCoefficient(rank) => format!("log_coefficient({rank}, {a})"),
        Unary::Sin | Unary::Cos => unreachable!("lowering turns sines and cosines into pairs"),
    }
}

fn binary(operation: Binary, a: &str, b: &str) -> String {
    match operation {
        Binary::Add => format!("{a} + {b}"),
        Binary::Sub => format!("{a} - {b}"),
        Binary::Mul => format!("{a} * {b}"),
        Binary::Div => format!("{a} / {b}"),
        Binary::Atan2 => format!("T::atan2({a}, {b})"),
        Binary::AngleOverSine => format!("angle_over_sine({a}, {b})"),
    }
}
