//! One instruction of an operation, on as many values side by side as that has. Never knows which instructions do it.

use crate::straight::allocate::Allocation;
use crate::straight::graph::Id;

use super::instruction::{Instruction, Target};

/// Appends an instruction of the operation of a node.
pub(super) fn push(allocation: &mut Allocation<'_, Target>, of: Id, instruction: Instruction) {
    let wide = allocation.processor.wide(allocation.node(of).width(), instruction);
    allocation.push(wide);
}
