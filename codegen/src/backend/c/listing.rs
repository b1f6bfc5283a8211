//! A recording as statements of C, what no output needs left out. In: a [`Recording`]. Out: lines.

use std::collections::BTreeSet;
use std::fmt::Write;

use super::recorder::{Function, Id, Operation, Recording};
use super::text::number;

/// What an operation reads.
fn operands(operation: Operation) -> Vec<Id> {
    match operation {
        Operation::Input(_) | Operation::Constant(_) => Vec::new(),
        Operation::Add(a, b)
        | Operation::Subtract(a, b)
        | Operation::Multiply(a, b)
        | Operation::Divide(a, b)
        | Operation::Call2(_, a, b) => vec![a, b],
        Operation::Negate(a) | Operation::Magnitude(a) | Operation::Root(a) | Operation::Call(_, a) => {
            vec![a]
        }
        Operation::MulAdd(a, b, c) => vec![a, b, c],
        Operation::Select(all) => all.to_vec(),
    }
}

impl Recording {
    /// By operation: whether an output needs it.
    fn needed(&self, outputs: &[Id]) -> Vec<bool> {
        let mut needed = vec![false; self.operations.len()];
        outputs.iter().for_each(|id| needed[*id] = true);
        for id in (0..needed.len()).rev() {
            if needed[id] {
                operands(self.operations[id]).into_iter().for_each(|operand| needed[operand] = true);
            }
        }
        needed
    }

    /// Functions that outputs call.
    pub fn calls(&self, outputs: &[Id]) -> BTreeSet<Function> {
        let needed = self.needed(outputs);
        let all = self.operations.iter().zip(needed).filter(|(_, needed)| *needed);
        all.filter_map(|(operation, _)| match operation {
            Operation::Call(function, _) | Operation::Call2(function, ..) => Some(*function),
            _ => None,
        })
        .collect()
    }

    /// Statements, and the expression of every output.
    pub fn statements(&self, outputs: &[Id], input: impl Fn(usize) -> String) -> (String, Vec<String>) {
        let needed = self.needed(outputs);
        let mut names: Vec<String> = Vec::with_capacity(self.operations.len());
        let mut text = String::new();
        for (id, operation) in self.operations.iter().enumerate() {
            names.push(match *operation {
                Operation::Input(index) => input(index),
                Operation::Constant(bits) => number(f64::from_bits(bits)),
                _ => format!("t{id}"),
            });
            if needed[id] && !matches!(operation, Operation::Input(_) | Operation::Constant(_)) {
                let _ = writeln!(text, "    const double t{id} = {};", expression(*operation, &names));
            }
        }
        (text, outputs.iter().map(|id| names[*id].clone()).collect())
    }
}

fn expression(operation: Operation, names: &[String]) -> String {
    let name = |id: Id| names[id].as_str();
    match operation {
        Operation::Input(_) | Operation::Constant(_) => String::new(),
        Operation::Add(a, b) => format!("{} + {}", name(a), name(b)),
        Operation::Subtract(a, b) => format!("{} - {}", name(a), name(b)),
        Operation::Multiply(a, b) => format!("{} * {}", name(a), name(b)),
        Operation::Divide(a, b) => format!("{} / {}", name(a), name(b)),
        Operation::Negate(a) => format!("-({})", name(a)),
        Operation::MulAdd(a, b, c) => format!("fma({}, {}, {})", name(a), name(b), name(c)),
        Operation::Select([a, b, yes, no]) => {
            format!("{} < {} ? {} : {}", name(a), name(b), name(yes), name(no))
        }
        Operation::Magnitude(a) => format!("fabs({})", name(a)),
        Operation::Root(a) => format!("sqrt({})", name(a)),
        Operation::Call(Function::Sine, a) => format!("sine_cosine({}).sine", name(a)),
        Operation::Call(Function::Cosine, a) => format!("sine_cosine({}).cosine", name(a)),
        Operation::Call(function, a) => format!("{}({})", function.name(), name(a)),
        Operation::Call2(function, a, b) => format!("{}({}, {})", function.name(), name(a), name(b)),
    }
}
