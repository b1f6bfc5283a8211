//! A step of the classical Runge-Kutta method with the derivative at its end, over any scalar. In: where it begins. Out: its end, and
//! whether that is one. Never knows machine code.

use super::inner::{Begin, Inner};
use super::plan::{Evaluate, StepPlan, none_of};
use crate::flat_laws::StepPlaces;
use crate::regularity::note_pivots;
use crate::scalar::Scalar;
use crate::system::{Entry, StageSum};

impl StepPlan {
    /// A step of the classical Runge-Kutta method. Out: the answer of [`Self::derivative`] at the end, with quaternions of unit length; the
    /// flat state there, its coordinates as the method has them; the slope at the last inner stage; kinetic and potential energy at the
    /// end [J]; how regular loops are at the last inner stage, the least of all of these, at the end (no number if an answer is infinite
    /// or none, but the first of them; the others zero if a clearance is another one); 1 where nothing has to be moved at the end; the
    /// largest pivots after the inner stages; at the end squares of the lengths of the Jacobian's rows, residuals of all rows. In:
    /// parameters, times in the middle and at the end [s], length of the step [s]; the flat state where it begins, its slope; of every
    /// joint as [`Self::derivative`] wants it, then its radial clearance with its wear [m] as known; the largest pivots so far; the
    /// factor on how far loops may stay open.
    pub fn classical_step<T: Scalar>(
        &self,
        evaluate: Evaluate<'_, T>,
        question: &[T],
        sum: StageSum,
    ) -> Vec<T> {
        let (at, one) = (StepPlaces::new(&self.sizes), |place: usize| question[place]);
        let (end, memory) = (one(at.end), &question[at.memory.clone()]);
        let begin = Begin {
            known: question,
            memory,
            times: [one(at.middle), end],
            length: one(at.length),
            sum,
            y: &question[at.y.clone()],
            slope: &question[at.slope.clone()],
            pivots: &question[at.pivots.clone()],
        };
        let inner = self.inner_stages(evaluate, &begin);
        let Inner { next, raw, last_slope, pivots, nearness, least, clearances } = inner;
        let known = &question[at.clearances.clone()];
        let least = unless_others(least, known, &clearances);
        let asked = self.ask(question, end, &next);
        let closure = evaluate(Entry::Closure, &asked);
        let is_untouched = self.are_closed((&next, &closure), nearness * one(at.looseness));
        let answer = self.answer(evaluate, &asked, memory);
        let at_end = answer.flat();
        let energy = evaluate(Entry::Energy, &asked);
        let slope = self.slope_of(answer);
        let nearness_at_end = note_pivots(&slope.pivots, &mut pivots.clone());
        let nothing = none_of(T::constant(0.0), &slope.state[self.sizes.coordinates..]);
        let nearness_at_end = nearness_at_end + none_of(nothing, &slope.forces);
        let nearness_at_end = unless_others(nearness_at_end, known, &slope.clearances);
        let squares = self.row_squares(&closure);
        let residuals = closure[..self.sizes.all_rows].to_vec();
        let flags = vec![nearness, least, nearness_at_end, is_untouched];
        let answer = [at_end, next, raw, last_slope, energy, flags, pivots, squares, residuals].concat();
        debug_assert_eq!(answer.len(), at.answer());
        answer
    }

    /// Length of the question of [`Self::classical_step`].
    pub fn classical_step_question(&self) -> usize {
        StepPlaces::new(&self.sizes).question()
    }
}

/// A regularity; zero if one of the clearances, several times those of all joints, is not as known.
fn unless_others<T: Scalar>(nearness: T, known: &[T], clearances: &[T]) -> T {
    let no = T::constant(0.0);
    clearances.iter().zip(known.iter().cycle()).fold(nearness, |nearness, (now, known)| {
        let at_least = T::select(now.lt(*known), no, nearness);
        T::select(known.lt(*now), no, at_least)
    })
}
