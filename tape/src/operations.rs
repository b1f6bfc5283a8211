//! Operation counts of tapes. In: tapes. Out: [`Operations`].

use std::ops::AddAssign;

use crate::operation::{Binary, Op, Operand, Unary};
use crate::tape::Tape;

/// Operations by kind. Counts before sharing can be astronomic: sums saturate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Operations {
    /// Multiplications.
    pub mul: u64,
    /// Additions, subtractions and changes of sign.
    pub add: u64,
    /// Divisions.
    pub div: u64,
    /// Square roots.
    pub sqrt: u64,
    /// Sine-cosine pairs.
    pub sincos: u64,
    /// Everything else: exp, ln, atan2, choices, intrinsics.
    pub other: u64,
    /// Sum.
    pub total: u64,
}

impl AddAssign for Operations {
    fn add_assign(&mut self, other: Self) {
        self.mul = self.mul.saturating_add(other.mul);
        self.add = self.add.saturating_add(other.add);
        self.div = self.div.saturating_add(other.div);
        self.sqrt = self.sqrt.saturating_add(other.sqrt);
        self.sincos = self.sincos.saturating_add(other.sincos);
        self.other = self.other.saturating_add(other.other);
        self.total = self.total.saturating_add(other.total);
    }
}

impl Operations {
    /// Counts one more.
    pub fn count(&mut self, op: &Op) {
        match op {
            Op::Binary(Binary::Mul, ..) => self.mul += 1,
            Op::Binary(Binary::Add | Binary::Sub, ..) | Op::Unary(Unary::Neg, _) => self.add += 1,
            Op::Binary(Binary::Div, ..) => self.div += 1,
            Op::Unary(Unary::Sqrt, _) => self.sqrt += 1,
            Op::SinCos(_) | Op::Unary(Unary::Sin | Unary::Cos, _) => self.sincos += 1,
            Op::Unary(..) | Op::Binary(..) | Op::Select(..) => self.other += 1,
        }
        self.total += 1;
    }
}

impl Tape {
    /// Operations of the whole tape.
    pub fn operations(&self) -> Operations {
        let mut counts = Operations::default();
        for statement in &self.statements {
            counts.count(&statement.op);
        }
        counts
    }

    /// Operations by section, in the order in which the sections begin.
    pub fn operations_by_section(&self) -> Vec<(String, Operations)> {
        let mut counts = vec![Operations::default(); self.sections.len()];
        for statement in &self.statements {
            counts[statement.section].count(&statement.op);
        }
        self.sections.iter().cloned().zip(counts).collect()
    }

    /// Operations that one output block needs on its own.
    pub fn operations_of(&self, output: usize) -> Operations {
        let first: usize = self.outputs[..output].iter().map(|block| block.len()).sum();
        let range = first..first + self.outputs[output].len();
        let mut needed = vec![false; self.values as usize];
        let mark = |needed: &mut Vec<bool>, operand: Operand| {
            if let Operand::Value(value) = operand {
                needed[value as usize] = true;
            }
        };
        let mut counts = Operations::default();
        for statement in self.statements.iter().rev() {
            for (index, operand) in &statement.stores {
                if range.contains(&(*index as usize)) {
                    mark(&mut needed, *operand);
                }
            }
            if statement.results().any(|value| needed[value as usize]) {
                counts.count(&statement.op);
                for operand in statement.op.operands() {
                    mark(&mut needed, operand);
                }
            }
        }
        counts
    }
}
