//! A mechanism as machine code that reads and writes columns where they lie. In: one tape per entry. Out: [`Columns`]. Never knows how
//! code is written.

use std::fmt;
use std::sync::Arc;

use linkwear_runtime::{Entry, Sizes};
use linkwear_tape::Tape;

#[cfg(any(target_arch = "aarch64", target_arch = "x86_64"))]
use crate::functions::Functions;
use crate::refusal::Refusal;
#[cfg(not(any(target_arch = "aarch64", target_arch = "x86_64")))]
use crate::unsupported::Functions;

/// A mechanism at many states, `N` at a time, 4 or 8, each quantity a column with the values of all states; every state has the bits
/// that it would have alone. Nothing is copied into lanes and back. Clones share the code.
#[derive(Clone)]
pub struct Columns<const N: usize> {
    functions: Arc<Functions>,
    sizes: Sizes,
}

impl<const N: usize> fmt::Debug for Columns<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Columns").field("lanes", &N).field("sizes", &self.sizes).finish_non_exhaustive()
    }
}

impl<const N: usize> Columns<N> {
    /// Writes the code of tapes, in the order of [`Entry::ALL`].
    ///
    /// # Errors
    /// If this processor or this system cannot run it, or a tape makes no sense.
    pub fn new(tapes: &[Tape], sizes: Sizes) -> Result<Self, Refusal> {
        if let Some(entry) = Entry::ALL.get(tapes.len()) {
            return Err(Refusal::missing(*entry));
        }
        Ok(Self { functions: Arc::new(Functions::of_columns::<N>(tapes)?), sizes })
    }

    /// Evaluates `entry` at `states` states. A column is one value for all of them or one for each. The answers lie one column after the
    /// other.
    ///
    /// # Panics
    /// If columns are not as many as [`Sizes`] says, or have another length.
    pub fn evaluate(&self, entry: Entry, columns: &[&[f64]], states: usize, answers: &mut [f64]) {
        assert_eq!(columns.len(), self.sizes.input(entry), "columns of {}", entry.name());
        assert_eq!(answers.len(), self.sizes.output(entry) * states, "answers of {}", entry.name());
        if states == 0 || answers.is_empty() {
            return;
        }
        let mut workspace = vec![0.0; self.functions.workspace()];
        let mut answers: Vec<&mut [f64]> = answers.chunks_exact_mut(states).collect();
        let mut run = |columns: &[&[f64]], answers: &mut [&mut [f64]]| {
            self.functions.run_columns::<N>(entry as usize, columns, answers, &mut workspace);
        };
        run(columns, &mut answers);
        let rest = states % N;
        if rest == 0 {
            return;
        }
        // The last states share lanes with copies of one of them.
        let last: Vec<[f64; N]> = columns
            .iter()
            .map(|column| {
                let of = &column[column.len().saturating_sub(rest)..];
                std::array::from_fn(|lane| of[lane.min(of.len() - 1)])
            })
            .collect();
        let last: Vec<&[f64]> = last.iter().map(<[f64; N]>::as_slice).collect();
        let mut found = vec![[0.0; N]; answers.len()];
        let mut places: Vec<&mut [f64]> = found.iter_mut().map(<[f64; N]>::as_mut_slice).collect();
        run(&last, &mut places);
        for (answers, found) in answers.iter_mut().zip(&found) {
            answers[states - rest..].copy_from_slice(&found[..rest]);
        }
    }
}
