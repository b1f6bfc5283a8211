//! The functions of one mechanism as machine code of this processor. In: tapes. Out: [`Functions`] that can be called.

use std::thread::available_parallelism;

use linkwear_runtime::{Entry, StageSum, StepPlan};
use linkwear_tape::{Tape, Tapes, side_by_side};

#[cfg(target_arch = "aarch64")]
use crate::aarch64 as processor;
use crate::memory::code::Code;
use crate::refusal::Refusal;
use crate::straight::allocate::Processor;
use crate::straight::fuse::{Part, fuse};
use crate::straight::write::{Named, write};
#[cfg(target_arch = "x86_64")]
use crate::x86 as processor;

/// From so many operations on, tapes are written on several threads: below, these take longer to begin.
const SEVERAL_THREADS: usize = 1000;
/// Threads at most: the longest of the tapes takes a fifth of the time of all.
const MOST_THREADS: usize = 4;

/// Threads that writing tapes is worth which are made on the way.
fn threads() -> usize {
    available_parallelism().map_or(1, |threads| threads.get().min(MOST_THREADS))
}

/// Threads that writing these tapes is worth.
fn threads_for(tapes: &[Tape]) -> usize {
    let operations: usize = tapes.iter().map(|tape| tape.statements.len()).sum();
    if operations < SEVERAL_THREADS { 1 } else { threads() }
}

/// Functions of one mechanism, in the order of their tapes.
pub(crate) struct Functions(Code);

impl Functions {
    /// For one state, or so many side by side as the processor has code for.
    pub(crate) fn new<const LANES: usize>(tapes: &[Tape]) -> Result<Self, Refusal> {
        Self::of_all::<LANES>(tapes, processor::target::<LANES>()?)
    }

    /// Of entries, in their order. Each tape is asked for where its code is written: those that are made by then are made side by
    /// side, too.
    pub(crate) fn of_entries<const LANES: usize>(
        tapes: &dyn Tapes,
        entries: &[Entry],
    ) -> Result<Self, Refusal> {
        let tape = |entry: &Entry| tapes.tape(*entry).ok_or_else(|| Refusal::missing(*entry));
        Self::for_target::<LANES, _>(entries, threads(), tape, processor::target::<LANES>()?)
    }

    /// For so many states side by side of which every input and output is a column.
    pub(crate) fn of_columns<const LANES: usize>(tapes: &[Tape]) -> Result<Self, Refusal> {
        Self::of_all::<LANES>(tapes, processor::target_of_columns::<LANES>()?)
    }

    fn of_all<const LANES: usize>(tapes: &[Tape], target: impl Processor + Sync) -> Result<Self, Refusal> {
        let all: Vec<&Tape> = tapes.iter().collect();
        Self::for_target::<LANES, _>(&all, threads_for(tapes), |tape| Ok(*tape), target)
    }

    /// Of tapes that are found by items, on so many threads.
    fn for_target<'t, const LANES: usize, I: Sync>(
        items: &[I],
        threads: usize,
        tape: impl Fn(&I) -> Result<&'t Tape, Refusal> + Sync,
        target: impl Processor + Sync,
    ) -> Result<Self, Refusal> {
        let functions = processor::functions::<LANES>();
        let written = side_by_side(items, threads, |item| write(tape(item)?, target, &functions));
        Code::new(written.into_iter().collect::<Result<_, _>>()?).map(Self)
    }

    /// Both parts of a step, from the tapes of all entries: see [`linkwear_runtime::Bundle`].
    pub(crate) fn of_steps<const LANES: usize>(tapes: &dyn Tapes, plan: &StepPlan) -> Result<Self, Refusal> {
        Self::of_parts::<LANES>(tapes, plan, &[Part::Step, Part::Conclude])
    }

    /// The derivative with the laws of contact inside: see [`linkwear_runtime::WithLaws`].
    pub(crate) fn of_laws(tapes: &dyn Tapes, plan: &StepPlan) -> Result<Self, Refusal> {
        Self::of_parts::<1>(tapes, plan, &[Part::Derivative])
    }

    /// A whole step: see [`linkwear_runtime::ClassicalStep`].
    pub(crate) fn of_whole_step(tapes: &dyn Tapes, plan: &StepPlan, sum: StageSum) -> Result<Self, Refusal> {
        Self::of_parts::<1>(tapes, plan, &[Part::WholeStep(sum)])
    }

    fn of_parts<const LANES: usize>(
        tapes: &dyn Tapes,
        plan: &StepPlan,
        parts: &[Part],
    ) -> Result<Self, Refusal> {
        let (target, functions) = (processor::target::<LANES>()?, processor::functions::<LANES>());
        let written = parts.iter().map(|part| {
            let named = Named { name: part.name(), operations: fuse(tapes, plan, *part) };
            write(named, target, &functions)
        });
        Code::new(written.collect::<Result<_, _>>()?).map(Self)
    }

    /// Length of the scratch slice that every function is content with, in numbers.
    pub(crate) fn workspace(&self) -> usize {
        self.0.workspace()
    }

    /// Runs a function; slices hold the numbers of all lanes, value by value.
    ///
    /// # Panics
    /// If a slice is too short, or there is no such function.
    pub(crate) fn run(&self, function: usize, input: &[f64], output: &mut [f64], workspace: &mut [f64]) {
        self.0.run(function, input, output, workspace);
    }

    /// Runs a function that was written for columns: one of one value is that value for all states.
    ///
    /// # Panics
    /// If there are other columns than the function has, or a slice is too short.
    pub(crate) fn run_columns<const LANES: usize>(
        &self,
        function: usize,
        columns: &[&[f64]],
        answers: &mut [&mut [f64]],
        workspace: &mut [f64],
    ) {
        self.0.run_columns::<LANES>(function, columns, answers, workspace);
    }
}
