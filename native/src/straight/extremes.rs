//! Selections that are the larger or the smaller of two numbers as one operation, which some processors have in the very bits: of numbers
//! that are equal or of which one is none they give the second. In: operations. Out: the same, or fewer.

use super::graph::{Graph, Id, Operation};
use super::lower::Lowered;

/// Finds them all.
pub(super) fn find(mut lowered: Lowered) -> Lowered {
    for id in 0..lowered.graph.len() as Id {
        if let Some((operation, arguments)) = extreme(&lowered.graph, id) {
            lowered.graph.replace(id, operation, arguments);
        }
    }
    lowered
}

/// What a selection is instead, and of what.
fn extreme(graph: &Graph, id: Id) -> Option<(Operation, [Id; 2])> {
    let (Operation::Select, &[by, yes, no]) = (graph.node(id).operation, graph.node(id).arguments()) else {
        return None;
    };
    match (graph.node(by).operation, graph.node(by).arguments()) {
        (Operation::Less, &[first, second]) if [first, second] == [no, yes] => {
            Some((Operation::Larger, [yes, no]))
        }
        (Operation::Less, &[first, second]) if [first, second] == [yes, no] => {
            Some((Operation::Smaller, [yes, no]))
        }
        _ => None,
    }
}
