//! A scalar that writes down what is done with it: functions that are generic over [`Scalar`], run on it, become a tape.
//! In: inputs, numbers known already. Out: a [`Tape`]. Equal operations on equal operands are written once.

use std::cell::RefCell;
use std::collections::HashMap;
use std::ops::{Add, Div, Mul, Neg, Sub};

use linkwear_runtime::Scalar;

use crate::block::Block;
use crate::operation::{Binary, Op, Operand, Unary, Value};
use crate::tape::{Statement, Tape};

/// The tape that is being written.
#[derive(Debug, Default)]
pub struct Recorder(RefCell<Recording>);

#[derive(Debug, Default)]
struct Recording {
    statements: Vec<Statement>,
    known: HashMap<Key, Value>,
    values: Value,
}

/// What makes operations equal: what is done, and the bits of up to three operands.
type Key = (u64, [Option<(u8, u64)>; 3]);

/// A number that is known, or one that is computed when the tape runs.
#[derive(Clone, Copy, Debug)]
pub enum Number<'r> {
    /// Known already.
    Known(f64),
    /// Where it is found.
    Recorded(&'r Recorder, Operand),
}

/// A comparison that is known, or a number that is below zero where it holds.
#[derive(Clone, Copy, Debug)]
pub enum Mask<'r> {
    /// Known already.
    Known(bool),
    /// Where the number is found that is below zero if it holds.
    Below(&'r Recorder, Operand),
}

impl Recorder {
    /// An entry of the flat input.
    pub fn input(&self, index: u32) -> Number<'_> {
        Number::Recorded(self, Operand::Input(index))
    }

    /// Runs a tape on numbers of this one. A function that is told apart by tapes stays one operation.
    pub fn run<'r>(&'r self, tape: &Tape, inputs: &[Number<'r>]) -> Vec<Number<'r>> {
        let unary = |operation, a| self.unary(operation, a);
        let binary = |operation, a, b| self.binary(operation, a, b);
        tape.evaluate_by(&|index| inputs[index as usize], (&unary, &binary))
    }

    /// The tape with this many inputs that gives these outputs; what they do not need is left out.
    pub fn finish(self, name: &str, inputs: usize, outputs: &[Operand]) -> Tape {
        let Recording { statements, values, .. } = self.0.into_inner();
        let mut tape = Tape {
            name: name.to_owned(),
            doc: String::new(),
            inputs: vec![Block::vector("x", inputs)],
            input_names: (0..inputs).map(|index| format!("x{index}")).collect(),
            outputs: vec![Block::vector("y", outputs.len())],
            direct: Vec::new(),
            statements,
            sections: vec![name.to_owned()],
            values,
        };
        tape.keep_needed(outputs);
        tape
    }

    /// Where a number is found.
    pub fn operand(number: Number<'_>) -> Operand {
        match number {
            Number::Known(value) => Operand::Constant(value),
            Number::Recorded(_, operand) => operand,
        }
    }

    fn write(&self, op: Op) -> Value {
        let key = key(&op);
        let mut recording = self.0.borrow_mut();
        let next = recording.values;
        let value = *recording.known.entry(key).or_insert(next);
        if value == next {
            let statement =
                Statement { op, first: next, labels: [None, None], section: 0, stores: Vec::new() };
            recording.values = statement.results().end;
            recording.statements.push(statement);
        }
        value
    }

    pub(crate) fn unary<'r>(&'r self, operation: Unary, a: Number<'r>) -> Number<'r> {
        match a {
            Number::Known(value) => Number::Known(operation.of(value)),
            Number::Recorded(_, operand) => {
                Number::Recorded(self, Operand::Value(self.write(Op::Unary(operation, operand))))
            }
        }
    }

    pub(crate) fn binary<'r>(&'r self, operation: Binary, a: Number<'r>, b: Number<'r>) -> Number<'r> {
        if let (Number::Known(a), Number::Known(b)) = (a, b) {
            return Number::Known(operation.of(a, b));
        }
        let op = Op::Binary(operation, Self::operand(a), Self::operand(b));
        Number::Recorded(self, Operand::Value(self.write(op)))
    }
}

fn key(op: &Op) -> Key {
    let kind = match op {
        Op::SinCos(_) => 0,
        Op::Select(..) => 1,
        Op::Binary(operation, ..) => 2 + *operation as u64,
        Op::Unary(operation, _) => 16 + operation.number(),
    };
    let mut operands = op.operands().map(|operand| match operand {
        Operand::Value(value) => (0, u64::from(value)),
        Operand::Input(index) => (1, u64::from(index)),
        Operand::Constant(number) => (2, number.to_bits()),
    });
    (kind, std::array::from_fn(|_| operands.next()))
}

impl<'r> Number<'r> {
    fn of_one(self, operation: Unary) -> Self {
        match self {
            Self::Known(value) => Self::Known(operation.of(value)),
            Self::Recorded(recorder, _) => recorder.unary(operation, self),
        }
    }

    fn with(self, operation: Binary, other: Self) -> Self {
        match (self, other) {
            (Self::Known(a), Self::Known(b)) => Self::Known(operation.of(a, b)),
            (Self::Recorded(recorder, _), _) | (_, Self::Recorded(recorder, _)) => {
                recorder.binary(operation, self, other)
            }
        }
    }
}

impl Add for Number<'_> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.with(Binary::Add, other)
    }
}

impl Sub for Number<'_> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self.with(Binary::Sub, other)
    }
}

impl Mul for Number<'_> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        self.with(Binary::Mul, other)
    }
}

impl Div for Number<'_> {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        self.with(Binary::Div, other)
    }
}

impl Neg for Number<'_> {
    type Output = Self;
    fn neg(self) -> Self {
        self.of_one(Unary::Neg)
    }
}

impl<'r> Scalar for Number<'r> {
    type Mask = Mask<'r>;

    fn constant(value: f64) -> Self {
        Self::Known(value)
    }

    /// In two roundings: tapes have no operation that rounds once.
    fn mul_add(self, factor: Self, summand: Self) -> Self {
        self * factor + summand
    }

    fn sqrt(self) -> Self {
        self.of_one(Unary::Sqrt)
    }

    fn sin_cos(self) -> (Self, Self) {
        match self {
            Self::Known(value) => {
                let (sine, cosine) = Scalar::sin_cos(value);
                (Self::Known(sine), Self::Known(cosine))
            }
            Self::Recorded(recorder, angle) => {
                let first = recorder.write(Op::SinCos(angle));
                let at = |value| Self::Recorded(recorder, Operand::Value(value));
                (at(first), at(first + 1))
            }
        }
    }

    fn exp(self) -> Self {
        self.of_one(Unary::Exp)
    }

    fn ln(self) -> Self {
        self.of_one(Unary::Ln)
    }

    fn atan2(self, x: Self) -> Self {
        self.with(Binary::Atan2, x)
    }

    fn abs(self) -> Self {
        Self::select(self.lt(Self::Known(0.0)), -self, self)
    }

    fn max(self, other: Self) -> Self {
        Self::select(self.lt(other), other, self)
    }

    fn lt(self, other: Self) -> Mask<'r> {
        match (self, other) {
            (Self::Known(a), Self::Known(b)) => Mask::Known(a < b),
            (Self::Recorded(recorder, of), Self::Known(0.0)) => Mask::Below(recorder, of),
            (Self::Recorded(recorder, _), _) | (_, Self::Recorded(recorder, _)) => {
                Mask::Below(recorder, Recorder::operand(self - other))
            }
        }
    }

    fn select(mask: Mask<'r>, yes: Self, no: Self) -> Self {
        match mask {
            Mask::Known(true) => yes,
            Mask::Known(false) => no,
            Mask::Below(recorder, of) => {
                let op = Op::Select(of, Recorder::operand(yes), Recorder::operand(no));
                Self::Recorded(recorder, Operand::Value(recorder.write(op)))
            }
        }
    }

    fn floor(self) -> Self {
        self.of_one(Unary::Floor)
    }
}
