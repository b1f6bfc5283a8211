//! One tape as machine code, whatever it computes. In: a tape. Out: [`Routine`]. Never knows mechanisms.

use std::fmt;

use linkwear_tape::Tape;

#[cfg(any(target_arch = "aarch64", target_arch = "x86_64"))]
use crate::functions::Functions;
use crate::refusal::Refusal;
#[cfg(not(any(target_arch = "aarch64", target_arch = "x86_64")))]
use crate::unsupported::Functions;

/// A tape as machine code for `N` inputs side by side, 1, 4 or 8: each has the bits that it would have alone.
pub struct Routine<const N: usize> {
    functions: Functions,
}

impl<const N: usize> fmt::Debug for Routine<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Routine").field("lanes", &N).finish_non_exhaustive()
    }
}

impl<const N: usize> Routine<N> {
    /// Writes the code.
    ///
    /// # Errors
    /// If this processor or this system cannot run it, or the tape makes no sense.
    pub fn new(tape: &Tape) -> Result<Self, Refusal> {
        Ok(Self { functions: Functions::new::<N>(std::slice::from_ref(tape))? })
    }

    /// Length of the scratch slice.
    pub fn workspace(&self) -> usize {
        self.functions.workspace().div_ceil(N)
    }

    /// Runs it: every value is that of all lanes.
    ///
    /// # Panics
    /// If a slice is too short.
    pub fn run(&self, input: &[[f64; N]], output: &mut [[f64; N]], workspace: &mut [[f64; N]]) {
        let (input, output) = (input.as_flattened(), output.as_flattened_mut());
        self.functions.run(0, input, output, workspace.as_flattened_mut());
    }
}
