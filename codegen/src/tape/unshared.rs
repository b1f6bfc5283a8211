//! Operation counts of expressions before sharing. In: graph nodes. Out: [`Operations`].

use crate::expr::{ExprId, Graph, Node};

use super::{Op, Operand, Operations};

/// Operations of expressions written out in full, with nothing shared.
pub fn unshared_operations(graph: &Graph, roots: &[ExprId]) -> Operations {
    let uses = graph.uses(roots);
    let zero = Operand::Constant(0.0);
    let mut known: Vec<Operations> = Vec::with_capacity(uses.len());
    for (index, used) in uses.iter().enumerate() {
        let mut counts = Operations::default();
        if *used > 0 {
            let node = graph.node(ExprId::new(index));
            match node {
                Node::Unary(operation, _) => counts.count(&Op::Unary(operation, zero)),
                Node::Binary(operation, ..) => counts.count(&Op::Binary(operation, zero, zero)),
                Node::Select(..) => counts.count(&Op::Select(zero, zero, zero)),
                Node::Constant(_) | Node::Symbol(_) => {}
            }
            for child in node.children() {
                counts += known[child.index()];
            }
        }
        known.push(counts);
    }
    let mut sum = Operations::default();
    for root in roots {
        sum += known[root.index()];
    }
    sum
}
