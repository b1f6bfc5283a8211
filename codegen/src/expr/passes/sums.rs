//! Sums of a function as lists of signed terms: a sum that only another sum reads is part of that.

use crate::expr::{Binary, ExprId, Graph, Node};

/// Terms of one sum at most; longer ones are taken piece by piece, so that passes cost at most the square of this.
const MOST: usize = 64;

/// A sum.
#[derive(Clone, Debug)]
pub struct Sum {
    /// The node with its value.
    pub root: ExprId,
    /// Terms in the order of addition; `true` subtracts.
    pub terms: Vec<(bool, ExprId)>,
    /// Sums inside that only this one reads.
    pub inner: Vec<ExprId>,
}

fn is_sum(node: Node) -> bool {
    matches!(node, Node::Binary(Binary::Add | Binary::Sub, ..))
}

/// All sums, operands before what reads them.
pub fn sums(graph: &Graph, uses: &[u32]) -> Vec<Sum> {
    let mut inside = vec![false; uses.len()];
    let mut list = Vec::new();
    // From the end: a sum is met before those that it takes in.
    for index in (0..uses.len()).rev() {
        let root = ExprId::new(index);
        if uses[index] == 0 || inside[index] || !is_sum(graph.node(root)) {
            continue;
        }
        let mut sum = Sum { root, terms: Vec::new(), inner: Vec::new() };
        let mut stack = vec![(false, root)];
        while let Some((negative, id)) = stack.pop() {
            let whole = id == root || (uses[id.index()] == 1 && sum.terms.len() + stack.len() < MOST - 1);
            match graph.node(id) {
                Node::Binary(operation @ (Binary::Add | Binary::Sub), a, b) if whole => {
                    stack.push((negative != (operation == Binary::Sub), b));
                    stack.push((negative, a));
                    if id != root {
                        inside[id.index()] = true;
                        sum.inner.push(id);
                    }
                }
                _ => sum.terms.push((negative, id)),
            }
        }
        list.push(sum);
    }
    list.reverse();
    list
}
