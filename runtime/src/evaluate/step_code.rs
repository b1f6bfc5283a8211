//! A step by one call of code that has the laws of contact inside. In: where the step begins. Out: its end, if it is one. Never knows
//! whether a run goes on from there.

use crate::clearance_joint::Clearances;
use crate::flat_laws::{StepPlaces, write_memories};
use crate::system::{ClassicalStep, Sizes, StageSum, StepOf, WithLaws};

/// Steps that a run takes before code is written for them: to write it takes as long as some thousand steps.
const FIRST_STEPS: u32 = 500;

/// What may change what a step is, besides where it begins.
#[derive(Clone, Copy)]
pub(crate) struct StepLimits<'s> {
    /// The largest value that each loop pivot has had.
    pub(crate) pivots: &'s [f64],
    /// Factor on how far loops may stay open.
    pub(crate) looseness: f64,
}

/// What a step answers, besides the derivative at its end.
#[derive(Clone, Copy)]
pub(crate) struct StepAnswer<'s> {
    answer: &'s [f64],
    places: &'s StepPlaces,
}

impl<'s> StepAnswer<'s> {
    /// The flat state at the end, with quaternions of unit length.
    pub(crate) fn next(&self) -> &'s [f64] {
        &self.answer[self.places.next.clone()]
    }

    /// Its coordinates as the method has them.
    pub(crate) fn raw(&self) -> &'s [f64] {
        &self.answer[self.places.raw.clone()]
    }

    /// The slope at the last inner stage.
    pub(crate) fn last_slope(&self) -> &'s [f64] {
        &self.answer[self.places.last_slope.clone()]
    }

    /// How regular the loops are at the last inner stage.
    pub(crate) fn nearness(&self) -> f64 {
        self.answer[self.places.nearness]
    }

    /// The least of all inner stages, no number if an answer is infinite or none.
    pub(crate) fn least_nearness(&self) -> f64 {
        self.answer[self.places.least_nearness]
    }

    /// The same at the end.
    pub(crate) fn nearness_at_end(&self) -> f64 {
        self.answer[self.places.nearness_at_end]
    }

    /// The largest value that each pivot has had after the inner stages.
    pub(crate) fn grown_pivots(&self) -> &'s [f64] {
        &self.answer[self.places.grown_pivots.clone()]
    }

    /// Whether loops are closed at the end such that nothing has to be moved.
    pub(crate) fn is_untouched(&self) -> bool {
        self.answer[self.places.is_untouched] > 0.5
    }

    /// Squares of the lengths of the Jacobian's rows there.
    pub(super) fn row_squares(&self) -> &'s [f64] {
        &self.answer[self.places.row_squares.clone()]
    }

    /// Residuals of all rows there.
    pub(crate) fn residuals(&self) -> &'s [f64] {
        &self.answer[self.places.residuals.clone()]
    }

    /// Kinetic and potential energy there [J].
    pub(super) fn energy(&self) -> [f64; 2] {
        let energy = &self.answer[self.places.energy.clone()];
        [energy[0], energy[1]]
    }
}

/// The code, once it is there, and what it needs.
pub(super) struct StepCode<'a> {
    laws: &'a dyn WithLaws<f64>,
    /// Steps that went without.
    first: u32,
    /// It, and how it sums.
    code: Option<(&'a dyn ClassicalStep<f64>, StageSum)>,
    places: StepPlaces,
    question: Vec<f64>,
    workspace: Vec<f64>,
}

impl<'a> StepCode<'a> {
    pub(super) fn new(sizes: &Sizes, laws: &'a dyn WithLaws<f64>) -> Self {
        let (question, workspace) = (Vec::new(), Vec::new());
        Self { laws, first: 0, code: None, places: StepPlaces::new(sizes), question, workspace }
    }

    /// Evaluates a step; not if there is no code for it, or not yet. Contacts are known where it begins. The answer begins with that of a
    /// derivative at the end.
    pub(super) fn evaluate(
        &mut self,
        parameters: &[f64],
        clearances: &Clearances,
        (step, limits): (&StepOf<'_>, StepLimits<'_>),
        answer: &mut Vec<f64>,
    ) -> bool {
        if self.first < FIRST_STEPS {
            self.first += 1;
            if self.first == FIRST_STEPS {
                self.prepare(step.sum, parameters, answer);
            }
            return false;
        }
        let (Some((code, sum)), at) = (self.code, &self.places) else { return false };
        if step.sum != sum {
            return false;
        }
        let question = &mut self.question[..];
        [question[at.middle], question[at.end]] = step.times;
        question[at.length] = step.length;
        question[at.y.clone()].copy_from_slice(step.y);
        question[at.slope.clone()].copy_from_slice(step.slope);
        write_memories(&mut question[at.memory.clone()], clearances);
        for (clearance, touch) in question[at.clearances.clone()].iter_mut().zip(clearances.contacts()) {
            *clearance = touch.clearance;
        }
        question[at.pivots.clone()].copy_from_slice(limits.pivots);
        question[at.looseness] = limits.looseness;
        code.evaluate(question, answer, &mut self.workspace);
        true
    }

    /// Other values of the parameters.
    pub(super) fn set_parameters(&mut self, parameters: &[f64]) {
        if self.code.is_some() {
            self.question[..parameters.len()].copy_from_slice(parameters);
        }
    }

    /// What was answered.
    pub(super) fn answer<'s>(&'s self, answer: &'s [f64]) -> StepAnswer<'s> {
        StepAnswer { answer, places: &self.places }
    }

    #[cold]
    fn prepare(&mut self, sum: StageSum, parameters: &[f64], answer: &mut Vec<f64>) {
        self.code = self.laws.classical_step(sum).map(|code| (code, sum));
        if let Some((code, _)) = self.code {
            self.question = vec![0.0; self.places.question()];
            self.question[..self.places.middle].copy_from_slice(parameters);
            answer.resize(self.places.answer(), 0.0);
            self.workspace = vec![0.0; code.workspace()];
        }
    }
}
