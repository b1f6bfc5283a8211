//! The symbolic graph: hash-consed nodes, so equal expressions are one node (common subexpressions by
//! construction). Out: [`Graph`], [`ExprId`]s. Never knows bodies, joints or TOML.
//!
//! Children are always created before their parents, so node order is a topological order.

mod affine;
mod count;
mod diff;
mod eval;
mod expression;
mod interned;
mod node;
mod operators;
mod passes;
mod rows;
mod scope;
mod signs;
mod substitute;
mod turned_back;
mod vector;

use std::sync::Arc;

use rustc_hash::{FxHashMap, FxHashSet};

use crate::limits::EXPRESSIONS;

use interned::Interned;

pub use crate::id::{ExprId, SymbolId};
pub use affine::Affine;
pub use expression::Expr;
pub use linkwear_tape::{Binary, Unary};
pub use node::Node;
pub use passes::{Program, shortened};
pub use scope::{Scope, Section};
pub use signs::Signs;
pub use vector::{Mat3, Vec3};

/// The graph: nodes, names of inputs, readable labels and sections.
#[derive(Clone, Debug, Default)]
pub struct Graph {
    nodes: Vec<Node>,
    known: Interned,
    symbols: Vec<String>,
    labels: FxHashMap<ExprId, Arc<str>>,
    /// Conditions whose sides meet so well that no step has to end there.
    quiet: FxHashSet<ExprId>,
    /// How many rows of tables their arguments have passed.
    rows: Vec<ExprId>,
    /// Shared with copies, which add none.
    sections: Arc<Vec<String>>,
    /// Index of every section by its title.
    section_by_title: Arc<FxHashMap<String, u32>>,
    /// Index of the section of every node.
    section_of: Vec<u32>,
    current_section: u32,
    /// Zero, once there is one: it is asked for more often than all else.
    zero: Option<ExprId>,
    /// Nodes that came after the limit.
    left_out: usize,
}

impl Graph {
    /// The node behind an id.
    #[inline]
    pub fn node(&self, id: ExprId) -> Node {
        self.nodes[id.index()]
    }

    /// How often each node is read: by nodes that `roots` need, and as one of them. 0: nothing needs it.
    pub fn uses(&self, roots: &[ExprId]) -> Vec<u32> {
        let mut uses = vec![0_u32; self.nodes.len()];
        let mut end = 0;
        for root in roots {
            uses[root.index()] += 1;
            end = end.max(root.index() + 1);
        }
        // Children come before parents, so one sweep from the end counts every use.
        for (index, node) in self.nodes[..end].iter().enumerate().rev() {
            if uses[index] > 0 {
                node.each_child(|child| uses[child.index()] += 1);
            }
        }
        uses
    }

    /// The nodes that are read at all, each after those that it reads.
    pub fn live(&self, uses: &[u32]) -> Vec<ExprId> {
        let mut live = Vec::new();
        for (index, used) in uses.iter().enumerate() {
            if *used > 0 {
                live.push(ExprId::new(index));
            }
        }
        live
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
    #[inline]
    pub fn as_symbol(&self, id: ExprId) -> Option<SymbolId> {
        match self.node(id) {
            Node::Symbol(symbol) => Some(symbol),
            _ => None,
        }
    }

    /// The number behind a node, if it is one.
    #[inline]
    pub fn as_constant(&self, id: ExprId) -> Option<f64> {
        match self.node(id) {
            Node::Constant(bits) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }

    /// The product of a positive number and a node, if it was made.
    fn scaled(&self, number: f64, of: ExprId) -> Option<ExprId> {
        let number = self.known.get(&self.nodes, Node::Constant(number.to_bits()))?;
        let (first, second) = (number.min(of), number.max(of));
        self.known.get(&self.nodes, Node::Binary(Binary::Mul, first, second))
    }

    /// Number of nodes asked for. Beyond [`EXPRESSIONS`] the graph is cut off and means nothing.
    pub fn wanted(&self) -> usize {
        self.nodes.len() + self.left_out
    }

    fn begin_section(&mut self, title: String) {
        if let Some(known) = self.section_by_title.get(&title) {
            self.current_section = *known;
            return;
        }
        self.current_section = u32::try_from(self.sections.len()).unwrap_or(u32::MAX);
        Arc::make_mut(&mut self.section_by_title).insert(title.clone(), self.current_section);
        Arc::make_mut(&mut self.sections).push(title);
    }

    /// Title of the section in which a node was first made.
    pub fn section(&self, id: ExprId) -> &str {
        self.sections.get(self.section_index(id) as usize).map_or("", String::as_str)
    }

    /// The same section as a number.
    #[inline]
    pub fn section_index(&self, id: ExprId) -> u32 {
        self.section_of[id.index()]
    }

    fn label(&mut self, id: ExprId, name: impl Into<Arc<str>>) {
        if matches!(self.node(id), Node::Unary(..) | Node::Binary(..) | Node::Select(..)) {
            self.labels.entry(id).or_insert_with(|| name.into());
        }
    }

    /// The readable name of a node.
    #[inline]
    pub fn label_of(&self, id: ExprId) -> Option<&str> {
        self.labels.get(&id).map(|name| &**name)
    }

    fn intern(&mut self, node: Node) -> ExprId {
        let free = match self.known.find(&self.nodes, node) {
            Ok(id) => return id,
            Err(free) => free,
        };
        // What comes after the limit is thrown away: any node stands for it, so that the derivation ends soon.
        if self.nodes.len() >= EXPRESSIONS.most && !matches!(node, Node::Symbol(_)) {
            self.left_out += 1;
            return ExprId::new(0);
        }
        let id = ExprId::new(self.nodes.len());
        self.nodes.push(node);
        self.section_of.push(self.current_section);
        self.known.put(free, id);
        id
    }
}
