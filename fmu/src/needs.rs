//! What a parameter has a say in. In: tapes. Out: whether it belongs to a start.

use linkwear_runtime::{CONTACT_MOTION, Entry, InputRole};
use linkwear_tape::{Operand, Program, Tape};

/// For every parameter, whether drivers, loops or the guess of a start depend on it: a mechanism under way would have to be
/// assembled anew.
pub fn belongs_to_start(program: &Program) -> Vec<bool> {
    let parameters = program.sizes().parameters;
    let mut belongs = vec![false; parameters];
    for entry in [Entry::Prescribed, Entry::Start, Entry::Closure] {
        for (belongs, needed) in
            belongs.iter_mut().zip(needed_inputs(&program.tapes()[entry as usize], usize::MAX))
        {
            *belongs |= needed;
        }
    }
    belongs
}

/// For every parameter, whether it is an input that a drive follows, or a rate of one.
pub fn leads_drives(program: &Program) -> Vec<bool> {
    let description = program.description();
    let roles = &description.inputs;
    let is_rate = |at: usize| roles.get(at) == Some(&InputRole::RateOfPrevious);
    let mut leads = vec![false; description.tunable()];
    leads.extend((0..roles.len()).map(|at| is_rate(at) || is_rate(at + 1)));
    leads
}

/// For every parameter, whether the motion of journals in their bearings depends on it, as it does on a clearance: contacts under way
/// would have to follow.
pub fn belongs_to_contacts(program: &Program) -> Vec<bool> {
    let sizes = program.sizes();
    let motions = CONTACT_MOTION * sizes.contacts;
    let needed = needed_inputs(&program.tapes()[Entry::Contacts as usize], motions);
    (0..sizes.parameters).map(|index| needed.get(index).is_some_and(|needed| *needed)).collect()
}

/// For every input of a tape, whether one of the first so many outputs depends on it.
fn needed_inputs(tape: &Tape, outputs: usize) -> Vec<bool> {
    let counts = |output: u32| (output as usize) < outputs;
    let mut inputs = vec![false; tape.input_len()];
    let mut values = vec![false; tape.values as usize];
    let mut need = |operand: Operand, values: &mut Vec<bool>| match operand {
        Operand::Input(index) => inputs[index as usize] = true,
        Operand::Value(value) => values[value as usize] = true,
        Operand::Constant(_) => {}
    };
    let direct = tape.direct.iter().filter(|(output, _)| counts(*output));
    direct.for_each(|(_, operand)| need(*operand, &mut values));
    for statement in tape.statements.iter().rev() {
        let stores = statement.stores.iter().filter(|(output, _)| counts(*output));
        stores.for_each(|(_, operand)| need(*operand, &mut values));
        if statement.results().any(|value| values[value as usize]) {
            statement.op.operands().for_each(|operand| need(operand, &mut values));
        }
    }
    inputs
}
