//! Where expressions are made: a graph behind a shared reference. Out: the finished [`Graph`].
//! Never knows what is computed.

use std::cell::RefCell;

use super::{ExprId, Graph, Node};

/// A graph under construction. Nodes are made in the order in which Rust evaluates the operands of a formula.
#[derive(Debug, Default)]
pub struct Scope(RefCell<Graph>);

/// A section of a graph under construction.
#[derive(Clone, Copy, Debug)]
pub struct Section(u32);

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
    #[inline]
    pub(super) fn make<R>(&self, build: impl FnOnce(&mut Graph) -> R) -> R {
        build(&mut self.0.borrow_mut())
    }

    /// Nodes first made from here on belong to the section of this one.
    pub(super) fn enter_section_of(&self, id: ExprId) {
        self.make(|g| g.current_section = g.section_index(id));
    }

    /// Number of nodes so far.
    pub fn size(&self) -> usize {
        self.make(|g| g.nodes.len())
    }

    /// Conditions first made since there were `size` nodes are none of [`Scope::switches`].
    pub fn keep_quiet_since(&self, size: usize) {
        self.make(|g| {
            let new = g.nodes[size..].iter().filter_map(|node| match node {
                Node::Select(by, ..) if by.index() >= size => Some(*by),
                _ => None,
            });
            let new: Vec<ExprId> = new.collect();
            g.quiet.extend(new);
        });
    }

    /// The section that nodes first made now belong to.
    pub fn section(&self) -> Section {
        self.make(|g| Section(g.current_section))
    }

    /// Goes on with a section.
    pub fn enter(&self, section: Section) {
        self.make(|g| g.current_section = section.0);
    }

    /// Starts a section: nodes first made from here on belong to it.
    pub fn begin_section(&self, title: impl Into<String>) {
        self.make(|g| g.begin_section(title.into()));
    }
}
