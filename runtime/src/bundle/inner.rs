//! The inner stages of a step of the classical Runge-Kutta method and the end that they give, over any scalar; whether that end has to be
//! projected. In: where a step begins. Out: its end. Never knows machine code.

use super::plan::{Evaluate, StepPlan, none_of};
use crate::regularity::note_pivots;
use crate::row_scales::square_of;
use crate::runge_kutta::{PARTS, end_of_step};
use crate::scalar::Scalar;
use crate::system::StageSum;
use crate::tolerances::tolerances;

/// Where a step begins.
pub(super) struct Begin<'b, T> {
    /// Parameters, and what may stand behind them; memories of contacts.
    pub(super) known: &'b [T],
    pub(super) memory: &'b [T],
    /// Times in its middle and at its end [s], its length [s].
    pub(super) times: [T; 2],
    pub(super) length: T,
    /// How the slopes of its stages are summed.
    pub(super) sum: StageSum,
    /// The flat state and its slope.
    pub(super) y: &'b [T],
    pub(super) slope: &'b [T],
    /// The largest value that each pivot has had.
    pub(super) pivots: &'b [T],
}

/// What inner stages give.
pub(super) struct Inner<T> {
    /// The flat state at the end, with quaternions of unit length; its coordinates as the method has them.
    pub(super) next: Vec<T>,
    pub(super) raw: Vec<T>,
    /// The slope at the last stage.
    pub(super) last_slope: Vec<T>,
    /// The largest value that each pivot has had then.
    pub(super) pivots: Vec<T>,
    /// How regular loops are at the last stage, and the least of all, which is no number if an answer is infinite or none.
    pub(super) nearness: T,
    pub(super) least: T,
    /// Radial clearances with their wear [m], joint by joint, stage by stage.
    pub(super) clearances: Vec<T>,
}

impl StepPlan {
    /// Evaluates the inner stages of a step.
    pub(super) fn inner_stages<T: Scalar>(
        &self,
        evaluate: Evaluate<'_, T>,
        begin: &Begin<'_, T>,
    ) -> Inner<T> {
        let Begin { known, memory, times: [middle, end], length, sum, y, .. } = *begin;
        let (mut slopes, mut pivots) = (vec![begin.slope.to_vec()], begin.pivots.to_vec());
        let (mut nearness, mut least, mut nothing) = (T::constant(1.0), T::constant(1.0), T::constant(0.0));
        let mut clearances = Vec::new();
        for part in PARTS {
            let factor = T::constant(part) * length;
            let before = &slopes[slopes.len() - 1];
            let state: Vec<T> = y.iter().zip(before).map(|(y, slope)| *y + factor * *slope).collect();
            let t = if part == 1.0 { end } else { middle };
            let slope = self.slope(evaluate, (known, memory), t, &state);
            nearness = note_pivots(&slope.pivots, &mut pivots);
            least = T::select(nearness.lt(least), nearness, least);
            nothing = none_of(nothing, &slope.forces);
            clearances.extend(slope.clearances);
            slopes.push(slope.state);
        }
        let end = |i: usize| end_of_step(sum, y[i], length, std::array::from_fn(|stage| slopes[stage][i]));
        let mut next: Vec<T> = (0..y.len()).map(end).collect();
        // Slopes that are infinite or none leave no finite end.
        nothing = none_of(nothing, &next);
        let raw = next[..self.sizes.coordinates].to_vec();
        self.layout.normalize(&mut next);
        let last_slope = slopes.pop().unwrap_or_default();
        Inner { next, raw, last_slope, pivots, nearness, least: least + nothing, clearances }
    }

    /// 1 where loops are closed such that nothing is moved, else 0.
    pub(super) fn are_closed<T: Scalar>(&self, (next, closure): (&[T], &[T]), strictness: T) -> T {
        let (yes, no) = (T::constant(1.0), T::constant(0.0));
        let (positions, rest) = closure.split_at(self.sizes.all_rows);
        let (q, v) = next.split_at(self.sizes.coordinates);
        let largest = |values: &[T]| values.iter().fold(no, |most, value| most.max(value.abs()));
        let (position, speed) = tolerances(strictness, largest(q), largest(&v[..self.sizes.speeds]));
        let residuals = self.kept.iter().map(|row| (positions[*row], position));
        let residuals = residuals.chain(rest[..self.sizes.rows].iter().map(|residual| (*residual, speed)));
        residuals.fold(yes, |closed, (residual, limit)| T::select(limit.lt(residual.abs()), no, closed))
    }

    /// Squares of the lengths of the Jacobian's rows, by the answer of [`crate::Entry::Closure`].
    pub(super) fn row_squares<T: Scalar>(&self, closure: &[T]) -> Vec<T> {
        let jacobian = &closure[self.sizes.all_rows + self.sizes.rows..];
        let rows = jacobian.chunks_exact(self.sizes.speeds.max(1)).take(self.sizes.rows);
        let squares: Vec<T> = rows.map(square_of).collect();
        // Without speeds there are rows of nothing.
        if squares.is_empty() { vec![T::constant(0.0); self.sizes.rows] } else { squares }
    }
}
