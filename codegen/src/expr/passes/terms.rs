//! Sums and products of a function as lists of terms: one that only another of its kind reads is part of that.

use crate::expr::{Binary, ExprId, Graph, Node};

/// Terms of one sum at most; longer ones are taken piece by piece, so that passes cost at most the square of this.
const MOST: usize = 64;

/// Which operation joins terms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Sum,
    Product,
}

/// A sum or a product.
#[derive(Clone, Debug)]
pub struct Terms {
    /// The node with its value.
    pub root: ExprId,
    /// Terms in the order of the operations; `true` subtracts.
    pub terms: Vec<(bool, ExprId)>,
    /// Sums or products inside that only this one reads.
    pub inner: Vec<ExprId>,
}

impl Kind {
    /// Operands of a node of this kind; whether the second is subtracted.
    fn operands(self, node: Node) -> Option<(ExprId, ExprId, bool)> {
        match (self, node) {
            (Self::Sum, Node::Binary(Binary::Add, a, b))
            | (Self::Product, Node::Binary(Binary::Mul, a, b)) => Some((a, b, false)),
            (Self::Sum, Node::Binary(Binary::Sub, a, b)) => Some((a, b, true)),
            _ => None,
        }
    }
}

/// All sums or products, operands before what reads them.
pub fn terms(graph: &Graph, uses: &[u32], kind: Kind) -> Vec<Terms> {
    let mut inside = vec![false; uses.len()];
    let mut list = Vec::new();
    let (mut stack, mut terms, mut inner) = (Vec::new(), Vec::new(), Vec::new());
    // From the end: a sum is met before those that it takes in.
    for index in (0..uses.len()).rev() {
        let root = ExprId::new(index);
        if uses[index] == 0 || inside[index] || kind.operands(graph.node(root)).is_none() {
            continue;
        }
        stack.push((false, root));
        while let Some((negative, id)) = stack.pop() {
            let whole = id == root || (uses[id.index()] == 1 && terms.len() + stack.len() < MOST - 1);
            match kind.operands(graph.node(id)).filter(|_| whole) {
                Some((a, b, subtracted)) => {
                    stack.push((negative != subtracted, b));
                    stack.push((negative, a));
                    if id != root {
                        inside[id.index()] = true;
                        inner.push(id);
                    }
                }
                None => terms.push((negative, id)),
            }
        }
        list.push(Terms { root, terms: terms.clone(), inner: inner.clone() });
        terms.clear();
        inner.clear();
    }
    list.reverse();
    list
}
