//! A function to be shortened: its graph, inputs and outputs.

use crate::expr::{ExprId, Graph};

/// One function on a graph of its own: how often a node is read is a matter of the function.
#[derive(Clone, Debug)]
pub struct Program {
    /// What the function needs and perhaps dead nodes.
    pub graph: Graph,
    /// Its inputs, in order.
    pub inputs: Vec<ExprId>,
    /// Its outputs, in order.
    pub roots: Vec<ExprId>,
}

/// A function on a graph that others may share.
pub struct Whole<'a> {
    pub graph: &'a Graph,
    pub inputs: &'a [ExprId],
    pub roots: &'a [ExprId],
}

impl Program {
    /// What it costs.
    pub fn operations(&self) -> usize {
        self.graph.operations_of_most(&self.roots)
    }

    /// See [`Graph::uses`].
    pub fn uses(&self) -> Vec<u32> {
        self.graph.uses(&self.roots)
    }
}
