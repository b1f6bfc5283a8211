//! What outputs need of a tape's statements. In: a tape, where outputs are found. Out: the tape without the rest.

use crate::operation::{Op, Operand, Value};
use crate::tape::{Statement, Tape};

impl Tape {
    /// Has these as its outputs, and no statement that none of them needs.
    pub(crate) fn keep_needed(&mut self, outputs: &[Operand]) {
        let mut needed = vec![false; self.values as usize];
        let need = |operand: Operand, needed: &mut Vec<bool>| {
            if let Operand::Value(value) = operand {
                needed[value as usize] = true;
            }
        };
        outputs.iter().for_each(|output| need(*output, &mut needed));
        let mut kept = vec![false; self.statements.len()];
        for (place, statement) in self.statements.iter().enumerate().rev() {
            kept[place] = statement.results().any(|value| needed[value as usize]);
            if kept[place] {
                statement.op.operands().for_each(|operand| need(operand, &mut needed));
            }
        }
        let mut next: Value = 0;
        let mut renamed: Vec<Value> = vec![0; self.values as usize];
        let mut statements = Vec::new();
        for (statement, _) in
            std::mem::take(&mut self.statements).into_iter().zip(kept).filter(|(_, kept)| *kept)
        {
            let results = statement.results();
            let op = statement.op.map(|operand| rename(operand, &renamed));
            for value in results {
                renamed[value as usize] = next;
                next += 1;
            }
            let first = next - if matches!(op, Op::SinCos(_)) { 2 } else { 1 };
            statements.push(Statement { op, first, stores: Vec::new(), ..statement });
        }
        (self.statements, self.values) = (statements, next);
        self.direct.clear();
        // Where the statement is that defines a value.
        let mut home = vec![0; next as usize];
        for (place, statement) in self.statements.iter().enumerate() {
            statement.results().for_each(|value| home[value as usize] = place);
        }
        for (index, output) in (0..).zip(outputs) {
            match rename(*output, &renamed) {
                Operand::Value(value) => {
                    self.statements[home[value as usize]].stores.push((index, Operand::Value(value)));
                }
                known => self.direct.push((index, known)),
            }
        }
    }
}

fn rename(operand: Operand, renamed: &[Value]) -> Operand {
    match operand {
        Operand::Value(value) => Operand::Value(renamed[value as usize]),
        other => other,
    }
}
