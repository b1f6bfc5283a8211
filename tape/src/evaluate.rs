//! Tapes on scalars of any kind, without preparation: back ends that write down what is done run them once. In: a tape, its inputs.
//! Out: its outputs. Never knows what a scalar is.

use linkwear_runtime::{Scalar, angle_over_sine, log_coefficient};

use crate::operation::{Binary, Op, Operand, Unary};
use crate::tape::{Statement, Tape};

impl Unary {
    /// Its value.
    pub fn of<T: Scalar>(self, a: T) -> T {
        match self {
            Self::Neg => -a,
            Self::Sqrt => a.sqrt(),
            Self::Sin => a.sin_cos().0,
            Self::Cos => a.sin_cos().1,
            Self::Exp => a.exp(),
            Self::Ln => a.ln(),
            Self::Floor => a.floor(),
            Self::LogCoefficient(rank) => log_coefficient(rank, a),
        }
    }
}

impl Binary {
    /// Its value.
    pub fn of<T: Scalar>(self, a: T, b: T) -> T {
        match self {
            Self::Add => a + b,
            Self::Sub => a - b,
            Self::Mul => a * b,
            Self::Div => a / b,
            Self::Atan2 => a.atan2(b),
            Self::AngleOverSine => angle_over_sine(a, b),
        }
    }
}

/// What functions of one and of two values are on a scalar.
pub(crate) type Functions<'f, T> = (&'f dyn Fn(Unary, T) -> T, &'f dyn Fn(Binary, T, T) -> T);

impl Tape {
    /// The outputs for inputs by their place, operation by operation in their order. The tape has to be one that [`crate::verify`] passes.
    ///
    /// # Panics
    /// If it is none.
    pub fn evaluate<T: Scalar>(&self, input: &dyn Fn(u32) -> T) -> Vec<T> {
        self.evaluate_by(input, (&|operation, a| operation.of(a), &|operation, a, b| operation.of(a, b)))
    }

    /// The same with functions of one's own.
    pub(crate) fn evaluate_by<T: Scalar>(
        &self,
        input: &dyn Fn(u32) -> T,
        (unary, binary): Functions<'_, T>,
    ) -> Vec<T> {
        let mut outputs = vec![T::constant(0.0); self.output_len()];
        let mut values: Vec<T> = Vec::with_capacity(self.values as usize);
        for (index, operand) in &self.direct {
            outputs[*index as usize] = find(*operand, &values, input);
        }
        for Statement { op, stores, .. } in &self.statements {
            let get = |operand: Operand| find(operand, &values, input);
            let (first, second) = match *op {
                Op::Unary(operation, a) => (unary(operation, get(a)), None),
                Op::Binary(operation, a, b) => (binary(operation, get(a), get(b)), None),
                Op::Select(of, yes, no) => {
                    let is_below = get(of).lt(T::constant(0.0));
                    (T::select(is_below, get(yes), get(no)), None)
                }
                Op::SinCos(angle) => {
                    let (sine, cosine) = get(angle).sin_cos();
                    (sine, Some(cosine))
                }
            };
            values.push(first);
            values.extend(second);
            for (index, operand) in stores {
                outputs[*index as usize] = find(*operand, &values, input);
            }
        }
        outputs
    }
}

fn find<T: Scalar>(operand: Operand, values: &[T], input: &dyn Fn(u32) -> T) -> T {
    match operand {
        Operand::Value(value) => values[value as usize],
        Operand::Input(index) => input(index),
        Operand::Constant(number) => T::constant(number),
    }
}
