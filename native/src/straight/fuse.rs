//! The derivative of a flat state as one function, laws of contact in the middle. In: the tapes of contacts and derivative, laws.
//! Out: [`Lowered`]. Never knows what the laws say: they are the runtime's, run on numbers that write down what is done with them.

use linkwear_codegen::tape::{Tape, verify};
use linkwear_runtime::clearance_joint::Clearance;
use linkwear_runtime::{
    CONTACT_MEMORY, CONTACT_MOTION, Entry, Sizes, WORKS, contact_answer, round_response, total_rates,
};

use super::lower::{Lowered, run};
use super::number::Recorder;

/// What [`linkwear_runtime::Bundle::derivative`] asks for; `tapes` are those of all entries.
///
/// # Errors
/// A tape's first defect.
pub(crate) fn fuse(tapes: &[Tape], sizes: Sizes, joints: &[Clearance]) -> Result<Lowered, String> {
    let [contacts, derivative] = [Entry::Contacts, Entry::Derivative].map(|entry| &tapes[entry as usize]);
    verify(contacts)?;
    verify(derivative)?;
    let recorder = Recorder::default();
    let state = sizes.input(Entry::Contacts);
    let input = |index: usize| recorder.input(index as u32);
    let moved = run(contacts, &|index| recorder.input(index));
    let (motions, _) = moved.as_chunks::<CONTACT_MOTION>();
    let respond = |(joint, clearance): (usize, &Clearance)| {
        let memory = std::array::from_fn(|at| input(state + CONTACT_MEMORY * joint + at));
        round_response(clearance, &motions[joint], memory)
    };
    let responses: Vec<_> = joints.iter().enumerate().map(respond).collect();
    let mut question: Vec<_> = (0..state).map(input).collect();
    question.extend(responses.iter().flat_map(|response| response.wrench));
    question.extend(&moved);
    let answer = run(derivative, &|index| question[index as usize]);
    let (rates, forces) = answer.split_at(sizes.coordinates + sizes.speeds);
    let (forces, powers) = forces.split_at(forces.len() - WORKS);
    let totals: Vec<_> = responses.iter().flat_map(total_rates).collect();
    let each = joints.iter().zip(motions).zip(&responses);
    let contacts: Vec<_> =
        each.flat_map(|((joint, motion), response)| contact_answer(joint, motion, response)).collect();
    let outputs = [rates, powers, &totals, forces, &contacts].concat();
    let outputs = outputs.into_iter().map(|output| recorder.id(output)).collect();
    Ok(Lowered { graph: recorder.into_graph(), inputs: sizes.bundle_question(), outputs })
}
