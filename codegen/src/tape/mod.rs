//! One function as a straight line of statements: what every back end runs, operation by operation.
//! In: [`crate::derive::Equations`]. Out: [`Tape`]s. Never knows mechanics; names travel as labels.
//!
//! All rewriting ends here. Back ends must not reorder, fuse or fold, so that they agree in every bit.

mod cut;
mod lower;
mod registers;
mod split;
mod stats;
mod verify;

pub use lower::{lower, lower_short};
pub use registers::Registers;
pub use split::{PART_LIMIT, Part, Split, split};
pub use stats::{Operations, unshared_operations};
pub use verify::verify;

use std::ops::Range;

use crate::derive::Block;
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

impl Statement {
    /// The values defined.
    pub const fn results(&self) -> Range<Value> {
        self.first..self.first + if matches!(self.op, Op::SinCos(_)) { 2 } else { 1 }
    }

    /// Operands of the operation, then of the stores.
    pub fn reads(&self) -> impl Iterator<Item = Operand> {
        self.op.operands().chain(self.stores.iter().map(|(_, operand)| *operand))
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
    pub inputs: Vec<Block>,
    /// Name of every entry of the flat input.
    pub input_names: Vec<String>,
    /// Parts of the flat output.
    pub outputs: Vec<Block>,
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

    /// Whether every constant is a finite number.
    pub fn is_finite(&self) -> bool {
        let direct = self.direct.iter().map(|(_, operand)| *operand);
        let mut all = direct.chain(self.statements.iter().flat_map(Statement::reads));
        all.all(|operand| !matches!(operand, Operand::Constant(number) if !number.is_finite()))
    }

    /// Length of the flat output.
    pub fn output_len(&self) -> usize {
        self.outputs.iter().map(|block| block.entries.len()).sum()
    }
}
