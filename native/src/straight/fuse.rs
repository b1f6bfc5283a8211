//! Parts of a plan of steps as functions of their own, from tapes. In: the tapes of all entries, a plan. Out: [`Lowered`]. Never knows
//! what is computed: it is the runtime's, run on numbers that write down what is done with them.

use std::cell::RefCell;

use linkwear_runtime::{Entry, Evaluate, StageSum, StepPlan};
use linkwear_tape::{Tapes, verify};

use super::lower::Lowered;
use super::number::{Number, Recorder};

/// A part of a plan that is a function of its own.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Part {
    /// [`linkwear_runtime::Bundle::step`].
    Step,
    /// [`linkwear_runtime::Bundle::conclude`].
    Conclude,
    /// [`linkwear_runtime::WithLaws::derivative`].
    Derivative,
    /// [`linkwear_runtime::ClassicalStep`].
    WholeStep(StageSum),
}

impl Part {
    /// What messages call it.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Step => "step",
            Self::Conclude => "conclude",
            Self::Derivative => "derivative",
            Self::WholeStep(_) => "whole_step",
        }
    }
}

/// What plans ask for.
const PLANNED: [Entry; 4] = [Entry::Closure, Entry::Energy, Entry::Contacts, Entry::Derivative];

/// What a part of a plan asks for.
///
/// # Errors
/// A tape's first defect, or that there is none.
pub(crate) fn fuse(tapes: &dyn Tapes, plan: &StepPlan, part: Part) -> Result<Lowered, String> {
    for entry in PLANNED {
        let tape = tapes.tape(entry).ok_or_else(|| format!("there is no tape of `{}`", entry.name()))?;
        verify(tape)?;
    }
    let recorder = Recorder::default();
    let answers = RefCell::default();
    let evaluate: Evaluate<'_, Number<'_>> = &|entry, input| ask(tapes, &answers, entry, input);
    let count = match part {
        Part::Step => plan.step_question(),
        Part::Conclude => plan.conclude_question(),
        Part::Derivative => plan.derivative_question(),
        Part::WholeStep(_) => plan.classical_step_question(),
    };
    let inputs = inputs(&recorder, count);
    let outputs = match part {
        Part::Step => plan.step(evaluate, &inputs),
        Part::Conclude => plan.conclude(evaluate, &inputs),
        Part::Derivative => plan.derivative(evaluate, &inputs),
        Part::WholeStep(sum) => plan.classical_step(evaluate, &inputs, sum),
    };
    let (first, outputs) = (recorder.ids(answers.into_inner()), recorder.ids(outputs));
    Ok(Lowered { graph: recorder.into_graph(), inputs: count, first, outputs })
}

fn inputs(recorder: &Recorder, count: usize) -> Vec<Number<'_>> {
    (0..count).map(|index| recorder.input(index as u32)).collect()
}

/// Answers an entry. One answer is computed after the other: taken together, their values would crowd the registers.
fn ask<'g>(
    tapes: &dyn Tapes,
    answers: &RefCell<Vec<Number<'g>>>,
    entry: Entry,
    input: &[Number<'g>],
) -> Vec<Number<'g>> {
    let tape = tapes.tape(entry);
    let answer = tape.map(|tape| tape.evaluate(&|index| input[index as usize])).unwrap_or_default();
    answers.borrow_mut().extend(&answer);
    answer
}
