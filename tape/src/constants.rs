//! Constants of tapes that do the same with other numbers. In: tapes. Out: whether they have one form; one tape in which the numbers
//! that differ are inputs. Never knows why they differ.

use std::collections::HashMap;

use crate::block::Block;
use crate::operation::{Binary, Op, Operand};
use crate::tape::Tape;

impl Tape {
    /// Whether another tape does the same, but for its constants.
    pub fn has_form_of(&self, other: &Self) -> bool {
        let blank = |tape: &Self| {
            let mut tape = tape.clone();
            tape.visit_operands(&mut |operand| {
                if let Operand::Constant(number) = operand {
                    *number = 0.0;
                }
            });
            tape
        };
        blank(self) == blank(other)
    }

    /// The same with the constant first in every sum and product that has one, to the same bits: which operand was there first may
    /// go by a constant's digits, where two that are one number but for rounding share a place or do not.
    pub fn constants_first(mut self) -> Self {
        for statement in &mut self.statements {
            if let Op::Binary(operation @ (Binary::Add | Binary::Mul), one, constant @ Operand::Constant(_)) =
                statement.op
            {
                statement.op = Op::Binary(operation, constant, one);
            }
        }
        self
    }

    /// Constants by which this tape and others of its form differ become inputs behind its own. Beside the tape: of each such input its
    /// value here, then in every other tape.
    pub fn lifted(&self, others: &[&Self]) -> (Self, Vec<Vec<f64>>) {
        let constants = |tape: &Self| {
            let (mut tape, mut all) = (tape.clone(), Vec::new());
            tape.visit_operands(&mut |operand| {
                if let Operand::Constant(number) = operand {
                    all.push(*number);
                }
            });
            all
        };
        let all: Vec<Vec<f64>> = std::iter::once(self).chain(others.iter().copied()).map(constants).collect();
        let (mut lifted, first) = (self.clone(), self.input_len());
        let (mut known, mut values): (HashMap<Vec<u64>, usize>, Vec<Vec<f64>>) = (HashMap::new(), Vec::new());
        let mut place = 0;
        lifted.visit_operands(&mut |operand| {
            if !matches!(operand, Operand::Constant(_)) {
                return;
            }
            let own: Vec<f64> = all.iter().filter_map(|constants| constants.get(place).copied()).collect();
            place += 1;
            if own.windows(2).all(|pair| pair[0].to_bits() == pair[1].to_bits()) {
                return;
            }
            let bits = own.iter().map(|value| value.to_bits()).collect();
            let input = *known.entry(bits).or_insert_with(|| {
                values.push(own);
                first + values.len() - 1
            });
            *operand = Operand::Input(input as u32);
        });
        lifted.inputs.push(Block::vector("constants", values.len()));
        lifted.input_names.extend((0..values.len()).map(|index| format!("constant{index}")));
        (lifted, values)
    }

    fn visit_operands(&mut self, visit: &mut dyn FnMut(&mut Operand)) {
        self.direct.iter_mut().for_each(|(_, operand)| visit(operand));
        for statement in &mut self.statements {
            statement.op = statement.op.map(|mut operand| {
                visit(&mut operand);
                operand
            });
            statement.stores.iter_mut().for_each(|(_, operand)| visit(operand));
        }
    }
}
