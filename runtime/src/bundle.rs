//! The contract with code that tries steps of several trajectories side by side, a lane each. Every lane has the bits that its
//! trajectory has alone. Never knows how long steps are, nor where machine code comes from.

mod attempt;
mod conclude;
mod inner;
mod places;
mod plan;
mod slope;
mod whole_step;

pub use crate::system::{TOTALS, WORKS};

use crate::system::Sizes;
pub(crate) use places::{Conclusion, Places};
pub use plan::{Evaluate, StepPlan};

/// Whether what a joint integrates is judged by the energy of the mechanism. Depth and impulse are as smooth as the wear integral,
/// and have no natural size of their own.
pub(crate) const fn is_energy(total: usize) -> bool {
    matches!(total, 0 | 3)
}

/// Steps of `N` trajectories of one mechanism by [`crate::Integrator::Rk43`], as its [`StepPlan`] says. No wear by bearing angle.
///
/// All functions read and write one arena, in which everything has its place: what a trajectory brings along, then what
/// [`Self::attempt`] finds, where [`Self::conclude`] reads it. Neither allocates.
pub trait Bundle<const N: usize> {
    /// The counts of the mechanism.
    fn sizes(&self) -> Sizes;

    /// Length of the scratch slice.
    fn workspace(&self) -> usize;

    /// In: the beginning of the arena. Out: the rest of it, the ends of the steps as far as they need no projection.
    ///
    /// # Panics
    /// If a slice is shorter than the plan says, or the scratch slice than [`Self::workspace`].
    fn attempt(&self, question: &[[f64; N]], answer: &mut [[f64; N]], workspace: &mut [[f64; N]]);

    /// In: the arena, the ends of the steps on the constraints. Out: what is there, and the errors of the steps.
    ///
    /// # Panics
    /// As [`Self::attempt`].
    fn conclude(&self, arena: &[[f64; N]], answer: &mut [[f64; N]], workspace: &mut [[f64; N]]);
}
