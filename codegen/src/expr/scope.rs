//! Where expressions are made: a graph behind a shared reference. Out: the finished [`Graph`].
//! Never knows what is computed.

use std::cell::RefCell;

use super::Graph;

/// A graph under construction. Nodes are made in the order in which Rust evaluates the operands of a formula.
#[derive(Debug, Default)]
pub struct Scope(RefCell<Graph>);

impl Scope {
    /// An empty graph.
    pub fn new() -> Self {
        Self::default()
    }

    /// The finished graph.
    pub fn into_graph(self) -> Graph {
        self.0.into_inner()
    }

    /// What `build` makes of the graph.
    pub(super) fn make<R>(&self, build: impl FnOnce(&mut Graph) -> R) -> R {
        build(&mut self.0.borrow_mut())
    }

    /// Starts a section: nodes first made from here on belong to it.
    pub fn begin_section(&self, title: impl Into<String>) {
        self.make(|g| g.begin_section(title.into()));
    }
}
