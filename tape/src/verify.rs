//! Checks that a tape makes sense: values numbered as they come and defined before use, every output written once.
//! In: a tape. Out: a defect, if there is one. Runs in tests and debug builds after every stage.

use crate::operation::{Op, Operand, Unary};
use crate::tape::Tape;

/// Verifies a tape.
///
/// # Errors
/// The first defect found.
pub fn verify(tape: &Tape) -> Result<(), String> {
    let stores: usize = tape.statements.iter().map(|statement| statement.stores.len()).sum();
    if stores + tape.direct.len() < tape.output_len() {
        // Before room is made for them: there may be any number.
        return Err(format!("{} outputs are not all written", tape.output_len()));
    }
    let inputs = tape.inputs.iter().fold(0, |sum: usize, block| sum.saturating_add(block.len()));
    if inputs != tape.input_len() {
        return Err(format!("{inputs} inputs have {} names", tape.input_len()));
    }
    let mut defined = 0;
    let mut written = vec![0_usize; tape.output_len()];
    let check = |operand: Operand, defined: u32| match operand {
        Operand::Value(value) if value >= defined => {
            Err(format!("value {value} is used before it is defined"))
        }
        Operand::Input(index) if index as usize >= tape.input_len() => {
            Err(format!("there is no input {index}"))
        }
        _ => Ok(()),
    };
    let mut write = |index: u32| match written.get_mut(index as usize) {
        Some(times) => {
            *times += 1;
            Ok(())
        }
        None => Err(format!("there is no output {index}")),
    };
    for (index, operand) in &tape.direct {
        check(*operand, 0)?;
        write(*index)?;
    }
    for statement in &tape.statements {
        for operand in statement.op.operands() {
            check(operand, defined)?;
        }
        if let Op::Unary(Unary::Sin | Unary::Cos, _) = statement.op {
            return Err("a sine stands without its cosine".to_owned());
        }
        if statement.section >= tape.sections.len() {
            return Err(format!("there is no section {}", statement.section));
        }
        if statement.first != defined {
            return Err(format!("value {} is defined where {defined} would be next", statement.first));
        }
        defined = statement.results().end;
        for (index, operand) in &statement.stores {
            check(*operand, defined)?;
            write(*index)?;
        }
    }
    if defined != tape.values {
        return Err(format!("{defined} values are defined, not {}", tape.values));
    }
    match written.iter().position(|times| *times != 1) {
        Some(output) => Err(format!("output {output} is written {} times", written[output])),
        None => Ok(()),
    }
}
