//! The symbolic graph: hash-consed nodes, so equal expressions are one node (common subexpressions by
//! construction). Out: [`Graph`], [`ExprId`]s. Never knows bodies, joints or TOML.
//!
//! Children are always created before their parents, so node order is a topological order.

mod affine;
mod count;
mod diff;
mod eval;
mod expression;
mod operators;
mod passes;
mod scope;
mod signs;
mod substitute;
mod turned_back;
mod vector;

use rustc_hash::{FxHashMap, FxHashSet};

use crate::limits::EXPRESSIONS;

pub use crate::id::{ExprId, SymbolId};
pub use affine::Affine;
pub use expression::Expr;
pub use linkwear_tape::{Binary, Unary};
pub use passes::{Program, shortened};
pub use scope::Scope;
pub use signs::Signs;
pub use vector::{Mat3, Vec3};

/// A node. Constants hold the bits of an f64, so that nodes can be hashed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Node {
    /// A number.
    Constant(u64),
    /// An input.
    Symbol(SymbolId),
    /// A function of one value.
    Unary(Unary, ExprId),
    /// A function of two values.
    Binary(Binary, ExprId, ExprId),
    /// The second where the first is below zero, else the third.
    Select(ExprId, ExprId, ExprId),
}

impl Node {
    /// The nodes that it is computed from.
    pub fn children(self) -> impl Iterator<Item = ExprId> {
        let (first, second, third) = match self {
            Self::Constant(_) | Self::Symbol(_) => (None, None, None),
            Self::Unary(_, a) => (Some(a), None, None),
            Self::Binary(_, a, b) => (Some(a), Some(b), None),
            Self::Select(a, yes, no) => (Some(a), Some(yes), Some(no)),
        };
        first.into_iter().chain(second).chain(third)
    }
}

/// The graph: nodes, names of inputs, readable labels and sections.
#[derive(Clone, Debug, Default)]
pub struct Graph {
    nodes: Vec<Node>,
    known: FxHashMap<Node, ExprId>,
    symbols: Vec<String>,
    labels: FxHashMap<ExprId, String>,
    /// Conditions whose sides meet so well that no step has to end there.
    quiet: FxHashSet<ExprId>,
    sections: Vec<String>,
    /// Index of the section of every node.
    section_of: Vec<usize>,
    current_section: usize,
    /// Nodes that came after the limit.
    left_out: usize,
}

impl Graph {
    /// The node behind an id.
    pub fn node(&self, id: ExprId) -> Node {
        self.nodes[id.index()]
    }

    /// How often each node is read: by nodes that `roots` need, and as one of them. 0: nothing needs it.
    pub fn uses(&self, roots: &[ExprId]) -> Vec<u32> {
        let mut uses = vec![0_u32; self.nodes.len()];
        for root in roots {
            uses[root.index()] += 1;
        }
        // Children come before parents, so one sweep from the end counts every use.
        for (index, node) in self.nodes.iter().enumerate().rev() {
            if uses[index] > 0 {
                for child in node.children() {
                    uses[child.index()] += 1;
                }
            }
        }
        uses
    }

    /// A new input; a valid Rust identifier is made of its name later.
    fn symbol(&mut self, name: impl Into<String>) -> ExprId {
        let id = SymbolId::new(self.symbols.len());
        self.symbols.push(name.into());
        self.intern(Node::Symbol(id))
    }

    /// Name of an input.
    pub fn symbol_name(&self, id: SymbolId) -> &str {
        &self.symbols[id.index()]
    }

    /// The symbol behind a node, if it is one.
    pub fn as_symbol(&self, id: ExprId) -> Option<SymbolId> {
        match self.node(id) {
            Node::Symbol(symbol) => Some(symbol),
            _ => None,
        }
    }

    /// The number behind a node, if it is one.
    pub fn as_constant(&self, id: ExprId) -> Option<f64> {
        match self.node(id) {
            Node::Constant(bits) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }

    /// Number of nodes asked for. Beyond [`EXPRESSIONS`] the graph is cut off and means nothing.
    pub fn wanted(&self) -> usize {
        self.nodes.len() + self.left_out
    }

    fn begin_section(&mut self, title: String) {
        self.current_section = self.sections.iter().position(|known| *known == title).unwrap_or_else(|| {
            self.sections.push(title);
            self.sections.len() - 1
        });
    }

    /// Title of the section in which a node was first made.
    pub fn section(&self, id: ExprId) -> &str {
        self.sections.get(self.section_index(id)).map_or("", String::as_str)
    }

    /// The same section as a number.
    pub fn section_index(&self, id: ExprId) -> usize {
        self.section_of[id.index()]
    }

    fn label(&mut self, id: ExprId, name: impl Into<String>) {
        if matches!(self.node(id), Node::Unary(..) | Node::Binary(..) | Node::Select(..)) {
            self.labels.entry(id).or_insert_with(|| name.into());
        }
    }

    /// The readable name of a node.
    pub fn label_of(&self, id: ExprId) -> Option<&str> {
        self.labels.get(&id).map(String::as_str)
    }

    fn intern(&mut self, node: Node) -> ExprId {
        if let Some(id) = self.known.get(&node) {
            return *id;
        }
        // What comes after the limit is thrown away: any node stands for it, so that the derivation ends soon.
        if self.nodes.len() >= EXPRESSIONS.most && !matches!(node, Node::Symbol(_)) {
            self.left_out += 1;
            return ExprId::new(0);
        }
        let id = ExprId::new(self.nodes.len());
        self.nodes.push(node);
        self.section_of.push(self.current_section);
        self.known.insert(node, id);
        id
    }
}
