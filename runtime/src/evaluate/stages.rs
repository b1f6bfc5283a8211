//! The stages within a step by one call of code that has the laws of contact inside. In: where the step begins. Out: slopes, how regular
//! the loops were. Never knows what a method makes of them.

use crate::clearance_joint::Clearances;
use crate::flat_laws::{StagesPlaces, write_memories};
use crate::linear::replace;
use crate::system::{InnerStages, Sizes, StagesOf, WithLaws};

/// Steps that a run takes before code is written for their stages: to write it takes as long as some thousand derivatives.
const FIRST_STEPS: u32 = 500;

/// What all stages of a step answer.
pub(crate) struct StagesAnswer<'s> {
    /// Slopes of the flat state, one behind the other.
    pub(crate) slopes: &'s [f64],
    /// How regular the loops are at the last stage; the least of all, no number if an answer is infinite or none.
    pub(crate) nearness: f64,
    pub(crate) least_nearness: f64,
    /// The largest value that each pivot has had then.
    pub(crate) grown_pivots: &'s [f64],
}

/// The code, once it is there, and what it needs.
pub(super) struct Stages<'a> {
    laws: &'a dyn WithLaws<f64>,
    /// Steps that went without.
    first: u32,
    code: Option<&'a dyn InnerStages<f64>>,
    places: StagesPlaces,
    question: Vec<f64>,
    answer: Vec<f64>,
    workspace: Vec<f64>,
}

impl<'a> Stages<'a> {
    pub(super) fn new(sizes: &Sizes, laws: &'a dyn WithLaws<f64>) -> Self {
        let places = StagesPlaces::new(sizes);
        let (question, answer, workspace) = (Vec::new(), Vec::new(), Vec::new());
        Self { laws, first: 0, code: None, places, question, answer, workspace }
    }

    /// Evaluates all stages; nothing if there is no code for them, or not yet. Contacts are known where the step begins.
    pub(super) fn evaluate(
        &mut self,
        parameters: &[f64],
        clearances: &Clearances,
        (step, pivots): (&StagesOf<'_>, &[f64]),
    ) -> Option<StagesAnswer<'_>> {
        if self.first < FIRST_STEPS {
            self.first += 1;
            if self.first == FIRST_STEPS {
                self.prepare();
            }
            return None;
        }
        let (code, at) = (self.code?, &self.places);
        let question = &mut self.question[..];
        question[..at.middle].copy_from_slice(parameters);
        [question[at.middle], question[at.end]] = step.times;
        question[at.length] = step.length;
        let state = at.y.len();
        replace(&mut question[at.y.clone()], &step.y[..state]);
        replace(&mut question[at.slope.clone()], &step.slope[..state]);
        write_memories(&mut question[at.memory.clone()], clearances);
        for (clearance, touch) in question[at.clearances.clone()].iter_mut().zip(clearances.contacts()) {
            *clearance = touch.clearance;
        }
        question[at.pivots.clone()].copy_from_slice(pivots);
        code.evaluate(question, &mut self.answer, &mut self.workspace);
        let answer = &self.answer;
        Some(StagesAnswer {
            slopes: &answer[at.slopes.clone()],
            nearness: answer[at.nearness],
            least_nearness: answer[at.least_nearness],
            grown_pivots: &answer[at.grown_pivots.clone()],
        })
    }

    #[cold]
    fn prepare(&mut self) {
        self.code = self.laws.inner_stages();
        if let Some(code) = self.code {
            self.question = vec![0.0; self.places.question()];
            self.answer = vec![0.0; self.places.answer()];
            self.workspace = vec![0.0; code.workspace()];
        }
    }
}
