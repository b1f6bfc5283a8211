//! From a tape to machine operations. In: a tape that [`verify`] passes. Out: [`Lowered`].
//! Never knows in which order they will run.

use linkwear_runtime::{Scalar, angle_over_sine, log_coefficient};
use linkwear_tape::{Binary, Op, Operand, Statement, Tape, Unary, verify};

use super::graph::{Graph, Id};
use super::number::{Number, Recorder};

/// One function as machine operations.
#[derive(Clone, Debug)]
pub(crate) struct Lowered {
    pub(super) graph: Graph,
    /// Length of the flat input.
    pub(super) inputs: usize,
    /// Nodes that are computed before others, in this order, as far as outputs need them.
    pub(super) first: Vec<Id>,
    /// The node of every entry of the flat output.
    pub(super) outputs: Vec<Id>,
}

/// Writes a tape's operations down, one by one.
///
/// # Errors
/// The tape's first defect.
pub(crate) fn lower(tape: &Tape) -> Result<Lowered, String> {
    verify(tape)?;
    let recorder = Recorder::default();
    let outputs = run(tape, &|index| recorder.input(index));
    let outputs = outputs.into_iter().map(|output| recorder.id(output)).collect();
    Ok(Lowered { graph: recorder.into_graph(), inputs: tape.input_len(), first: Vec::new(), outputs })
}

/// Runs a tape that is verified on numbers that write down what is done with them.
pub(super) fn run<'g>(tape: &Tape, input: &dyn Fn(u32) -> Number<'g>) -> Vec<Number<'g>> {
    let mut outputs = vec![Number::Known(0.0); tape.output_len()];
    let mut values: Vec<Number<'g>> = Vec::with_capacity(tape.values as usize);
    for (index, operand) in &tape.direct {
        outputs[*index as usize] = number(*operand, &values, input);
    }
    for Statement { op, stores, .. } in &tape.statements {
        let get = |operand: Operand| number(operand, &values, input);
        let (first, second) = match *op {
            Op::Unary(operation, a) => (unary(operation, get(a)), None),
            Op::Binary(operation, a, b) => (binary(operation, get(a), get(b)), None),
            Op::Select(of, yes, no) => {
                let is_below = get(of).lt(Number::Known(0.0));
                (Number::select(is_below, get(yes), get(no)), None)
            }
            Op::SinCos(angle) => {
                let (sine, cosine) = get(angle).sin_cos();
                (sine, Some(cosine))
            }
        };
        values.push(first);
        values.extend(second);
        for (index, operand) in stores {
            outputs[*index as usize] = number(*operand, &values, input);
        }
    }
    outputs
}

fn number<'g>(operand: Operand, values: &[Number<'g>], input: &dyn Fn(u32) -> Number<'g>) -> Number<'g> {
    match operand {
        Operand::Value(value) => values[value as usize],
        Operand::Input(index) => input(index),
        Operand::Constant(value) => Number::Known(value),
    }
}

fn unary(operation: Unary, a: Number<'_>) -> Number<'_> {
    match operation {
        Unary::Neg => -a,
        Unary::Sqrt => a.sqrt(),
        Unary::Sin => a.sin_cos().0,
        Unary::Cos => a.sin_cos().1,
        Unary::Exp => a.exp(),
        Unary::Ln => a.ln(),
        Unary::Floor => a.floor(),
        Unary::LogCoefficient(rank) => log_coefficient(rank, a),
    }
}

fn binary<'g>(operation: Binary, a: Number<'g>, b: Number<'g>) -> Number<'g> {
    match operation {
        Binary::Add => a + b,
        Binary::Sub => a - b,
        Binary::Mul => a * b,
        Binary::Div => a / b,
        Binary::Atan2 => a.atan2(b),
        Binary::AngleOverSine => angle_over_sine(a, b),
    }
}
