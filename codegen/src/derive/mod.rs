//! Symbolic derivation: from a mechanism to named outputs over one expression graph.
//! In: [`crate::model`]. Out: [`Equations`]. Never knows text formats or Rust syntax.

use crate::expr::{ExprId, Graph};

/// Everything derived for one mechanism: one graph, several functions over it.
#[derive(Clone, Debug)]
pub struct Equations {
    /// The shared graph.
    pub graph: Graph,
    /// One function per [`linkwear_runtime::Entry`], in the order of `Entry::ALL`.
    pub functions: Vec<Function>,
}

/// A function over the graph: what one entry point computes.
#[derive(Clone, Debug)]
pub struct Function {
    /// Snake-case name, e.g. `forward_dynamics`.
    pub name: String,
    /// What it answers, one or two sentences.
    pub doc: String,
    /// Input blocks; their concatenation is the flat input slice.
    pub inputs: Vec<Block>,
    /// Output blocks; their concatenation (row major) is the flat output slice.
    pub outputs: Vec<Block>,
}

/// A named vector or matrix of expressions (of symbols, for inputs).
#[derive(Clone, Debug)]
pub struct Block {
    /// Name, e.g. `phi_q`.
    pub name: String,
    /// What it is: shape, unit, frame.
    pub doc: String,
    /// Equation of the paper, e.g. "[CS (3)]", or empty.
    pub citation: String,
    /// Rows.
    pub rows: usize,
    /// Columns.
    pub columns: usize,
    /// Entries, row major.
    pub entries: Vec<ExprId>,
}
