//! One array of the caller, cut into what a step works in. In: counts. Out: slices. Never knows what is done with them.

use crate::system::{Entry, Sizes};

/// Numbers per joint that a run remembers: whether it touches (1), speed at which its gap closed [m/s].
pub(super) const MEMORY: usize = 2;
/// Numbers per joint of the last evaluation: what it adds to its totals in a second, penetration [m], its rate [m/s].
pub(super) const ANSWER: usize = 6;

/// Slices of the caller's array, in order.
pub(super) struct Storage<'n> {
    /// The largest value that each loop pivot has had.
    pub(super) largest_pivots: &'n mut [f64],
    /// Longest length that each kept row of the Jacobian has had.
    pub(super) row_lengths: &'n mut [f64],
    /// How far every bearing is worn [m].
    pub(super) worn: &'n mut [f64],
    /// [`MEMORY`] numbers of every joint with clearance. From here on nothing is kept from step to step.
    pub(super) memories: &'n mut [f64],
    /// Penetration [m] and its rate [m/s] at the beginning of the step.
    pub(super) depths: &'n mut [f64],
    /// [`ANSWER`] numbers of every joint with clearance.
    pub(super) answers: &'n mut [f64],
    pub(super) stage: &'n mut [f64],
    pub(super) slopes: [&'n mut [f64]; 4],
    /// Parameters, time, state, wrenches, answer of the contacts.
    pub(super) question: &'n mut [f64],
    pub(super) answer: &'n mut [f64],
    /// The question of [`Entry::Observe`].
    pub(super) observed: &'n mut [f64],
    /// The scaled Jacobian, factors of its normal equations, row by row what is made of them.
    pub(super) jacobian: &'n mut [f64],
    pub(super) factors: &'n mut [f64],
    pub(super) work: &'n mut [f64],
    pub(super) scales: &'n mut [f64],
    pub(super) residual: &'n mut [f64],
    pub(super) right: &'n mut [f64],
    pub(super) delta: &'n mut [f64],
    pub(super) workspace: &'n mut [f64],
}

/// Slices that the array is cut into.
const PARTS: usize = 22;

const fn larger(a: usize, b: usize) -> usize {
    if a < b { b } else { a }
}

/// Lengths in the order of the fields.
const fn lengths(sizes: &Sizes) -> [usize; PARTS] {
    let (rows, speeds, contacts, flat) = (sizes.rows, sizes.speeds, sizes.contacts, sizes.flat_state());
    [
        rows,
        rows,
        contacts,
        MEMORY * contacts,
        2 * contacts,
        ANSWER * contacts,
        flat,
        flat,
        flat,
        flat,
        flat,
        sizes.input(Entry::Derivative),
        larger(sizes.output(Entry::Derivative), sizes.output(Entry::Closure)),
        sizes.input(Entry::Observe),
        rows * speeds,
        rows * rows,
        rows,
        rows,
        rows,
        rows,
        speeds,
        sizes.workspace,
    ]
}

/// Length of the whole array.
pub(super) const fn numbers(sizes: &Sizes) -> usize {
    let lengths = lengths(sizes);
    let (mut sum, mut i) = (0, 0);
    while i < lengths.len() {
        sum += lengths[i];
        i += 1;
    }
    sum
}

impl<'n> Storage<'n> {
    /// Nothing if the array is too short.
    pub(super) fn of(sizes: &Sizes, numbers: &'n mut [f64]) -> Option<Self> {
        let mut left = numbers;
        let mut parts: [&'n mut [f64]; PARTS] = Default::default();
        for (part, length) in parts.iter_mut().zip(lengths(sizes)) {
            let (this, rest) = core::mem::take(&mut left).split_at_mut_checked(length)?;
            (*part, left) = (this, rest);
        }
        let [
            largest_pivots,
            row_lengths,
            worn,
            memories,
            depths,
            answers,
            stage,
            first,
            second,
            third,
            fourth,
            question,
            answer,
            observed,
            jacobian,
            factors,
            work,
            scales,
            residual,
            right,
            delta,
            workspace,
        ] = parts;
        let slopes = [first, second, third, fourth];
        Some(Self {
            largest_pivots,
            row_lengths,
            worn,
            memories,
            depths,
            answers,
            stage,
            slopes,
            question,
            answer,
            observed,
            jacobian,
            factors,
            work,
            scales,
            residual,
            right,
            delta,
            workspace,
        })
    }

    /// A run begins: nothing is remembered but how far bearings are worn.
    pub(super) fn forget(&mut self) {
        self.largest_pivots.fill(0.0);
        self.row_lengths.fill(0.0);
        self.memories.fill(0.0);
    }
}
