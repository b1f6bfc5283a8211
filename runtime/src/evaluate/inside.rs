//! A derivative by one call of code that has the laws of contact inside. In: a state, what contacts remember. Out: the derivative,
//! the contacts. Never knows which states follow each other.

use super::step_code::StepCode;
use crate::clearance_joint::{Clearances, ContactState};
use crate::flat_laws::{CONTACT_MEMORY, LawsPlaces, contact_state, write_memories};
use crate::system::{Entry, Sizes, TOTALS, WithLaws};

/// The code, and what it needs.
pub(super) struct Inside<'a> {
    code: &'a dyn WithLaws<f64>,
    /// Where the state ends and memories begin, and where these end.
    state_end: usize,
    memories_end: usize,
    places: LawsPlaces,
    workspace: Vec<f64>,
    pub(super) step: StepCode<'a>,
}

impl<'a> Inside<'a> {
    pub(super) fn new(sizes: Sizes, code: &'a dyn WithLaws<f64>) -> Self {
        let state_end = sizes.input(Entry::Contacts);
        Self {
            code,
            state_end,
            memories_end: state_end + CONTACT_MEMORY * sizes.contacts,
            places: LawsPlaces::new(&sizes),
            workspace: vec![0.0; code.workspace()],
            step: StepCode::new(&sizes, code),
        }
    }

    /// Length of its answer.
    pub(super) fn answer(&self) -> usize {
        self.places.all()
    }

    /// Evaluates a state, the question of [`Entry::Contacts`] with room for memories behind it. Whether the answer counts: stiffnesses
    /// are those of the contacts known, and a clearance may be another one.
    pub(super) fn derivative(
        &mut self,
        question: &mut [f64],
        answer: &mut [f64],
        clearances: &mut Clearances,
    ) -> bool {
        write_memories(&mut question[self.state_end..self.memories_end], clearances);
        self.code.derivative(&question[..self.memories_end], answer, &mut self.workspace);
        let known = clearances.contacts().iter().zip(&answer[self.places.clearances.clone()]);
        let is_known = |(touch, clearance): (&ContactState, &f64)| {
            touch.stiffness > 0.0 && touch.clearance.to_bits() == clearance.to_bits()
        };
        if !known.into_iter().all(is_known) {
            return false;
        }
        self.take_contacts(answer, clearances);
        true
    }

    /// The contacts become those of an answer.
    pub(super) fn take_contacts(&self, answer: &[f64], clearances: &mut Clearances) {
        let (totals, _) = answer[self.places.totals.clone()].as_chunks::<TOTALS>();
        let (contacts, _) = answer[self.places.contacts.clone()].as_chunks();
        clearances.take_over(|joint, before| contact_state(before, totals[joint], contacts[joint]));
    }
}
