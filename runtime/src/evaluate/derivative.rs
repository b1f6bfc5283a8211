//! What a state does next, contacts in the middle: the system tells how journals move, the laws answer, the system goes on.
//! In: states, laws. Out: rates, forces and powers where the system wrote them. Nothing is copied on the way, and nothing
//! asked twice at the same state.

use super::answers::Forward;
use super::inside::Inside;
use super::questions::Questions;
use super::step_code::{StepAnswer, StepLimits};
use crate::clearance_joint::Clearances;
use crate::linear::{replace, same_bits};
use crate::system::{CONTACT_MOTION, Entry, Sizes, StepOf, WORKS, WithLaws};

/// An answer of [`Entry::Derivative`], by a number that no other of the same evaluator has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Known(u64);

/// The last answer of [`Entry::Derivative`] with its input.
pub(super) struct Derivative<'a> {
    sizes: Sizes,
    /// Code with the laws inside, if the system has it.
    inside: Option<Inside<'a>>,
    /// Parameters, time, coordinates, speeds; wrenches; the answer of the contacts.
    input: Vec<f64>,
    /// Where time, coordinates, speeds end and wrenches begin, and where these end.
    state_end: usize,
    wrenches_end: usize,
    output: Vec<f64>,
    /// Whether the motions of journals are those at the state of the input.
    has_motions: bool,
    /// Whether the contacts are.
    has_contacts: bool,
    /// Whether the output is the system's answer to the input.
    has_answer: bool,
    /// How often the output was written.
    answers: u64,
    /// Kinetic and potential energy at the state of the input [J], if they came with it.
    energy: Option<[f64; 2]>,
}

impl<'a> Derivative<'a> {
    pub(super) fn new(sizes: Sizes, laws: Option<&'a dyn WithLaws<f64>>, parameters: &[f64]) -> Self {
        let inside = laws.map(|code| Inside::new(sizes, code));
        let output = sizes.output(Entry::Derivative).max(inside.as_ref().map_or(0, Inside::answer));
        let mut input = vec![0.0; sizes.input(Entry::Derivative)];
        input[..parameters.len()].copy_from_slice(parameters);
        Self {
            sizes,
            inside,
            input,
            state_end: sizes.input(Entry::Contacts),
            wrenches_end: sizes.input(Entry::ForwardDynamics),
            output: vec![0.0; output],
            has_motions: false,
            has_contacts: false,
            has_answer: false,
            answers: 0,
            energy: None,
        }
    }

    /// Evaluates the contacts at a state.
    pub(super) fn contacts(
        &mut self,
        questions: &mut Questions<'_>,
        clearances: &mut Clearances,
        (t, q, v): (f64, &[f64], &[f64]),
    ) {
        let known = self.move_to(questions, (t, q, v));
        if known && self.has_contacts && !clearances.has_changed() {
            return;
        }
        if !known {
            // It costs no more than motions and laws one after the other, and who asks for contacts mostly asks for accelerations next.
            if self.answer_inside(clearances) {
                return;
            }
        }
        let (state, answers) = self.input.split_at_mut(self.state_end);
        let (wrenches, contacts) = answers.split_at_mut(self.wrenches_end - self.state_end);
        if !self.has_motions {
            let Questions { system, workspace, .. } = questions;
            system.evaluate(Entry::Contacts, state, contacts, workspace);
            self.has_motions = true;
        }
        self.has_contacts = true;
        clearances.evaluate(&contacts[..CONTACT_MOTION * self.sizes.contacts]);
        // What contacts remember, and how far they are worn, changes at the same state.
        self.has_answer &= replace(wrenches, clearances.wrenches());
    }

    /// Other values of the parameters.
    pub(super) fn set_parameters(&mut self, parameters: &[f64]) {
        self.input[..parameters.len()].copy_from_slice(parameters);
        if let Some(inside) = &mut self.inside {
            inside.step.set_parameters(parameters);
        }
        self.forget();
    }

    /// Contacts were put in place of those at the state of the input.
    pub(super) fn forget(&mut self) {
        (self.has_motions, self.has_contacts, self.has_answer) = (false, false, false);
        self.energy = None;
    }

    /// Evaluates everything at a state.
    pub(super) fn evaluate(
        &mut self,
        questions: &mut Questions<'_>,
        clearances: &mut Clearances,
        (t, q, v): (f64, &[f64], &[f64]),
    ) {
        if self.sizes.contacts > 0 {
            self.contacts(questions, clearances, (t, q, v));
        } else {
            self.move_to(questions, (t, q, v));
        }
        if !self.has_answer {
            let Questions { system, workspace, .. } = questions;
            let output = &mut self.output[..self.sizes.output(Entry::Derivative)];
            system.evaluate(Entry::Derivative, &self.input, output, workspace);
            self.has_answer = true;
            self.answers += 1;
        }
    }

    /// Everything at the state of the input by one call. Whether that is what the laws say: not before stiffnesses are known.
    fn answer_inside(&mut self, clearances: &mut Clearances) -> bool {
        let Some(inside) = &mut self.inside else { return false };
        let done = inside.derivative(&mut self.input[..self.wrenches_end], &mut self.output, clearances);
        self.answers += 1;
        if done {
            replace(&mut self.input[self.state_end..self.wrenches_end], clearances.wrenches());
            (self.has_contacts, self.has_answer) = (true, true);
        }
        done
    }

    /// The output, if it is the answer to the input.
    pub(super) fn known(&self) -> Option<Known> {
        self.has_answer.then_some(Known(self.answers))
    }

    /// Whether it was there, so that what is known still holds.
    fn move_to(&mut self, questions: &mut Questions<'_>, (t, q, v): (f64, &[f64], &[f64])) -> bool {
        if (self.has_contacts || self.has_answer) && self.is_at((t, q, v)) {
            return true;
        }
        put(&mut self.input[self.sizes.parameters..self.state_end], (t, q, v));
        let inputs = questions.inputs.clone();
        if !inputs.is_empty() {
            self.input[inputs].copy_from_slice(questions.inputs_at(t));
        }
        self.forget();
        false
    }

    /// Whether this is the state of the input.
    pub(super) fn is_at(&self, (t, q, v): (f64, &[f64], &[f64])) -> bool {
        let (time, state) = self.input[self.sizes.parameters..self.state_end].split_at(1);
        let (coordinates, speeds) = state.split_at(q.len());
        time[0].to_bits() == t.to_bits() && same_bits(coordinates, q) && same_bits(speeds, v)
    }

    /// Energies at the state of the input, if they came with it.
    pub(super) fn energy(&self) -> Option<[f64; 2]> {
        self.energy
    }

    /// See [`super::Evaluator::classical_step`].
    pub(super) fn classical_step(
        &mut self,
        parameters: &[f64],
        clearances: &Clearances,
        step: (&StepOf<'_>, StepLimits<'_>),
    ) -> bool {
        let Some(inside) = &mut self.inside else { return false };
        let done = inside.step.evaluate(parameters, clearances, step, &mut self.output);
        self.has_answer &= !done;
        self.answers += u64::from(done);
        done
    }

    /// See [`super::Evaluator::last_step`].
    pub(super) fn last_step(&self) -> Option<StepAnswer<'_>> {
        self.inside.as_ref().map(|inside| inside.step.answer(&self.output))
    }

    /// See [`super::Evaluator::go_to_end`].
    pub(super) fn go_to_end(&mut self, clearances: &mut Clearances, t: f64) {
        let Some(inside) = &self.inside else { return };
        let step = inside.step.answer(&self.output);
        inside.take_contacts(&self.output, clearances);
        let (q, rest) = step.next().split_at(self.sizes.coordinates);
        let (state, wrenches) = self.input[self.sizes.parameters..self.wrenches_end]
            .split_at_mut(self.state_end - self.sizes.parameters);
        // Written long ago: it may be read at once, however it was written.
        state[0] = t;
        state[1..=q.len()].copy_from_slice(q);
        state[1 + q.len()..].copy_from_slice(&rest[..self.sizes.speeds]);
        wrenches.copy_from_slice(clearances.wrenches());
        (self.has_motions, self.has_contacts, self.has_answer) = (false, true, true);
        self.energy = Some(step.energy());
    }

    /// Accelerations, multipliers, drive forces, pivots.
    pub(super) fn forward(&self) -> Forward<'_> {
        let (accelerations, rest) = self.output[self.sizes.coordinates..].split_at(self.sizes.speeds);
        let (multipliers, rest) = rest.split_at(self.sizes.rows);
        let (drives, rest) = rest.split_at(self.sizes.drivers);
        Forward { accelerations, multipliers, drives, pivots: &rest[..self.sizes.rows] }
    }

    /// Accelerations, multipliers and drive forces, one behind the other.
    pub(super) fn solution(&self) -> &[f64] {
        let Sizes { coordinates, speeds, rows, drivers, .. } = self.sizes;
        &self.output[coordinates..coordinates + speeds + rows + drivers]
    }

    /// Loop pivots.
    pub(super) fn pivots(&self) -> &[f64] {
        let Sizes { coordinates, speeds, rows, drivers, .. } = self.sizes;
        &self.output[coordinates + speeds + rows + drivers..][..rows]
    }

    /// All of it, to be written to: it is then no answer of the system any more.
    pub(super) fn forward_mut(&mut self) -> &mut [f64] {
        self.has_answer = false;
        self.answers += 1;
        &mut self.output[self.sizes.coordinates..][..self.sizes.output(Entry::ForwardDynamics)]
    }

    /// Rates of the coordinates, then accelerations; power supplied and dissipated. Nothing where forces were put in place of
    /// the system's.
    pub(super) fn rates(&self) -> Option<(&[f64], [f64; 2])> {
        let state = &self.output[..self.sizes.coordinates + self.sizes.speeds];
        let powers = self.sizes.output(Entry::Derivative) - WORKS;
        self.has_answer.then(|| (state, [self.output[powers], self.output[powers + 1]]))
    }
}

/// Writes time, coordinates and speeds one behind the other.
fn put(state: &mut [f64], (t, q, v): (f64, &[f64], &[f64])) {
    let (time, state) = state.split_at_mut(1);
    let (coordinates, speeds) = state.split_at_mut(q.len());
    time[0] = t;
    replace(coordinates, q);
    replace(speeds, v);
}
