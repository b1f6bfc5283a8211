//! One function as a straight line of statements: what every back end runs, operation by operation.
//! In: [`crate::derive::Equations`]. Out: [`Tape`]s. Never knows mechanics; names travel as labels.
//!
//! All rewriting ends here. Back ends must not reorder, fuse or fold, so that they agree in every bit.

mod lower;
mod registers;
mod split;
mod stats;
mod verify;

pub use lower::lower;
pub use registers::Registers;
pub use split::{PART_LIMIT, Part, Split, split};
pub use stats::{Operations, unshared_operations};
pub use verify::{Defect, verify};

use crate::expr::{Binary, Unary};

/// A value computed by a statement.
pub type Value = u32;

/// Where an operation reads from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Operand {
    /// Result of an earlier statement.
    Value(Value),
    /// Entry of the flat input.
    Input(u32),
    /// A number.
    Constant(f64),
}

/// An operation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Op {
    /// One operand, one result.
    Unary(Unary, Operand),
    /// Two operands, one result.
    Binary(Binary, Operand, Operand),
    /// Sine (this value) and cosine (the next value) of an angle.
    SinCos(Operand),
}

impl Op {
    /// The operands, in order.
    pub fn operands(&self) -> impl Iterator<Item = Operand> {
        let (first, second) = match self {
            Self::Unary(_, a) | Self::SinCos(a) => (*a, None),
            Self::Binary(_, a, b) => (*a, Some(*b)),
        };
        std::iter::once(first).chain(second)
    }

    /// Number of values that the operation defines.
    pub const fn results(&self) -> u32 {
        if matches!(self, Self::SinCos(_)) { 2 } else { 1 }
    }
}

/// A statement: an operation, its first result, and what a reader should know.
#[derive(Clone, Debug, PartialEq)]
pub struct Statement {
    /// What is computed.
    pub op: Op,
    /// First value defined.
    pub first: Value,
    /// Readable names of the results, where the derivation gave one.
    pub labels: [Option<String>; 2],
    /// Index into [`Tape::sections`].
    pub section: usize,
    /// Outputs that are known once this statement has run: (index in the flat output, operand).
    pub stores: Vec<(u32, Operand)>,
}

/// A named part of the flat input or output.
#[derive(Clone, Debug, PartialEq)]
pub struct Slot {
    /// Name.
    pub name: String,
    /// What it is: unit, frame.
    pub doc: String,
    /// Equation of the paper, or empty.
    pub citation: String,
    /// First index in the flat slice.
    pub first: usize,
    /// Rows.
    pub rows: usize,
    /// Columns.
    pub columns: usize,
}

impl Slot {
    /// Number of entries.
    pub const fn len(&self) -> usize {
        self.rows * self.columns
    }

    /// Whether there are no entries.
    pub const fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// A function, ready to be run or written.
#[derive(Clone, Debug, PartialEq)]
pub struct Tape {
    /// Snake-case name.
    pub name: String,
    /// What it answers.
    pub doc: String,
    /// Parts of the flat input.
    pub inputs: Vec<Slot>,
    /// Name of every entry of the flat input.
    pub input_names: Vec<String>,
    /// Parts of the flat output.
    pub outputs: Vec<Slot>,
    /// Outputs that need no statement: numbers and inputs.
    pub direct: Vec<(u32, Operand)>,
    /// The statements.
    pub statements: Vec<Statement>,
    /// Section titles.
    pub sections: Vec<String>,
    /// Number of values defined.
    pub values: u32,
}

impl Tape {
    /// Length of the flat input.
    pub fn input_len(&self) -> usize {
        self.input_names.len()
    }

    /// Length of the flat output.
    pub fn output_len(&self) -> usize {
        self.outputs.iter().map(Slot::len).sum()
    }

    /// The tape as text, one statement a line, for dumps and comparisons.
    pub fn text(&self) -> String {
        let mut lines = vec![format!("tape {} ({} -> {})", self.name, self.input_len(), self.output_len())];
        let stores = |list: &[(u32, Operand)]| -> String {
            list.iter().map(|(index, operand)| format!("  y{index} = {}", show(*operand))).collect()
        };
        lines.push(format!("direct{}", stores(&self.direct)));
        for statement in &self.statements {
            let operands: Vec<String> = statement.op.operands().map(show).collect();
            let name = match statement.op {
                Op::Unary(op, _) => format!("{op:?}"),
                Op::Binary(op, ..) => format!("{op:?}"),
                Op::SinCos(_) => "SinCos".to_owned(),
            };
            lines.push(format!(
                "v{} = {name} {}{}",
                statement.first,
                operands.join(" "),
                stores(&statement.stores)
            ));
        }
        lines.join("\n") + "\n"
    }
}

fn show(operand: Operand) -> String {
    match operand {
        Operand::Value(value) => format!("v{value}"),
        Operand::Input(index) => format!("x{index}"),
        Operand::Constant(number) => format!("{number:?}"),
    }
}
