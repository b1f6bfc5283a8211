//! Sums and products of a function as lists of terms: one that only another of its kind reads is part of that.

use std::ops::Range;

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
#[derive(Clone, Copy, Debug)]
pub struct Terms<'a> {
    /// The node with its value.
    pub root: ExprId,
    /// Terms in the order of the operations; `true` subtracts.
    pub terms: &'a [(bool, ExprId)],
    /// Sums or products inside that only this one reads.
    pub inner: &'a [ExprId],
}

/// All sums or products of a function: their terms one after the other, most have two.
#[derive(Clone, Debug, Default)]
pub struct List {
    sums: Vec<(ExprId, Range<usize>, Range<usize>)>,
    terms: Vec<(bool, ExprId)>,
    inner: Vec<ExprId>,
}

impl List {
    /// Operands before what reads them.
    pub fn iter(&self) -> impl Iterator<Item = Terms<'_>> {
        // They were met from the end.
        (0..self.sums.len()).rev().map(|at| self.at(at))
    }

    /// The terms of the sum or product with this value, if it is one by itself.
    pub fn of(&self, root: ExprId) -> Option<Terms<'_>> {
        self.sums.binary_search_by(|(other, ..)| root.cmp(other)).ok().map(|at| self.at(at))
    }

    fn at(&self, at: usize) -> Terms<'_> {
        let (root, terms, inner) = &self.sums[at];
        Terms { root: *root, terms: &self.terms[terms.clone()], inner: &self.inner[inner.clone()] }
    }
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

/// All sums or products.
pub fn terms(graph: &Graph, uses: &[u32], kind: Kind) -> List {
    let mut inside = vec![false; uses.len()];
    let mut list = List::default();
    let mut stack = Vec::new();
    // From the end: a sum is met before those that it takes in.
    for index in (0..uses.len()).rev() {
        let root = ExprId::new(index);
        if uses[index] == 0 || inside[index] || kind.operands(graph.node(root)).is_none() {
            continue;
        }
        let (first, first_inner) = (list.terms.len(), list.inner.len());
        stack.push((false, root));
        while let Some((negative, id)) = stack.pop() {
            let whole =
                id == root || (uses[id.index()] == 1 && list.terms.len() - first + stack.len() < MOST - 1);
            match kind.operands(graph.node(id)).filter(|_| whole) {
                Some((a, b, subtracted)) => {
                    stack.push((negative != subtracted, b));
                    stack.push((negative, a));
                    if id != root {
                        inside[id.index()] = true;
                        list.inner.push(id);
                    }
                }
                None => list.terms.push((negative, id)),
            }
        }
        list.sums.push((root, first..list.terms.len(), first_inner..list.inner.len()));
    }
    list
}
