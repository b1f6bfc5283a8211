//! Trajectories of a mechanism side by side as machine code. In: its tapes, a plan of steps. Out: [`Lanes`], [`NativeBundle`]. Never
//! knows how code is written.

use std::fmt;
use std::sync::Arc;

use linkwear_runtime::clearance_joint::Clearance;
use linkwear_runtime::{Bundle, Entry, Sizes, StepPlan};
use linkwear_tape::{Tape, Tapes};

#[cfg(any(target_arch = "aarch64", target_arch = "x86_64"))]
use crate::functions::Functions;
use crate::refusal::Refusal;
#[cfg(not(any(target_arch = "aarch64", target_arch = "x86_64")))]
use crate::unsupported::Functions;

/// A mechanism as machine code that evaluates `N` states side by side, 4 or 8: every one with the bits that it would have
/// alone. Clones share the code.
#[derive(Clone)]
pub struct Lanes<const N: usize> {
    functions: Arc<Functions>,
    sizes: Sizes,
}

impl<const N: usize> fmt::Debug for Lanes<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Lanes").field("lanes", &N).field("sizes", &self.sizes).finish_non_exhaustive()
    }
}

impl<const N: usize> Lanes<N> {
    /// Writes the code of tapes, in the order of [`Entry::ALL`]. `sizes.workspace` is set here.
    ///
    /// # Errors
    /// If this processor or this system cannot run it, or a tape makes no sense.
    pub fn new(tapes: &[Tape], sizes: Sizes) -> Result<Self, Refusal> {
        let functions = Functions::of_entries::<N>(&tapes, &Entry::ALL)?;
        let sizes = Sizes { workspace: functions.workspace().div_ceil(N), ..sizes };
        Ok(Self { functions: Arc::new(functions), sizes })
    }

    /// The layout of inputs and outputs, as for one state.
    pub const fn sizes(&self) -> Sizes {
        self.sizes
    }

    /// Evaluates `entry`: every value is that of all states. It is fastest where inputs and outputs begin at multiples of
    /// 64 bytes.
    ///
    /// # Panics
    /// If a slice is shorter than [`Sizes`] says.
    pub fn evaluate(
        &self,
        entry: Entry,
        input: &[[f64; N]],
        output: &mut [[f64; N]],
        workspace: &mut [[f64; N]],
    ) {
        let (input, output) = (input.as_flattened(), output.as_flattened_mut());
        self.functions.run(entry as usize, input, output, workspace.as_flattened_mut());
    }
}

/// Steps of `N` trajectories of a mechanism side by side as machine code, laws of contact included. Clones share the code.
#[derive(Clone)]
pub struct NativeBundle<const N: usize> {
    parts: Arc<Functions>,
    sizes: Sizes,
}

impl<const N: usize> fmt::Debug for NativeBundle<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("NativeBundle").field("lanes", &N).field("sizes", &self.sizes).finish_non_exhaustive()
    }
}

impl<const N: usize> NativeBundle<N> {
    /// Writes the code of a plan with tapes; of those it asks for a few.
    ///
    /// # Errors
    /// As [`Lanes::new`]; and if a joint keeps wear by bearing angle.
    pub fn new(tapes: &(impl Tapes + ?Sized), plan: &StepPlan) -> Result<Self, Refusal> {
        if plan.joints().iter().any(Clearance::keeps_profiles) {
            return Err(Refusal::Profile);
        }
        Ok(Self { parts: Arc::new(Functions::of_steps::<N>(&tapes, plan)?), sizes: plan.sizes() })
    }
}

impl<const N: usize> Bundle<N> for NativeBundle<N> {
    fn sizes(&self) -> Sizes {
        self.sizes
    }

    fn workspace(&self) -> usize {
        self.parts.workspace().div_ceil(N)
    }

    fn step(&self, question: &[[f64; N]], answer: &mut [[f64; N]], workspace: &mut [[f64; N]]) {
        let (question, answer) = (question.as_flattened(), answer.as_flattened_mut());
        self.parts.run(0, question, answer, workspace.as_flattened_mut());
    }

    fn conclude(&self, question: &[[f64; N]], answer: &mut [[f64; N]], workspace: &mut [[f64; N]]) {
        let (question, answer) = (question.as_flattened(), answer.as_flattened_mut());
        self.parts.run(1, question, answer, workspace.as_flattened_mut());
    }
}
