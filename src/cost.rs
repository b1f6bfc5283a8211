//! What the equations of a mechanism cost on this machine: operations, and time of one call on every back end.
//! In: a compiled mechanism. Out: [`EntryCost`]s. Never knows what the equations are used for.

use linkwear_codegen::tape::Operations;
use linkwear_codegen::{Compiled, Options};
use linkwear_native::{Lanes, Native, nanoseconds_alone, nanoseconds_of_eight, nanoseconds_of_four};
use linkwear_runtime::{Entry, Sizes, System};

use crate::backend::{Backend, Equations};

/// Time of one call on each back end [ns]; none where a back end is missing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Nanoseconds {
    /// The interpreter.
    pub interpreter: Option<f64>,
    /// Machine code written now.
    pub native: Option<f64>,
    /// Code that was compiled in.
    pub compiled: Option<f64>,
    /// Machine code for four states side by side, per state.
    pub lanes4: Option<f64>,
    /// Machine code for eight states side by side, per state.
    pub lanes8: Option<f64>,
}

/// What one entry costs.
#[derive(Clone, Debug, PartialEq)]
pub struct EntryCost {
    /// Which.
    pub entry: Entry,
    /// Its operations.
    pub operations: Operations,
    /// Its operations by section: what they are for.
    pub sections: Vec<(String, Operations)>,
    /// Its time.
    pub ns: Nanoseconds,
}

/// Counts and measures every entry, the parameters at their values, all else at small numbers: no operation takes more or
/// less time for other ones, but that library functions have a few cases.
pub fn entry_costs(mechanism: &Compiled, options: &Options) -> Vec<EntryCost> {
    let (tapes, sizes) = (mechanism.tapes(), mechanism.sizes());
    let interpreter = mechanism.interpreter();
    let native = Native::new(tapes, sizes).ok();
    let compiled = Equations::choose(mechanism, options, Backend::Compiled).ok();
    let compiled = compiled.map(|equations| equations.system());
    let (four, eight) = (Lanes::<4>::new(tapes, sizes).ok(), Lanes::<8>::new(tapes, sizes).ok());
    let parameters = mechanism.parameters();
    let cost = |(entry, tape): (Entry, &linkwear_codegen::tape::Tape)| {
        let input = input(entry, sizes, &parameters);
        let alone = |system: &dyn System<f64>| nanoseconds_alone(system, entry, &input);
        EntryCost {
            entry,
            operations: tape.operations(),
            sections: tape.operations_by_section(),
            ns: Nanoseconds {
                interpreter: Some(alone(interpreter.on_numbers())),
                native: native.as_ref().map(|system| alone(system)),
                compiled: compiled.as_deref().map(alone),
                lanes4: four.as_ref().map(|lanes| nanoseconds_of_four(lanes, entry, &input)),
                lanes8: eight.as_ref().map(|lanes| nanoseconds_of_eight(lanes, entry, &input)),
            },
        }
    };
    Entry::ALL.into_iter().zip(tapes).map(cost).collect()
}

fn input(entry: Entry, sizes: Sizes, parameters: &[f64]) -> Vec<f64> {
    let others = (0..sizes.input(entry) - parameters.len()).map(|index| 0.3 + 0.01 * index as f64);
    parameters.iter().copied().chain(others).collect()
}
