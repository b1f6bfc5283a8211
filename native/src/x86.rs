//! Code for x86-64 processors. In: tapes. Out: [`Functions`] that can be called.

mod allocate;
mod bounds;
mod code;
mod encode;
mod frame;
mod functions;
mod graph;
mod instruction;
mod lower;
mod number;
mod order;
mod pool;
mod processor;
#[cfg(test)]
mod tests;
mod uses;
mod write;

use linkwear_codegen::tape::Tape;

use crate::refusal::Refusal;

use code::Code;
use instruction::Lanes;
use write::write;

/// Functions of one mechanism, in the order of their tapes.
pub(crate) struct Functions(Code);

impl Functions {
    /// For one, four or eight states side by side.
    pub(crate) fn new<const LANES: usize>(tapes: &[Tape]) -> Result<Self, Refusal> {
        let lanes = const {
            match LANES {
                1 => Lanes::One,
                4 => Lanes::Four,
                8 => Lanes::Eight,
                _ => panic!("one, four or eight lanes"),
            }
        };
        let needed = if lanes == Lanes::Eight { "AVX-512 (F, DQ, VL)" } else { "AVX" };
        let target = processor::target(lanes).ok_or(Refusal::Processor { needed })?;
        let written = tapes.iter().map(|tape| write(tape, target, &functions::address::<LANES>));
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
}
