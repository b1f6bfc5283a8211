//! The whole way of one function. In: its operations. Out: [`Written`], its machine code and what it wants beside it.

use linkwear_tape::Tape;

use crate::refusal::Refusal;

use super::allocate::{Processor, allocate};
use super::bounds::Lengths;
use super::extremes;
use super::graph::Function;
use super::lower::{Lowered, lower};
use super::order::order;
use super::sines::written_out;

/// A function, ready to be made executable. Lengths are in numbers, those of all lanes together.
#[derive(Clone, Debug)]
pub(crate) struct Written {
    pub(crate) code: Vec<u8>,
    /// Bits of the constants.
    pub(crate) pool: Vec<u64>,
    pub(crate) inputs: usize,
    pub(crate) outputs: usize,
    pub(crate) workspace: usize,
    /// How much of a longer workspace may be left out at its beginning, so that it begins where lines of the cache do.
    pub(crate) slack: usize,
    /// How many times the code is called for all lanes.
    pub(crate) passes: usize,
    /// How many numbers further inputs and outputs begin in the next pass.
    pub(crate) advance: usize,
    /// Whether inputs and outputs are columns behind tables of pointers.
    pub(crate) columns: bool,
}

/// A function to be written.
pub(crate) struct Named<'n> {
    pub(crate) name: &'n str,
    /// Its operations, or what is wrong with its tape.
    pub(crate) operations: Result<Lowered, String>,
}

impl<'n> From<&'n Tape> for Named<'n> {
    fn from(tape: &'n Tape) -> Self {
        Self { name: &tape.name, operations: lower(tape) }
    }
}

/// Writes the code of a function; `functions` tells where the functions lie that it calls.
///
/// # Errors
/// If its tape makes no sense, or is too long.
pub(crate) fn write<'n, P: Processor>(
    named: impl Into<Named<'n>>,
    processor: P,
    functions: &dyn Fn(Function) -> usize,
) -> Result<Written, Refusal> {
    let (instructions, written) = placed(named, processor)?;
    Ok(Written { code: processor.encode(&instructions, functions), ..written })
}

/// The instructions of a function, and all but their bytes.
///
/// # Errors
/// If its tape makes no sense, or is too long. The first instruction that would reach past its memory: a fault of this
/// crate.
pub(crate) fn placed<'n, P: Processor>(
    named: impl Into<Named<'n>>,
    processor: P,
) -> Result<(Vec<P::Instruction>, Written), Refusal> {
    let Named { name, operations } = named.into();
    let defective = |defect| Refusal::Tape { function: name.to_owned(), defect };
    let lowered = operations.map_err(defective)?;
    // Every address is below: a node is in the pool or the frame at most once, at most eight numbers long.
    let most = (lowered.graph.len() + lowered.inputs + lowered.outputs.len()) * 8 * size_of::<f64>();
    if i32::try_from(most).is_err() {
        return Err(Refusal::TooLong);
    }
    let mut lowered = written_out(lowered, processor.widest());
    if processor.has_extremes() {
        lowered = extremes::find(lowered);
    }
    let shape = processor.shape();
    let straight = allocate(&lowered, &order(&lowered, shape.registers), processor);
    let (inputs, outputs) = (lowered.inputs * shape.step, lowered.outputs.len() * shape.step);
    let frame = straight.frame * shape.value;
    let pool = size_of_val(straight.pool.as_slice());
    let lengths = Lengths { input: inputs, output: outputs, pool, frame }.of_last_pass(shape);
    let outside = |instruction: &&P::Instruction| !processor.is_within(**instruction, lengths);
    if let Some(instruction) = straight.instructions.iter().find(outside) {
        let defect = format!("its code would leave its memory by {instruction:?}, a fault of linkwear");
        return Err(defective(defect));
    }
    let numbers = |bytes: usize| bytes / size_of::<f64>();
    let written = Written {
        code: Vec::new(),
        pool: straight.pool,
        inputs: numbers(inputs),
        outputs: numbers(outputs),
        workspace: numbers(frame),
        // Values of several lanes that cross lines cost twice; single numbers never do.
        slack: if shape.value == size_of::<f64>() { 0 } else { 7 },
        passes: shape.step / shape.value,
        advance: numbers(shape.value),
        columns: shape.columns,
    };
    Ok((straight.instructions, written))
}
