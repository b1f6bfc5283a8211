//! From a tape to machine operations, sines and cosines as one each. In: a tape that [`verify`] passes. Out: [`Lowered`].
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

impl Lowered {
    /// Nodes that outputs are computed from.
    pub(super) fn needed(&self) -> Vec<bool> {
        let mut needed = vec![false; self.graph.len()];
        self.outputs.iter().for_each(|output| needed[*output as usize] = true);
        // Arguments have smaller places than what is computed from them.
        for id in (0..self.graph.len() as Id).rev() {
            if !needed[id as usize] {
                continue;
            }
            for argument in self.graph.node(id).arguments() {
                needed[*argument as usize] = true;
            }
        }
        needed
    }
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
