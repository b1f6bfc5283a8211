//! What the equations of a mechanism cost on this machine: operations, and time of one call on every back end.
//! In: a compiled mechanism. Out: [`EntryCost`]s. Never knows what the equations are used for.

use std::hint::black_box;
use std::time::{Duration, Instant};

use linkwear_codegen::tape::Operations;
use linkwear_codegen::{Compiled, Options};
use linkwear_native::{Lanes, Native};
use linkwear_runtime::{Entry, Sizes, System};

use crate::backend::{Backend, Equations};

/// How long each entry is called on each back end.
const MEASURED_FOR: Duration = Duration::from_millis(20);
/// Shortest time that is measured at once: a hundred times what a clock resolves, and short enough that many are undisturbed.
const BATCH: Duration = Duration::from_micros(10);

/// Bytes of a line of the cache.
const LINE: usize = 64;

/// Numbers enough for so many values of all lanes, wherever lines of the cache begin.
fn room<const N: usize>(length: usize) -> Vec<f64> {
    vec![0.0; length * N + LINE / size_of::<f64>()]
}

/// The values from where a line of the cache begins.
fn aligned<const N: usize>(numbers: &mut [f64]) -> &mut [[f64; N]] {
    let first = numbers.as_ptr().align_offset(LINE).min(numbers.len());
    numbers[first..].as_chunks_mut().0
}

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
        let alone = |system: &dyn System<f64>| {
            let sizes = system.sizes();
            let (mut output, mut workspace) = (vec![0.0; sizes.output(entry)], vec![0.0; sizes.workspace]);
            nanoseconds(|| {
                system.evaluate(entry, black_box(&input), &mut output, &mut workspace);
                black_box(&mut output);
            })
        };
        EntryCost {
            entry,
            operations: tape.operations(),
            sections: tape.operations_by_section(),
            ns: Nanoseconds {
                interpreter: Some(alone(&interpreter)),
                native: native.as_ref().map(|system| alone(system)),
                compiled: compiled.as_deref().map(alone),
                lanes4: four.as_ref().map(|lanes| side_by_side(lanes, entry, &input)),
                lanes8: eight.as_ref().map(|lanes| side_by_side(lanes, entry, &input)),
            },
        }
    };
    Entry::ALL.into_iter().zip(tapes).map(cost).collect()
}

fn input(entry: Entry, sizes: Sizes, parameters: &[f64]) -> Vec<f64> {
    let others = (0..sizes.input(entry) - parameters.len()).map(|index| 0.3 + 0.01 * index as f64);
    parameters.iter().copied().chain(others).collect()
}

/// Time of one state among several.
fn side_by_side<const N: usize>(lanes: &Lanes<N>, entry: Entry, input: &[f64]) -> f64 {
    let sizes = lanes.sizes();
    let [mut inputs, mut outputs] = [sizes.input(entry), sizes.output(entry)].map(room::<N>);
    let (inputs, outputs) = (aligned(&mut inputs), aligned(&mut outputs));
    for (place, value) in inputs.iter_mut().zip(input) {
        *place = [*value; N];
    }
    let mut workspace = vec![[0.0; N]; sizes.workspace];
    let all = nanoseconds(|| {
        lanes.evaluate(entry, black_box(inputs), outputs, &mut workspace);
        black_box(&mut *outputs);
    });
    all / N as f64
}

/// Time of one call [ns]: the least of many batches, since whatever disturbs makes it longer.
fn nanoseconds(mut call: impl FnMut()) -> f64 {
    let mut timed = |calls: u32| {
        let start = Instant::now();
        (0..calls).for_each(|_| call());
        start.elapsed()
    };
    let mut calls = 1;
    while timed(calls) < BATCH {
        calls *= 2;
    }
    let (mut least, begin) = (Duration::MAX, Instant::now());
    while begin.elapsed() < MEASURED_FOR {
        least = least.min(timed(calls));
    }
    1e9 * least.as_secs_f64() / f64::from(calls)
}
