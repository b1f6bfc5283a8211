//! A scalar that writes down what is done with it: the runtime's own functions, run on it, become statements of C in exactly their
//! order. In: numbers known already, inputs. Out: a [`Recording`].

use std::cell::RefCell;
use std::collections::HashMap;
use std::ops::{Add, Div, Mul, Neg, Sub};

use linkwear_runtime::Scalar;

/// Place of an operation in its recording; what it reads comes before it.
pub type Id = usize;

/// What is done; equal operations on equal operands are one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Operation {
    /// Entry of the flat input.
    Input(usize),
    /// A number, by its bits.
    Constant(u64),
    Add(Id, Id),
    Subtract(Id, Id),
    Multiply(Id, Id),
    Divide(Id, Id),
    Negate(Id),
    /// First times second plus third, rounded once.
    MulAdd(Id, Id, Id),
    /// The third if the first is less than the second, else the fourth.
    Select([Id; 4]),
    Magnitude(Id),
    Root(Id),
    /// Functions that the file brings along.
    Call(Function, Id),
    Call2(Function, Id, Id),
}

/// Functions that the file brings along, as far as they are called.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Function {
    WithSignOf,
    PowerOfTwo,
    Significand,
    BinaryExponent,
    Sine,
    Cosine,
    /// Of several angles side by side.
    SinesAndCosines,
    Exponential,
    Logarithm,
    Angle,
    AngleOverSine,
    Floor,
    LogCoefficient(u8),
}

/// Operations in order.
#[derive(Debug, Default)]
pub struct Recording {
    pub operations: Vec<Operation>,
    known: HashMap<Operation, Id>,
}

/// The recording that is being made.
#[derive(Debug, Default)]
pub struct Recorder(RefCell<Recording>);

impl Recorder {
    /// An entry of the flat input.
    pub fn input(&self, index: usize) -> Number<'_> {
        self.number(Operation::Input(index))
    }

    /// Where a number is computed.
    pub fn id(&self, number: Number<'_>) -> Id {
        match number {
            Number::Known(value) => self.place(Operation::Constant(value.to_bits())),
            Number::Recorded(_, id) => id,
        }
    }

    /// All that was written down.
    pub fn finish(self) -> Recording {
        self.0.into_inner()
    }

    fn place(&self, operation: Operation) -> Id {
        let mut recording = self.0.borrow_mut();
        let next = recording.operations.len();
        let id = *recording.known.entry(operation).or_insert(next);
        if id == next {
            recording.operations.push(operation);
        }
        id
    }

    fn number(&self, operation: Operation) -> Number<'_> {
        Number::Recorded(self, self.place(operation))
    }
}

/// A number that is known, or one that is computed at run time.
#[derive(Clone, Copy, Debug)]
pub enum Number<'r> {
    Known(f64),
    Recorded(&'r Recorder, Id),
}

/// A comparison that is known, or whether one number is less than another.
#[derive(Clone, Copy, Debug)]
pub enum Mask<'r> {
    Known(bool),
    Less(&'r Recorder, Id, Id),
}

impl<'r> Number<'r> {
    /// A call of a function that the file brings along.
    pub fn call(self, function: Function, of_known: impl Fn(f64) -> f64) -> Self {
        self.unary(|id| Operation::Call(function, id), of_known)
    }

    /// The same, of two arguments.
    pub fn call_with(self, function: Function, other: Self, of_known: impl Fn(f64, f64) -> f64) -> Self {
        self.binary(other, |a, b| Operation::Call2(function, a, b), of_known)
    }

    fn unary(self, operation: impl Fn(Id) -> Operation, of_known: impl Fn(f64) -> f64) -> Self {
        match self {
            Self::Known(value) => Self::Known(of_known(value)),
            Self::Recorded(recorder, id) => recorder.number(operation(id)),
        }
    }

    fn binary(
        self,
        other: Self,
        operation: impl Fn(Id, Id) -> Operation,
        of_known: impl Fn(f64, f64) -> f64,
    ) -> Self {
        match (self, other) {
            (Self::Known(a), Self::Known(b)) => Self::Known(of_known(a, b)),
            (Self::Recorded(recorder, _), _) | (_, Self::Recorded(recorder, _)) => {
                let (a, b) = (recorder.id(self), recorder.id(other));
                recorder.number(operation(a, b))
            }
        }
    }
}

impl Add for Number<'_> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.binary(other, Operation::Add, Add::add)
    }
}

impl Sub for Number<'_> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self.binary(other, Operation::Subtract, Sub::sub)
    }
}

impl Mul for Number<'_> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        self.binary(other, Operation::Multiply, Mul::mul)
    }
}

impl Div for Number<'_> {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        self.binary(other, Operation::Divide, Div::div)
    }
}

impl Neg for Number<'_> {
    type Output = Self;
    fn neg(self) -> Self {
        self.unary(Operation::Negate, Neg::neg)
    }
}

impl<'r> Scalar for Number<'r> {
    type Mask = Mask<'r>;

    fn constant(value: f64) -> Self {
        Self::Known(value)
    }

    fn mul_add(self, factor: Self, summand: Self) -> Self {
        match (self, factor, summand) {
            (Self::Known(a), Self::Known(b), Self::Known(c)) => Self::Known(Scalar::mul_add(a, b, c)),
            (Self::Recorded(recorder, _), ..)
            | (_, Self::Recorded(recorder, _), _)
            | (.., Self::Recorded(recorder, _)) => {
                let [a, b, c] = [self, factor, summand].map(|number| recorder.id(number));
                recorder.number(Operation::MulAdd(a, b, c))
            }
        }
    }

    fn sqrt(self) -> Self {
        self.unary(Operation::Root, f64::sqrt)
    }

    fn sin_cos(self) -> (Self, Self) {
        (
            self.call(Function::Sine, |x| Scalar::sin_cos(x).0),
            self.call(Function::Cosine, |x| Scalar::sin_cos(x).1),
        )
    }

    fn exp(self) -> Self {
        self.call(Function::Exponential, Scalar::exp)
    }

    fn ln(self) -> Self {
        self.call(Function::Logarithm, Scalar::ln)
    }

    fn atan2(self, x: Self) -> Self {
        self.call_with(Function::Angle, x, Scalar::atan2)
    }

    fn abs(self) -> Self {
        self.unary(Operation::Magnitude, f64::abs)
    }

    fn max(self, other: Self) -> Self {
        Self::select(self.lt(other), other, self)
    }

    fn lt(self, other: Self) -> Mask<'r> {
        match (self, other) {
            (Self::Known(a), Self::Known(b)) => Mask::Known(a < b),
            (Self::Recorded(recorder, _), _) | (_, Self::Recorded(recorder, _)) => {
                let (a, b) = (recorder.id(self), recorder.id(other));
                Mask::Less(recorder, a, b)
            }
        }
    }

    fn select(mask: Mask<'r>, yes: Self, no: Self) -> Self {
        match mask {
            Mask::Known(true) => yes,
            Mask::Known(false) => no,
            Mask::Less(recorder, a, b) => {
                let (yes, no) = (recorder.id(yes), recorder.id(no));
                recorder.number(Operation::Select([a, b, yes, no]))
            }
        }
    }

    fn with_sign_of(self, other: Self) -> Self {
        self.call_with(Function::WithSignOf, other, Scalar::with_sign_of)
    }

    fn power_of_two(self) -> Self {
        self.call(Function::PowerOfTwo, Scalar::power_of_two)
    }

    fn split_exponent(self) -> (Self, Self) {
        (
            self.call(Function::Significand, |x| Scalar::split_exponent(x).0),
            self.call(Function::BinaryExponent, |x| Scalar::split_exponent(x).1),
        )
    }
}
