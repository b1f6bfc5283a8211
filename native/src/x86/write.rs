//! The whole way of one function. In: a tape. Out: [`Written`], its machine code and what it wants beside it.

use linkwear_codegen::tape::Tape;

use crate::refusal::Refusal;

use super::allocate::allocate;
use super::bounds::{Lengths, first_out_of_bounds};
use super::encode::Encoder;
use super::graph::Function;
use super::instruction::{Lanes, Target};
use super::lower::{Lowered, lower};
use super::order::order;

/// A function, ready to be made executable. Lengths are in numbers, those of all lanes together.
#[derive(Clone, Debug)]
pub(super) struct Written {
    pub(super) code: Vec<u8>,
    /// Bits of the constants.
    pub(super) pool: Vec<u64>,
    pub(super) inputs: usize,
    pub(super) outputs: usize,
    pub(super) workspace: usize,
    /// How much of a longer workspace may be left out at its beginning, so that it begins where lines of the cache do.
    pub(super) slack: usize,
}

/// Writes the code of a tape; `functions` tells where the functions lie that it calls.
///
/// # Errors
/// If the tape makes no sense, or is too long.
pub(super) fn write(
    tape: &Tape,
    target: Target,
    functions: &dyn Fn(Function) -> usize,
) -> Result<Written, Refusal> {
    let defective = |defect| Refusal::Tape { function: tape.name.clone(), defect };
    let lowered = lower(tape).map_err(defective)?;
    // Every address is below: a node is in the pool or the frame at most once, at most eight numbers long.
    let most = (lowered.graph.len() + lowered.inputs + lowered.outputs.len()) * 8 * size_of::<f64>();
    if i32::try_from(most).is_err() {
        return Err(Refusal::TooLong);
    }
    write_in_order(&lowered, &order(&lowered, target), target, functions).map_err(defective)
}

/// Writes the operations in a given order.
///
/// # Errors
/// The first instruction that would reach past its memory: a fault of this crate.
pub(super) fn write_in_order(
    lowered: &Lowered,
    order: &[u32],
    target: Target,
    functions: &dyn Fn(Function) -> usize,
) -> Result<Written, String> {
    let straight = allocate(lowered, order, target);
    let lanes = target.lanes.count();
    let written = Written {
        code: Vec::new(),
        inputs: lowered.inputs * lanes,
        outputs: lowered.outputs.len() * lanes,
        workspace: straight.frame * lanes,
        // Values of several lanes that cross lines cost twice; single numbers never do.
        slack: if target.lanes == Lanes::One { 0 } else { 7 },
        pool: straight.pool,
    };
    let bytes = |numbers: usize| numbers * size_of::<f64>();
    let lengths = Lengths {
        input: bytes(written.inputs),
        output: bytes(written.outputs),
        pool: bytes(written.pool.len()),
        frame: bytes(written.workspace),
    };
    if let Some(instruction) = first_out_of_bounds(&straight.instructions, target, lengths) {
        return Err(format!("its code would leave its memory by {instruction:?}, a fault of linkwear"));
    }
    let mut encoder = Encoder::new(target.lanes, functions);
    for instruction in &straight.instructions {
        encoder.instruction(*instruction);
    }
    Ok(Written { code: encoder.finish(), ..written })
}
