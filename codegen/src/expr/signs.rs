//! Which nodes are best made with the other sign, because only their negative is wanted.
//! In: a graph and how often its nodes are read. Out: [`Signs`]. Serves lowering and [`super::count`], so that no
//! more is emitted than is counted; the tape may still do with fewer changes of sign.
//!
//! A difference changes its sign by its operands' order, a product by the sign of a number in it; a sum, product or
//! quotient also by an operand that nothing else reads and that can do so itself. None of it changes a value.

use super::{Binary, ExprId, Graph, Node, Unary};

/// What is made with the other sign.
#[derive(Clone, Debug)]
pub struct Signs {
    /// Of every node: whether it is made with the other sign.
    reversed: Vec<bool>,
}

impl Signs {
    /// For the nodes that are needed, see [`Graph::live`], which are read as often as `uses` says; see [`Graph::uses`].
    pub fn of(graph: &Graph, uses: &[u32], live: &[ExprId]) -> Self {
        let mut free = vec![false; uses.len()];
        for id in live {
            free[id.index()] = match graph.node(*id) {
                Node::Binary(Binary::Sub, ..) => true,
                Node::Binary(Binary::Add | Binary::Mul | Binary::Div, a, b) => {
                    turning(graph, uses, &free, a) || turning(graph, uses, &free, b)
                }
                _ => false,
            };
        }
        let mut reversed = vec![false; uses.len()];
        // Parents come after their children: one sweep from the end passes every sign down.
        for id in live.iter().rev() {
            match graph.node(*id) {
                Node::Unary(Unary::Neg, inner) => {
                    reversed[inner.index()] = uses[inner.index()] == 1 && free[inner.index()];
                }
                Node::Binary(Binary::Add | Binary::Mul | Binary::Div, a, b) if reversed[id.index()] => {
                    let by = if turning(graph, uses, &free, a) { a } else { b };
                    reversed[by.index()] = graph.as_constant(by).is_none();
                }
                _ => {}
            }
        }
        Self { reversed }
    }

    /// Whether a node is made with the other sign. Nothing but its negation, or a parent that is itself made with the
    /// other sign, reads it then.
    pub fn is_reversed(&self, id: ExprId) -> bool {
        self.reversed[id.index()]
    }
}

/// Whether an operand can change the sign of what is made of it.
fn turning(graph: &Graph, uses: &[u32], free: &[bool], id: ExprId) -> bool {
    graph.as_constant(id).is_some() || (uses[id.index()] == 1 && free[id.index()])
}
