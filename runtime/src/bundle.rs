//! The contract with code that tries steps of several trajectories side by side, a lane each. Every lane has the bits that its
//! trajectory has alone. Never knows how long steps are, nor where machine code comes from.

mod attempt;
mod conclude;
mod inner;
mod places;
mod plan;
mod slope;
mod step;
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
/// Both functions read and write one arena, in which everything has its place: what a trajectory brings along, the end of its step,
/// what is there. Neither allocates.
pub trait Bundle<const N: usize> {
    /// The counts of the mechanism.
    fn sizes(&self) -> Sizes;

    /// Length of the scratch slice.
    fn workspace(&self) -> usize;

    /// In: the beginning of the arena. Out: the rest of it, the ends of the steps as if none of them needed a projection, what is
    /// there, and the errors of the steps.
    ///
    /// # Panics
    /// If a slice is shorter than the plan says, or the scratch slice than [`Self::workspace`].
    fn step(&self, question: &[[f64; N]], answer: &mut [[f64; N]], workspace: &mut [[f64; N]]);

    /// What is at the ends of the steps, after some of them have been put onto the constraints, and the errors of the steps. In: the
    /// arena up to there. Out: the rest of it.
    ///
    /// # Panics
    /// As [`Self::step`].
    fn conclude(&self, question: &[[f64; N]], answer: &mut [[f64; N]], workspace: &mut [[f64; N]]);
}
