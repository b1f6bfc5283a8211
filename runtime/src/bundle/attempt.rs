//! A step side by side with others up to where it may have to be projected, over any scalar. In: the begin of an arena. Out: the rest of
//! it. Never knows machine code.

use super::inner::{Begin, Inner};
use super::plan::{Evaluate, StepPlan, none_of};
use crate::scalar::Scalar;
use crate::system::{Entry, StageSum};

impl StepPlan {
    /// The inner stages of a step, its end before it is put onto the constraints, and whether it has to be.
    pub(super) fn attempt<T: Scalar>(&self, evaluate: Evaluate<'_, T>, question: &[T]) -> Vec<T> {
        let (at, one) = (&self.places, |place: usize| question[place]);
        let length = one(at.length);
        let begin = Begin {
            known: question,
            memory: &question[at.memory.clone()],
            times: [one(at.begin) + T::constant(0.5) * length, one(at.end)],
            length,
            sum: StageSum::InTurn,
            y: &question[at.y.clone()],
            slope: &question[at.slope.clone()],
            pivots: &question[at.pivots.clone()],
        };
        let inner = self.inner_stages(evaluate, &begin);
        let Inner { next, raw, last_slope, pivots, nearness, least, .. } = inner;
        let closure = evaluate(Entry::Closure, &self.ask(question, one(at.end), &next));
        let is_untouched = self.are_closed((&next, &closure), nearness * one(at.looseness));
        let squares = self.row_squares(&closure);
        let (yes, no) = (T::constant(1.0), T::constant(0.0));
        let both = question[at.row_squares.clone()].iter().zip(&squares);
        let has_longer_row = both.fold(no, |longer, (most, square)| T::select(most.lt(*square), yes, longer));
        let [metres, radians] = self.open(&closure);
        let residuals = closure[..self.sizes.all_rows].to_vec();
        let flags = vec![nearness, least, is_untouched, has_longer_row, metres, radians];
        let answer = [next, raw, last_slope, pivots, flags, squares, residuals].concat();
        debug_assert_eq!(self.step_question() + answer.len(), self.conclude_question());
        answer
    }

    /// How far loops are open [m], [rad], by the answer of [`Entry::Closure`]; no number if that is none.
    fn open<T: Scalar>(&self, closure: &[T]) -> [T; 2] {
        let positions = &closure[..self.sizes.all_rows];
        let nothing = none_of(T::constant(0.0), positions);
        [false, true].map(|angular| {
            let rows = self.angular.iter().zip(positions).filter(|(row, _)| **row == angular);
            nothing + rows.fold(T::constant(0.0), |most, (_, residual)| most.max(residual.abs()))
        })
    }
}
