//! One array of the caller, cut into what a step works in. In: counts. Out: slices. Never knows what is done with them.

use crate::system::{Entry, Sizes};

/// Numbers per joint that a run remembers: whether it touches (1), speed at which its gap closed [m/s].
pub(super) const MEMORY: usize = 2;
/// Numbers per joint of the last evaluation: what it adds to its totals in a second, penetration [m], its rate [m/s].
pub(super) const ANSWER: usize = 6;

const fn larger(a: usize, b: usize) -> usize {
    if a < b { b } else { a }
}

/// Declares the slices in their order, each with its length.
macro_rules! storage {
    (|$sizes:ident| $($(#[$doc:meta])* $part:ident: $length:expr,)*) => {
        /// Slices of the caller's array, in order.
        pub(super) struct Storage<'n> {
            $($(#[$doc])* pub(super) $part: &'n mut [f64],)*
        }

        /// Length of the whole array.
        pub(super) const fn numbers($sizes: &Sizes) -> usize {
            0 $(+ $length)*
        }

        impl<'n> Storage<'n> {
            /// Nothing if the array is too short.
            pub(super) fn of($sizes: &Sizes, numbers: &'n mut [f64]) -> Option<Self> {
                let left = numbers;
                $(let ($part, left) = left.split_at_mut_checked($length)?;)*
                let _ = left;
                Some(Self { $($part),* })
            }
        }
    };
}

storage! { |sizes|
    /// The largest value that each loop pivot has had.
    largest_pivots: sizes.rows,
    /// Longest length that each kept row of the Jacobian has had.
    row_lengths: sizes.rows,
    /// How far every bearing is worn [m].
    worn: sizes.contacts,
    /// [`MEMORY`] numbers of every joint with clearance. From here on nothing is kept from step to step.
    memories: MEMORY * sizes.contacts,
    /// Penetration [m] and its rate [m/s] at the beginning of the step.
    depths: 2 * sizes.contacts,
    /// [`ANSWER`] numbers of every joint with clearance.
    answers: ANSWER * sizes.contacts,
    stage: sizes.flat_state(),
    /// Of four stages, one behind the other.
    slopes: 4 * sizes.flat_state(),
    /// Parameters, time, state, wrenches, answer of the contacts.
    question: sizes.input(Entry::Derivative),
    answer: larger(sizes.output(Entry::Derivative), sizes.output(Entry::Closure)),
    /// The question of [`Entry::Observe`].
    observed: sizes.input(Entry::Observe),
    /// The scaled Jacobian, factors of its normal equations, row by row what is made of them.
    jacobian: sizes.rows * sizes.speeds,
    factors: sizes.rows * sizes.rows,
    work: sizes.rows,
    scales: sizes.rows,
    residual: sizes.rows,
    right: sizes.rows,
    delta: sizes.speeds,
    workspace: sizes.workspace,
}

impl Storage<'_> {
    /// A run begins: nothing is remembered but how far bearings are worn.
    pub(super) fn forget(&mut self) {
        self.largest_pivots.fill(0.0);
        self.row_lengths.fill(0.0);
        self.memories.fill(0.0);
    }
}
