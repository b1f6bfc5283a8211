//! Checks that a tape makes sense: values defined before use, every output written once.
//! In: a tape. Out: a defect, if there is one. Runs in tests and debug builds after every stage.

use super::{Operand, Tape};

/// What is wrong with a tape.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Defect {
    /// A statement reads a value that no earlier statement defines.
    UsedBeforeDefined {
        /// Index of the statement.
        statement: usize,
    },
    /// An input beyond the flat input.
    UnknownInput {
        /// Index of the statement.
        statement: usize,
    },
    /// An output is written this many times instead of once.
    OutputWritten {
        /// Index in the flat output.
        output: usize,
        /// Number of stores.
        times: usize,
    },
}

/// Verifies a tape.
///
/// # Errors
/// The first defect found.
pub fn verify(tape: &Tape) -> Result<(), Defect> {
    let mut defined = 0;
    let mut written = vec![0_usize; tape.output_len()];
    let check = |operand: Operand, defined: u32, statement: usize| match operand {
        Operand::Value(value) if value >= defined => Err(Defect::UsedBeforeDefined { statement }),
        Operand::Input(index) if index as usize >= tape.input_len() => {
            Err(Defect::UnknownInput { statement })
        }
        _ => Ok(()),
    };
    for (index, operand) in &tape.direct {
        check(*operand, 0, 0)?;
        written[*index as usize] += 1;
    }
    for (at, statement) in tape.statements.iter().enumerate() {
        for operand in statement.op.operands() {
            check(operand, defined, at)?;
        }
        defined = statement.results().end;
        for (index, operand) in &statement.stores {
            check(*operand, defined, at)?;
            written[*index as usize] += 1;
        }
    }
    match written.iter().position(|times| *times != 1) {
        Some(output) => Err(Defect::OutputWritten { output, times: written[output] }),
        None => Ok(()),
    }
}
