//! Packs the values of a tape into as few registers as their lifetimes allow.
//! In: a tape. Out: a register per value. Serves the interpreter's cache.

use crate::operation::{Operand, Value};
use crate::tape::{Statement, Tape};

/// Which register each value lives in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Registers {
    /// Register of every value.
    pub of_value: Vec<u32>,
    /// Number of registers.
    pub count: u32,
}

impl Registers {
    /// One for every value.
    pub fn of_values(tape: &Tape) -> Self {
        Self { of_value: (0..tape.values).collect(), count: tape.values }
    }

    /// Assigns registers in statement order; a register is free again after its value's last use.
    pub fn assign(tape: &Tape) -> Self {
        let last_use = last_uses(tape);
        let mut of_value = vec![0; tape.values as usize];
        let mut free: Vec<u32> = Vec::new();
        let (mut count, mut ending) = (0, Vec::new());
        for (at, statement) in tape.statements.iter().enumerate() {
            for value in statement.results() {
                of_value[value as usize] = free.pop().unwrap_or_else(|| {
                    count += 1;
                    count - 1
                });
            }
            // Freed after the results are placed: an operation never overwrites its own operands.
            ending.clear();
            ending.extend(touched(statement).filter(|value| last_use[*value as usize] == at));
            ending.sort_unstable();
            ending.dedup();
            free.extend(ending.iter().map(|value| of_value[*value as usize]));
        }
        Self { of_value, count }
    }
}

/// Values that a statement reads or defines.
fn touched(statement: &Statement) -> impl Iterator<Item = Value> {
    let read = statement.op.operands().filter_map(|operand| match operand {
        Operand::Value(value) => Some(value),
        _ => None,
    });
    read.chain(statement.results())
}

/// Statement of the last use of every value; its own where nothing uses it later.
fn last_uses(tape: &Tape) -> Vec<usize> {
    let mut last = vec![0; tape.values as usize];
    for (at, statement) in tape.statements.iter().enumerate() {
        for value in touched(statement) {
            last[value as usize] = at;
        }
    }
    last
}
