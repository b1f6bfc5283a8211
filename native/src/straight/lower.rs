//! From a tape to machine operations. In: a tape that [`verify`] passes. Out: [`Lowered`].
//! Never knows in which order they will run.

use linkwear_tape::{Tape, verify};

use super::graph::{Graph, Id};
use super::number::Recorder;

/// One function as machine operations.
#[derive(Clone, Debug)]
pub(crate) struct Lowered {
    pub(super) graph: Graph,
    /// Length of the flat input.
    pub(super) inputs: usize,
    /// Nodes that are computed before others, in this order, as far as outputs need them.
    pub(super) first: Vec<Id>,
    /// The node of every entry of the flat output.
    pub(super) outputs: Vec<Id>,
}

/// Writes a tape's operations down, one by one.
///
/// # Errors
/// The tape's first defect.
pub(crate) fn lower(tape: &Tape) -> Result<Lowered, String> {
    verify(tape)?;
    let recorder = Recorder::default();
    let outputs = tape.evaluate(&|index| recorder.input(index));
    let outputs = outputs.into_iter().map(|output| recorder.id(output)).collect();
    Ok(Lowered { graph: recorder.into_graph(), inputs: tape.input_len(), first: Vec::new(), outputs })
}
