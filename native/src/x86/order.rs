//! Orders of evaluation: all give the same bits. In: a graph. Out: the operations that its outputs need, each after
//! its arguments.

use super::graph::Id;
use super::instruction::Target;
use super::lower::Lowered;

pub(super) fn order(lowered: &Lowered, _: Target) -> Vec<Id> {
    let live = lowered.graph.live(&lowered.outputs);
    let is_computed = |id: &Id| live[*id as usize] && !lowered.graph.node(*id).operation.is_leaf();
    (0..lowered.graph.len() as Id).filter(is_computed).collect()
}
