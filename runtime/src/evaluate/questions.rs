//! One question at a time: a flat input put together from blocks, an output for every entry. In: a [`System`], values of its
//! parameters. Out: slices. Allocates only when made.

use std::ops::Range;

use crate::guide::Guide;
use crate::signals::Signals;
use crate::system::{Entry, Sizes, System};
use crate::tables::InputRole;

/// A system with the storage to ask it.
pub(super) struct Questions<'a> {
    pub(super) system: &'a dyn System<f64>,
    pub(super) sizes: Sizes,
    /// Inputs over time, and where they stand: behind the tunable parameters.
    signals: Option<&'a dyn Signals>,
    /// Those that drives follow, where they are led instead.
    pub(super) guide: Guide,
    pub(super) inputs: Range<usize>,
    /// Parameters, then what is asked with them.
    input: Vec<f64>,
    pub(super) workspace: Vec<f64>,
    outputs: [Vec<f64>; Entry::ALL.len()],
}

impl<'a> Questions<'a> {
    pub(super) fn new(system: &'a dyn System<f64>, parameters: &[f64], roles: &[InputRole]) -> Self {
        let sizes = system.sizes();
        let longest = Entry::ALL.iter().map(|entry| sizes.input(*entry)).max().unwrap_or(0);
        let mut input = vec![0.0; longest];
        input[..parameters.len()].copy_from_slice(parameters);
        let outputs = Entry::ALL.map(|entry| vec![0.0; sizes.output(entry)]);
        Self {
            system,
            sizes,
            signals: None,
            guide: Guide::new(roles),
            inputs: parameters.len() - roles.len()..parameters.len(),
            input,
            workspace: vec![0.0; sizes.workspace],
            outputs,
        }
    }

    /// Connects the inputs.
    pub(super) fn connect(&mut self, signals: &'a dyn Signals) {
        self.signals = Some(signals);
    }

    /// The signals, if inputs are connected.
    pub(super) fn signals(&self) -> Option<&'a dyn Signals> {
        self.signals
    }

    /// Values of the inputs at a time.
    #[inline]
    pub(super) fn inputs_at(&mut self, t: f64) -> &[f64] {
        let values = &mut self.input[self.inputs.clone()];
        if let Some(signals) = self.signals {
            signals.write(t, values);
        }
        self.guide.write(t, values);
        values
    }

    /// Values of the parameters.
    pub(super) fn parameters(&self) -> &[f64] {
        &self.input[..self.sizes.parameters]
    }

    /// Other values of the parameters.
    pub(super) fn set_parameters(&mut self, parameters: &[f64]) {
        self.input[..parameters.len()].copy_from_slice(parameters);
    }

    /// The answer at a time, for what follows the time in the input.
    pub(super) fn ask(&mut self, entry: Entry, t: f64, blocks: &[&[f64]]) -> &[f64] {
        self.inputs_at(t);
        let mut at = self.sizes.parameters;
        self.input[at] = t;
        at += 1;
        for block in blocks {
            self.input[at..at + block.len()].copy_from_slice(block);
            at += block.len();
        }
        debug_assert_eq!(at, self.sizes.input(entry));
        let output = &mut self.outputs[entry as usize];
        self.system.evaluate(entry, &self.input[..at], output, &mut self.workspace);
        output
    }

    /// The last answer.
    pub(super) fn last(&self, entry: Entry) -> &[f64] {
        &self.outputs[entry as usize]
    }
}
