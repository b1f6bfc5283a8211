//! What a tape's code calls, and what it should be answered: where code runs without the runtime, others can answer.

use linkwear_runtime::Scalar;
use linkwear_tape::Tape;

use crate::straight::graph::{Function, Operation};
use crate::straight::lower::lower;

/// A call of a function on one lane, by bits.
pub(crate) struct Call {
    pub(crate) function: Function,
    /// Those past the function's are zero, all NaN the same.
    pub(crate) arguments: [u64; 3],
    pub(crate) result: u64,
}

/// Bits and payloads of NaN are nobody's promise.
pub(crate) fn same_nan(bits: u64) -> u64 {
    if f64::from_bits(bits).is_nan() { f64::NAN.to_bits() } else { bits }
}

/// All that is called on an input; runs the operations of the graph.
pub(crate) fn calls(tape: &Tape, input: &[f64]) -> Vec<Call> {
    let graph = lower(tape).expect("a tape").graph;
    let mut calls = Vec::new();
    let mut values: Vec<u64> = Vec::with_capacity(graph.len());
    for id in 0..graph.len() {
        let node = graph.node(id as u32);
        let mut arguments = [0; 3];
        for (bits, argument) in arguments.iter_mut().zip(node.arguments()) {
            *bits = values[*argument as usize];
        }
        let [a, b, c] = arguments.map(f64::from_bits);
        let [x, y, _] = arguments;
        values.push(match node.operation {
            Operation::Input(index) => input[index as usize].to_bits(),
            Operation::Constant(bits) => bits,
            Operation::Add => (a + b).to_bits(),
            Operation::Subtract => (a - b).to_bits(),
            Operation::Multiply => (a * b).to_bits(),
            Operation::Divide => (a / b).to_bits(),
            Operation::SquareRoot => a.sqrt().to_bits(),
            Operation::And => x & y,
            Operation::AndNot => !x & y,
            Operation::Xor => x ^ y,
            Operation::Sine => Scalar::sin_cos(a).0.to_bits(),
            Operation::Cosine => Scalar::sin_cos(a).1.to_bits(),
            // Values stand alone here.
            Operation::Pair | Operation::Low | Operation::High => 0,
            Operation::Less => u64::from(a < b).wrapping_neg(),
            Operation::Select => {
                if x == 0 {
                    arguments[2]
                } else {
                    y
                }
            }
            Operation::Larger => (if a > b { a } else { b }).to_bits(),
            Operation::Smaller => (if a < b { a } else { b }).to_bits(),
            Operation::Call(function) => {
                let result = match function {
                    Function::Exp => Scalar::exp(a),
                    Function::Ln => Scalar::ln(a),
                    Function::Atan2 => Scalar::atan2(a, b),
                    Function::MulAdd => Scalar::mul_add(a, b, c),
                }
                .to_bits();
                let count = node.arguments().len();
                let known = |at: usize| if at < count { same_nan(arguments[at]) } else { 0 };
                calls.push(Call { function, arguments: std::array::from_fn(known), result });
                result
            }
        });
    }
    calls
}
