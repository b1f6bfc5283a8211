//! What equations and laws say at a state, the laws of contact in the middle, over any scalar. In: answers of entries. Out: derivatives,
//! contacts. Never knows steps.

use super::WORKS;
use super::plan::{Evaluate, StepPlan};
use crate::flat_laws::{
    CONTACT_MEMORY, LawsPlaces, contact_answer, round_response, total_rates, worn_clearance,
};
use crate::joint_laws::Response;
use crate::scalar::Scalar;
use crate::system::{CONTACT_MOTION, Entry};

/// What the equations say at a state.
pub(super) struct Slope<T> {
    /// Of the flat state.
    pub(super) state: Vec<T>,
    /// Multipliers and drive forces.
    pub(super) forces: Vec<T>,
    pub(super) pivots: Vec<T>,
    /// What the laws say of every joint, and its [`crate::flat_laws::CONTACT_ANSWER`] numbers.
    pub(super) responses: Vec<Response<T>>,
    pub(super) contacts: Vec<T>,
    /// Radial clearance of every joint with its wear [m].
    pub(super) clearances: Vec<T>,
}

/// What the equations and the laws say at a state.
pub(super) struct Answer<T> {
    /// The answer of [`Entry::Derivative`].
    pub(super) equations: Vec<T>,
    /// What the laws say of every joint, and the rates of its [`super::TOTALS`].
    pub(super) responses: Vec<Response<T>>,
    pub(super) totals: Vec<T>,
    /// [`crate::flat_laws::CONTACT_ANSWER`] numbers of every joint.
    pub(super) contacts: Vec<T>,
    /// Radial clearance of every joint with its wear [m].
    pub(super) clearances: Vec<T>,
}

impl<T: Scalar> Answer<T> {
    /// As the answer of [`StepPlan::derivative`].
    pub(super) fn flat(&self) -> Vec<T> {
        let Self { equations, totals, contacts, clearances, .. } = self;
        [&equations[..], totals, contacts, clearances].concat()
    }
}

impl StepPlan {
    /// The answer of [`Entry::Derivative`] to a state, laws of contact in the middle. Behind it, of all joints with clearance: rates of
    /// the [`super::TOTALS`] of each; what each contact is like (14: offset (3) [m], penetration [m], its rate [m/s], sliding speed [m/s],
    /// energy stored [J], mean pressure [Pa], wrench as [`crate::CONTACT_WRENCH`]); the radial clearance with its wear of each [m].
    /// In: the question of [`Entry::Contacts`], then of every joint how far it is worn [m], its stiffness [N/m^n], whether it touches
    /// (1), the speed at which its gap closed [m/s].
    pub fn derivative<T: Scalar>(&self, evaluate: Evaluate<'_, T>, question: &[T]) -> Vec<T> {
        let (state, memory) = question.split_at(self.sizes.input(Entry::Contacts));
        let answer = self.answer(evaluate, state, memory).flat();
        debug_assert_eq!(answer.len(), LawsPlaces::new(&self.sizes).all());
        answer
    }

    /// Length of the question of [`Self::derivative`].
    pub fn derivative_question(&self) -> usize {
        self.sizes.input(Entry::Contacts) + CONTACT_MEMORY * self.sizes.contacts
    }

    /// What equations and laws say at a state, the question of [`Entry::Contacts`].
    pub(super) fn answer<T: Scalar>(
        &self,
        evaluate: Evaluate<'_, T>,
        state: &[T],
        memory: &[T],
    ) -> Answer<T> {
        let moved = evaluate(Entry::Contacts, state);
        let (motions, _) = moved.as_chunks::<CONTACT_MOTION>();
        let (memories, _) = memory.as_chunks();
        let each = self.joints.iter().zip(motions).zip(memories);
        let responses: Vec<_> =
            each.map(|((joint, motion), memory)| round_response(joint, motion, *memory)).collect();
        let wrenches = responses.iter().flat_map(|response| response.wrench).collect();
        let question = [state.to_vec(), wrenches, moved.clone()].concat();
        let each = self.joints.iter().zip(motions).zip(&responses);
        let contacts = each.flat_map(|((joint, motion), response)| contact_answer(joint, motion, response));
        let clearances = motions.iter().zip(memories).map(|(motion, memory)| worn_clearance(motion, memory));
        Answer {
            equations: evaluate(Entry::Derivative, &question),
            contacts: contacts.collect(),
            clearances: clearances.collect(),
            totals: responses.iter().flat_map(total_rates).collect(),
            responses,
        }
    }

    /// The derivative of a flat state, laws of contact in the middle. In: parameters and what may stand behind them, memories.
    pub(super) fn slope<T: Scalar>(
        &self,
        evaluate: Evaluate<'_, T>,
        (arena, memory): (&[T], &[T]),
        t: T,
        state: &[T],
    ) -> Slope<T> {
        self.slope_of(self.answer(evaluate, &self.ask(arena, t, state), memory))
    }

    /// The derivative of a flat state by an answer.
    pub(super) fn slope_of<T: Scalar>(&self, answer: Answer<T>) -> Slope<T> {
        let (rates, rest) = answer.equations.split_at(self.sizes.coordinates + self.sizes.speeds);
        let (rest, powers) = rest.split_at(rest.len() - WORKS);
        let (forces, pivots) = rest.split_at(rest.len() - self.sizes.rows);
        Slope {
            state: [rates, powers, &answer.totals].concat(),
            forces: forces.to_vec(),
            pivots: pivots.to_vec(),
            responses: answer.responses,
            contacts: answer.contacts,
            clearances: answer.clearances,
        }
    }
}
