//! Statements in one fixed order. Never knows mechanics; names travel as labels.

use std::ops::Range;

use crate::block::Block;
use crate::operation::{Op, Operand, Value};

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
///
/// ```
/// use linkwear_tape::{Binary, Block, Op, Operand, Statement, Tape};
///
/// // y = x^2
/// let square = Tape {
///     name: "square".to_owned(),
///     doc: "The square of a number.".to_owned(),
///     inputs: vec![Block::vector("x", 1)],
///     input_names: vec!["x".to_owned()],
///     outputs: vec![Block::vector("y", 1)],
///     direct: Vec::new(),
///     statements: vec![Statement {
///         op: Op::Binary(Binary::Mul, Operand::Input(0), Operand::Input(0)),
///         first: 0,
///         labels: [None, None],
///         section: 0,
///         stores: vec![(0, Operand::Value(0))],
///     }],
///     sections: vec!["everything".to_owned()],
///     values: 1,
/// };
/// assert_eq!((square.input_len(), square.output_len()), (1, 1));
/// assert_eq!(square.operations().total, 1);
/// ```
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
        self.outputs.iter().fold(0, |sum, block| sum.saturating_add(block.len()))
    }
}
