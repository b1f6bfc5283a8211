//! What one call takes. In: systems, inputs. Out: nanoseconds. Never knows how code is written.
//!
//! Loops around calls of some nanoseconds are compiled here, where they are optimised, not in the crate that asks.

use std::hint::black_box;
use std::time::{Duration, Instant};

use linkwear_runtime::{Entry, System};

use crate::lanes::Lanes;

/// How long an entry is called.
const MEASURED_FOR: Duration = Duration::from_millis(20);
/// Shortest time that is measured at once: a hundred times what a clock resolves, and short enough that many are undisturbed.
const BATCH: Duration = Duration::from_micros(10);

/// Bytes of a line of the cache.
const LINE: usize = 64;

/// Time of one call of an entry at this input [ns].
pub fn nanoseconds_alone(system: &dyn System<f64>, entry: Entry, input: &[f64]) -> f64 {
    let sizes = system.sizes();
    let (mut output, mut workspace) = (vec![0.0; sizes.output(entry)], vec![0.0; sizes.workspace]);
    nanoseconds(|| {
        system.evaluate(entry, black_box(input), &mut output, &mut workspace);
        black_box(&mut output);
    })
}

/// Time of one state of four side by side, all at this input [ns].
pub fn nanoseconds_of_four(lanes: &Lanes<4>, entry: Entry, input: &[f64]) -> f64 {
    side_by_side(lanes, entry, input)
}

/// Time of one state of eight side by side, all at this input [ns].
pub fn nanoseconds_of_eight(lanes: &Lanes<8>, entry: Entry, input: &[f64]) -> f64 {
    side_by_side(lanes, entry, input)
}

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

/// Numbers enough for so many values of all lanes, wherever lines of the cache begin.
fn room<const N: usize>(length: usize) -> Vec<f64> {
    vec![0.0; length * N + LINE / size_of::<f64>()]
}

/// The values from where a line of the cache begins.
fn aligned<const N: usize>(numbers: &mut [f64]) -> &mut [[f64; N]] {
    let first = numbers.as_ptr().align_offset(LINE).min(numbers.len());
    numbers[first..].as_chunks_mut().0
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
