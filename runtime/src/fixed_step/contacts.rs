//! Joints with clearance of a step: laws at a state, and what contacts remember from step to step. In: states. Out: wrenches in the
//! question, [`ANSWER`] numbers a joint. Never knows methods.

use super::FixedStep;
use super::storage::{ANSWER, MEMORY, Storage};
use crate::contact::{ImpactMemory, Support, crossing_speed};
use crate::joint_laws::{JointLaws, Response};
use crate::system::{CONTACT_MOTION, CONTACT_WRENCH, Entry, System};
use crate::wear::Step;

/// A contact at one state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepContact {
    /// Penetration, negative while the bodies are apart [m].
    pub penetration: f64,
    /// Its rate [m/s].
    pub penetration_rate: f64,
    /// Normal force [N].
    pub normal_force: f64,
    /// Rate of the wear integral, F_n |v_t| [W].
    pub wear_power: f64,
    /// Rate of the depth by the joint's contact area [m/s]; zero if it does not wear.
    pub depth_rate: f64,
    /// Power lost in damping and friction [W].
    pub loss: f64,
}

impl StepContact {
    fn of(answer: &[f64; ANSWER]) -> Self {
        let [wear_power, depth_rate, normal_force, loss, penetration, penetration_rate] = *answer;
        Self { penetration, penetration_rate, normal_force, wear_power, depth_rate, loss }
    }
}

impl<S: System<f64>> FixedStep<'_, S> {
    /// A joint with clearance as [`Self::begin`], [`Self::step`], [`Self::rates`] or [`Self::observe`] saw it last; nothing if there is
    /// no such joint.
    pub fn contact(&self, joint: usize) -> Option<StepContact> {
        self.storage.answers.as_chunks::<ANSWER>().0.get(joint).map(StepContact::of)
    }

    /// Evaluates the contacts at a flat state; their wrenches and motion are then in the question.
    pub(super) fn evaluate_contacts(&mut self, parameters: &[f64], t: f64, y: &[f64]) {
        self.fill(parameters, t, y);
        let state_end = self.sizes.input(Entry::Contacts);
        let wrenches = CONTACT_WRENCH * self.sizes.contacts;
        let Storage { question, worn, memories, answers, workspace, .. } = &mut self.storage;
        let (state, rest) = question.split_at_mut(state_end);
        let (wrenches, moved) = rest.split_at_mut(wrenches);
        self.system.evaluate(Entry::Contacts, state, moved, workspace);
        let (motions, _) = moved.as_chunks::<CONTACT_MOTION>();
        let places = wrenches.as_chunks_mut::<CONTACT_WRENCH>().0.iter_mut();
        let places = places.zip(answers.as_chunks_mut::<ANSWER>().0);
        let remembered = worn.iter().zip(memories.as_chunks::<MEMORY>().0);
        let asked = self.laws.iter().flatten().zip(motions).zip(remembered);
        for (joint, ((wrench, answer), ((laws, motion), (worn, memory)))) in places.zip(asked).enumerate() {
            let [touching, closing_speed] = *memory;
            let memory = ImpactMemory { touching, closing_speed };
            let factor = self.all.coefficients.iter().find(|(of, _)| *of == joint).map(|(_, steps)| *steps);
            let clearance = motion[CONTACT_MOTION - 1] + worn;
            let support = |offset| Support::round(offset, clearance);
            let response = laws.respond(motion, support, (clearance, laws.stiffness(clearance)), &memory);
            let response = match factor {
                Some(steps) => with_factor(laws, steps, response, motion),
                None => response,
            };
            *wrench = response.wrench;
            *answer = [
                response.wear_power,
                response.depth_rate,
                response.normal_force,
                response.loss,
                response.penetration,
                response.penetration_rate,
            ];
        }
    }

    /// Contacts that nobody has followed so far: those that touch take their present rate.
    pub(super) fn begin_contacts(&mut self) {
        self.update(|_, now| now[1]);
    }

    /// Notes how deep contacts are at the beginning of a step.
    pub(super) fn note_depths(&mut self) {
        let Storage { depths, answers, .. } = &mut self.storage;
        for (depth, answer) in depths.as_chunks_mut::<2>().0.iter_mut().zip(answers.as_chunks::<ANSWER>().0) {
            *depth = [answer[4], answer[5]];
        }
    }

    /// Brings memories up to date at the end of a step. A gap that closed within it remembers the speed at the crossing.
    pub(super) fn remember_contacts(&mut self) {
        self.update(|before, now| crossing_speed((before[0], before[1]), (now[0], now[1])));
    }

    fn update(&mut self, speed: impl Fn([f64; 2], [f64; 2]) -> f64) {
        let Storage { memories, depths, answers, .. } = &mut self.storage;
        let seen = depths.as_chunks::<2>().0.iter().zip(answers.as_chunks::<ANSWER>().0);
        for (place, (before, answer)) in memories.as_chunks_mut::<MEMORY>().0.iter_mut().zip(seen) {
            let [touching, closing_speed] = *place;
            let now = [answer[4], answer[5]];
            let ImpactMemory { touching, closing_speed } =
                ImpactMemory { touching, closing_speed }.updated(now[0], speed(*before, now));
            *place = [touching, closing_speed];
        }
    }
}

/// Out of line: its steps take 8 kB of stack, which most mechanisms have no need of.
#[inline(never)]
fn with_factor(
    laws: &JointLaws,
    steps: &[Step],
    response: Response<f64>,
    motion: &[f64; CONTACT_MOTION],
) -> Response<f64> {
    laws.with_factor(steps, response, motion)
}
