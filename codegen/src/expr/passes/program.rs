//! A function to be shortened: its graph, inputs and outputs.

use std::cell::OnceCell;

use super::terms::{Kind, List, terms};
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
    /// What several passes ask for.
    uses: OnceCell<Vec<u32>>,
    sums: OnceCell<List>,
    products: OnceCell<List>,
}

/// A function on a graph that others may share.
pub struct Whole<'a> {
    pub graph: &'a Graph,
    pub inputs: &'a [ExprId],
    pub roots: &'a [ExprId],
}

impl Program {
    pub(super) fn new(graph: Graph, inputs: Vec<ExprId>, roots: Vec<ExprId>) -> Self {
        let (uses, sums, products) = Default::default();
        Self { graph, inputs, roots, uses, sums, products }
    }

    /// What it costs.
    pub fn operations(&self) -> usize {
        self.graph.operations_of_most(self.uses())
    }

    /// See [`Graph::uses`].
    pub(super) fn uses(&self) -> &[u32] {
        self.uses.get_or_init(|| self.graph.uses(&self.roots))
    }

    /// All its sums or products.
    pub(super) fn terms(&self, kind: Kind) -> &List {
        let list = if kind == Kind::Sum { &self.sums } else { &self.products };
        list.get_or_init(|| terms(&self.graph, self.uses(), kind))
    }
}
