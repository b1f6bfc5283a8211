//! Tapes in as few operations as passes over the graph find, each made when it is first asked for: a run asks for few.
//! In: equations. Out: [`ShortTapes`]. Never knows who asks.

use std::sync::{Arc, OnceLock};
use std::thread::available_parallelism;

use linkwear_runtime::Entry;
use linkwear_tape::Tapes;

use crate::derive::{Block, Equations, Function};
use crate::expr::{ExprId, Graph, shortened};

use super::groups::{Group, WhenAsked, group, of_group};
use super::lower::lower_function;
use super::signs::with_fewer_signs;
use super::{Tape, side_by_side};

/// One tape per function. Values are those of the equations but for rounding.
#[derive(Debug)]
pub struct ShortTapes {
    equations: Arc<Equations>,
    made: WhenAsked<Tape>,
    all: OnceLock<Vec<Tape>>,
}

impl ShortTapes {
    /// Of equations; makes none yet.
    pub fn new(equations: Arc<Equations>) -> Self {
        Self { equations, made: WhenAsked::default(), all: OnceLock::new() }
    }

    /// All, in the order of [`Entry::ALL`]; those that are not made yet on all cores.
    pub fn all(&self) -> &[Tape] {
        self.all.get_or_init(|| {
            let mut first: Vec<Entry> =
                Entry::ALL.into_iter().filter(|entry| !self.equations.goes_on(*entry)).collect();
            // Those that take longest are among the last, and are best begun first.
            first.reverse();
            let cores = available_parallelism().map_or(1, usize::from);
            let groups = side_by_side(&first, cores, |entry| match self.made.known(*entry) {
                Some(known) => known.to_vec(),
                None => group(&self.equations, *entry).map(short_group).unwrap_or_default(),
            });
            groups.into_iter().rev().flatten().collect()
        })
    }

    /// All, if they were asked for.
    pub fn known(&self) -> Option<&[Tape]> {
        self.all.get().map(Vec::as_slice)
    }
}

impl Tapes for ShortTapes {
    fn tape(&self, entry: Entry) -> Option<&Tape> {
        match self.all.get() {
            Some(all) => all.get(entry as usize),
            None => self.made.get(&self.equations, entry, short_group),
        }
    }
}

/// Lowers a group in as few operations as passes find.
fn short_group((graph, group): (&Graph, Group<'_>)) -> Vec<Tape> {
    of_group(group, &|function| short(graph, function))
}

/// Lowers a function of it.
fn short(graph: &Graph, function: &Function) -> Tape {
    let flat = |blocks: &[Block]| -> Vec<ExprId> {
        blocks.iter().flat_map(|block| block.entries.iter().copied()).collect()
    };
    let short = shortened(graph, &flat(&function.inputs), &flat(&function.outputs));
    let placed = |blocks: &[Block], ids: &[ExprId]| -> Vec<Block> {
        let mut ids = ids.iter().copied();
        let with = |block: &Block| Block {
            entries: ids.by_ref().take(block.entries.len()).collect(),
            ..block.clone()
        };
        blocks.iter().map(with).collect()
    };
    let inputs = placed(&function.inputs, &short.inputs);
    let outputs = placed(&function.outputs, &short.roots);
    with_fewer_signs(lower_function(&short.graph, &Function { inputs, outputs, ..function.clone() }))
}
