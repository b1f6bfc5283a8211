//! Accelerations at a state: the generated forward dynamics, or a rank-revealing solve where the loops
//! are nearly singular. In: time and state. Out: accelerations, multipliers, drive forces.
//! Never knows step sizes.

use crate::singular::SingularSolver;
use crate::{Evaluator, RunError};

/// Loop pivots (squares of singular values, about) below this part of the largest pivot seen so far make
/// the runtime distrust the generated elimination. At 1e-9 that has lost half of its digits in the
/// direction that becomes singular; the orthogonal solve loses a third of them.
pub const SINGULAR_PIVOT: f64 = 1e-9;

/// Evaluates accelerations and counts how.
pub struct Dynamics<'a> {
    /// The mechanism.
    pub evaluator: Evaluator<'a>,
    /// Calls of the forward dynamics.
    pub evaluations: u64,
    /// Calls that needed the rank-revealing solve.
    pub rank_revealing_solves: u64,
    singular_pivot: f64,
    largest_pivot: f64,
    regularity: f64,
    solver: SingularSolver,
}

impl<'a> Dynamics<'a> {
    /// Prepares storage; `singular_pivot` is the threshold, [`SINGULAR_PIVOT`] by default.
    #[must_use]
    pub fn new(evaluator: Evaluator<'a>, singular_pivot: f64) -> Self {
        let solver = SingularSolver::new(&evaluator);
        Self {
            evaluator,
            evaluations: 0,
            rank_revealing_solves: 0,
            singular_pivot,
            largest_pivot: 0.0,
            regularity: 1.0,
            solver,
        }
    }

    /// Accelerations, multipliers and drive forces at a state; read them with
    /// [`Evaluator::last_forward`].
    ///
    /// # Errors
    /// [`RunError::NonFinite`] if one of them is infinite or not a number.
    pub fn accelerate(&mut self, t: f64, q: &[f64], v: &[f64]) -> Result<(), RunError> {
        self.evaluations += 1;
        let pivots = self.evaluator.forward(t, q, v).pivots;
        let mut smallest = f64::INFINITY;
        let mut most = self.largest_pivot;
        for pivot in pivots {
            // A pivot that is not a number counts as lost rank.
            smallest = if *pivot >= smallest { smallest } else { *pivot };
            if pivot.is_finite() {
                most = most.max(*pivot);
            }
        }
        self.largest_pivot = most;
        self.regularity = if smallest.is_nan() { 0.0 } else { smallest.min(most) / most };
        let near_singular = smallest.is_nan() || smallest < self.singular_pivot * most;
        if near_singular {
            self.rank_revealing_solves += 1;
            self.solver.solve(&mut self.evaluator, t, q, v);
        }
        self.check(t)
    }

    /// Smallest loop pivot of the last state over the largest seen so far: 0 at a singular position.
    #[must_use]
    pub fn regularity(&self) -> f64 {
        self.regularity
    }

    fn check(&self, t: f64) -> Result<(), RunError> {
        let forward = self.evaluator.last_forward();
        let description = self.evaluator.description();
        let bad = |values: &[f64]| values.iter().position(|x| !x.is_finite());
        let what = if let Some(i) = bad(forward.accelerations) {
            format!("acceleration of {}", description.speeds[i].name)
        } else if let Some(i) = bad(forward.drives) {
            format!("drive of {}", description.drivers[i].joint)
        } else if let Some(i) = bad(forward.multipliers) {
            format!("multiplier of {}", self.evaluator.joint_of_row(self.evaluator.kept()[i]))
        } else {
            return Ok(());
        };
        Err(RunError::NonFinite { t, what })
    }
}
