//! Both parts of a step as functions of their own, from tapes. In: the tapes of all entries, a plan. Out: [`Lowered`]. Never knows
//! what is computed: it is the runtime's, run on numbers that write down what is done with them.

use std::cell::RefCell;

use linkwear_runtime::{Entry, StepPlan};
use linkwear_tape::{Tape, verify};

use super::lower::{Lowered, run};
use super::number::{Number, Recorder};

/// What [`linkwear_runtime::Bundle::attempt`] asks for; `tapes` are those of all entries.
///
/// # Errors
/// A tape's first defect.
pub(crate) fn attempt(tapes: &[Tape], plan: &StepPlan) -> Result<Lowered, String> {
    tapes.iter().try_for_each(verify)?;
    let recorder = Recorder::default();
    let answers = RefCell::default();
    let inputs = inputs(&recorder, plan.question());
    let outputs = plan.attempt(&|entry, input| ask(tapes, &answers, entry, input), &inputs);
    let (first, outputs) = (recorder.ids(answers.into_inner()), recorder.ids(outputs));
    Ok(Lowered { graph: recorder.into_graph(), inputs: plan.question(), first, outputs })
}

/// What [`linkwear_runtime::Bundle::conclude`] asks for.
///
/// # Errors
/// As [`attempt`].
pub(crate) fn conclude(tapes: &[Tape], plan: &StepPlan) -> Result<Lowered, String> {
    tapes.iter().try_for_each(verify)?;
    let recorder = Recorder::default();
    let answers = RefCell::default();
    let inputs = inputs(&recorder, plan.arena());
    let outputs = plan.conclude(&|entry, input| ask(tapes, &answers, entry, input), &inputs);
    let (first, outputs) = (recorder.ids(answers.into_inner()), recorder.ids(outputs));
    Ok(Lowered { graph: recorder.into_graph(), inputs: plan.arena(), first, outputs })
}

fn inputs(recorder: &Recorder, count: usize) -> Vec<Number<'_>> {
    (0..count).map(|index| recorder.input(index as u32)).collect()
}

/// Answers an entry. One answer is computed after the other: taken together, their values would crowd the registers.
fn ask<'g>(
    tapes: &[Tape],
    answers: &RefCell<Vec<Number<'g>>>,
    entry: Entry,
    input: &[Number<'g>],
) -> Vec<Number<'g>> {
    let answer = run(&tapes[entry as usize], &|index| input[index as usize]);
    answers.borrow_mut().extend(&answer);
    answer
}
