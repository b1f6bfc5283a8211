//! When loops count as closed: one tolerance for checks, assembly, projection and runs. In: how far loops are open, and
//! the longest lever arm. Out: a share of the mechanism's size. Never closes anything.

use super::Evaluator;
use super::answers::LoopError;
pub use crate::tolerances::CLOSED;

/// The part that a start may use up: along the motion a loop that is not drawn exactly opens further.
pub const CLOSED_AT_START: f64 = 0.1 * CLOSED;

/// Lever arms below this [m] are what rounding leaves of none, as of a cam at its lowest point: a thousandth of an atom.
const DUST: f64 = 1e-13;

impl LoopError {
    /// How far the loops are open as a part of the longest lever arm [m] or of a radian.
    pub fn part(&self, arm: f64) -> f64 {
        // What is not a number wins.
        let metres = self.metres / arm;
        if metres.is_nan() || metres > self.radians { metres } else { self.radians }
    }
}

impl Evaluator<'_> {
    /// Loop error of the last answer of [`Self::closure`].
    pub fn loop_error(&self) -> LoopError {
        self.loop_error_of(self.last_closure().positions)
    }

    /// Loop error of residuals of all rows.
    pub(crate) fn loop_error_of(&self, positions: &[f64]) -> LoopError {
        // Magnitudes are ordered as their bits are, and what is not a number is above all.
        let (mut sizes, mut most, mut worst) = ([0; 2], 0, 0);
        for (row, (angular, residual)) in self.angular.iter().zip(positions).enumerate() {
            let size = residual.abs().to_bits();
            let side = &mut sizes[usize::from(*angular)];
            *side = size.max(*side);
            if size > most {
                (most, worst) = (size, row);
            }
        }
        let [metres, radians] = sizes.map(f64::from_bits);
        LoopError { metres, radians, worst }
    }

    /// The longest lever arm [m] by which a turning speed moves a kept row; 1 m if none does. The size that lengths of
    /// this mechanism are compared with: at least that of its largest journal, because the offset of a journal is no arm.
    pub fn longest_arm(&mut self, t: f64, q: &[f64], v: &[f64]) -> f64 {
        let description = self.description();
        let linear: Vec<bool> = self.kept().iter().map(|row| !description.rows[*row].angular).collect();
        let jacobian = self.closure(t, q, v).jacobian;
        let rows = jacobian.chunks_exact(v.len().max(1)).zip(linear).filter(|(_, linear)| *linear);
        let arms = rows.flat_map(|(row, _)| row.iter().zip(&*description.speeds));
        let arms = arms.filter(|(_, speed)| speed.unit.starts_with("rad"));
        let longest = arms.fold(0.0_f64, |longest, (arm, _)| longest.max(arm.abs()));
        if !(longest.is_finite() && longest > DUST) {
            return 1.0;
        }
        self.clearances().joints().iter().fold(longest, |size, joint| size.max(joint.journal_radius()))
    }
}
