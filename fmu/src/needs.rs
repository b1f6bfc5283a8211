//! What a parameter has a say in. In: tapes. Out: whether it belongs to a start.

use linkwear_runtime::Entry;
use linkwear_tape::{Operand, Program, Tape};

/// For every parameter, whether drivers, loops or the guess of a start depend on it: a mechanism under way would have to be
/// assembled anew.
pub fn belongs_to_start(program: &Program) -> Vec<bool> {
    let parameters = program.sizes().parameters;
    let mut belongs = vec![false; parameters];
    for entry in [Entry::Prescribed, Entry::Start, Entry::Closure] {
        for (belongs, needed) in belongs.iter_mut().zip(needed_inputs(&program.tapes()[entry as usize])) {
            *belongs |= needed;
        }
    }
    belongs
}

/// For every input of a tape, whether an output depends on it.
fn needed_inputs(tape: &Tape) -> Vec<bool> {
    let mut inputs = vec![false; tape.input_len()];
    let mut values = vec![false; tape.values as usize];
    let mut need = |operand: Operand, values: &mut Vec<bool>| match operand {
        Operand::Input(index) => inputs[index as usize] = true,
        Operand::Value(value) => values[value as usize] = true,
        Operand::Constant(_) => {}
    };
    tape.direct.iter().for_each(|(_, operand)| need(*operand, &mut values));
    for statement in tape.statements.iter().rev() {
        statement.stores.iter().for_each(|(_, operand)| need(*operand, &mut values));
        if statement.results().any(|value| values[value as usize]) {
            statement.op.operands().for_each(|operand| need(operand, &mut values));
        }
    }
    inputs
}
