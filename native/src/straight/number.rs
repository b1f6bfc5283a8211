//! A scalar that writes down what is done with it: the runtime's own functions, run on it, become machine operations
//! in exactly their order. In: numbers known already, nodes. Out: nodes of a [`Graph`].

use std::cell::{RefCell, RefMut};
use std::ops::{Add, Div, Mul, Neg, Sub};

use linkwear_runtime::Scalar;

use super::graph::{Function, Graph, Id, Operation, SIGN};

/// The graph that is being written.
#[derive(Debug, Default)]
pub(super) struct Recorder(RefCell<Graph>);

impl Recorder {
    pub(super) fn input(&self, index: u32) -> Number<'_> {
        self.number(Operation::Input(index), [])
    }

    fn number<const N: usize>(&self, operation: Operation, arguments: [Id; N]) -> Number<'_> {
        Number::Recorded(self, self.0.borrow_mut().node_of(operation, arguments))
    }

    fn constant(&self, bits: u64) -> Id {
        self.0.borrow_mut().constant(bits)
    }

    /// The number of a node.
    pub(super) const fn of_node(&self, id: Id) -> Number<'_> {
        Number::Recorded(self, id)
    }

    /// The graph as it is so far.
    pub(super) fn graph(&self) -> RefMut<'_, Graph> {
        self.0.borrow_mut()
    }

    /// The node of a number.
    pub(super) fn id(&self, number: Number<'_>) -> Id {
        match number {
            Number::Known(value) => self.constant(value.to_bits()),
            Number::Recorded(_, id) => id,
        }
    }

    /// The nodes of numbers.
    pub(super) fn ids(&self, numbers: Vec<Number<'_>>) -> Vec<Id> {
        numbers.into_iter().map(|number| self.id(number)).collect()
    }

    pub(super) fn into_graph(self) -> Graph {
        self.0.into_inner()
    }

    /// The mask under which a node is 1, if it is -1 elsewhere.
    fn sign_choice(&self, id: Id) -> Option<Id> {
        let graph = self.0.borrow();
        let node = graph.node(id);
        let is = |id: Id, value: f64| graph.node(id).operation == Operation::Constant(value.to_bits());
        match (node.operation, node.arguments()) {
            (Operation::Select, [mask, yes, no]) if is(*yes, 1.0) && is(*no, -1.0) => Some(*mask),
            _ => None,
        }
    }

    /// `number`, with its sign turned where `mask` is not set: the product with 1 or -1, bit for bit.
    fn signed(&self, mask: Id, number: Id) -> Number<'_> {
        let sign = self.constant(SIGN);
        let turned = self.0.borrow_mut().node_of(Operation::AndNot, [mask, sign]);
        self.number(Operation::Xor, [number, turned])
    }
}

/// A number that is known, or one that is computed at run time.
#[derive(Clone, Copy, Debug)]
pub(super) enum Number<'g> {
    Known(f64),
    Recorded(&'g Recorder, Id),
}

/// A truth value that is known, or one that is computed at run time.
#[derive(Clone, Copy, Debug)]
pub(super) enum Mask<'g> {
    Known(bool),
    Recorded(&'g Recorder, Id),
}

impl<'g> Number<'g> {
    fn unary(self, operation: Operation, of_known: impl Fn(f64) -> f64) -> Self {
        match self {
            Self::Known(value) => Self::Known(of_known(value)),
            Self::Recorded(recorder, id) => recorder.number(operation, [id]),
        }
    }

    fn binary(self, operation: Operation, other: Self, of_known: impl Fn(f64, f64) -> f64) -> Self {
        match (self, other) {
            (Self::Known(a), Self::Known(b)) => Self::Known(of_known(a, b)),
            (Self::Recorded(recorder, _), _) | (_, Self::Recorded(recorder, _)) => {
                recorder.number(operation, [recorder.id(self), recorder.id(other)])
            }
        }
    }
}

impl Add for Number<'_> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.binary(Operation::Add, other, Add::add)
    }
}

impl Sub for Number<'_> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self.binary(Operation::Subtract, other, Sub::sub)
    }
}

impl Mul for Number<'_> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        if let (Self::Recorded(recorder, first), Self::Recorded(_, second)) = (self, other)
            && let Some(mask) = recorder.sign_choice(first)
        {
            return recorder.signed(mask, second);
        }
        self.binary(Operation::Multiply, other, Mul::mul)
    }
}

impl Div for Number<'_> {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        self.binary(Operation::Divide, other, Div::div)
    }
}

impl Neg for Number<'_> {
    type Output = Self;
    fn neg(self) -> Self {
        match self {
            Self::Known(value) => Self::Known(-value),
            Self::Recorded(recorder, id) => recorder.number(Operation::Xor, [id, recorder.constant(SIGN)]),
        }
    }
}

impl<'g> Scalar for Number<'g> {
    type Mask = Mask<'g>;

    fn constant(value: f64) -> Self {
        Self::Known(value)
    }

    fn mul_add(self, factor: Self, summand: Self) -> Self {
        match (self, factor, summand) {
            (Self::Known(a), Self::Known(b), Self::Known(c)) => Self::Known(Scalar::mul_add(a, b, c)),
            (Self::Recorded(recorder, _), ..)
            | (_, Self::Recorded(recorder, _), _)
            | (.., Self::Recorded(recorder, _)) => {
                let arguments = [self, factor, summand].map(|number| recorder.id(number));
                recorder.number(Operation::Call(Function::MulAdd), arguments)
            }
        }
    }

    fn sqrt(self) -> Self {
        self.unary(Operation::SquareRoot, f64::sqrt)
    }

    fn sin_cos(self) -> (Self, Self) {
        match self {
            Self::Known(angle) => {
                let (sine, cosine) = linkwear_runtime::sin_cos(angle);
                (Self::Known(sine), Self::Known(cosine))
            }
            Self::Recorded(recorder, id) => {
                (recorder.number(Operation::Sine, [id]), recorder.number(Operation::Cosine, [id]))
            }
        }
    }

    fn exp(self) -> Self {
        self.unary(Operation::Call(Function::Exp), Scalar::exp)
    }

    fn ln(self) -> Self {
        self.unary(Operation::Call(Function::Ln), Scalar::ln)
    }

    fn atan2(self, x: Self) -> Self {
        self.binary(Operation::Call(Function::Atan2), x, Scalar::atan2)
    }

    fn abs(self) -> Self {
        match self {
            Self::Known(value) => Self::Known(value.abs()),
            Self::Recorded(recorder, id) => recorder.number(Operation::And, [id, recorder.constant(!SIGN)]),
        }
    }

    fn max(self, other: Self) -> Self {
        Self::select(self.lt(other), other, self)
    }

    fn lt(self, other: Self) -> Mask<'g> {
        match (self, other) {
            (Self::Known(a), Self::Known(b)) => Mask::Known(a < b),
            (Self::Recorded(recorder, _), _) | (_, Self::Recorded(recorder, _)) => {
                let arguments = [recorder.id(self), recorder.id(other)];
                Mask::Recorded(recorder, recorder.0.borrow_mut().node_of(Operation::Less, arguments))
            }
        }
    }

    fn select(mask: Mask<'g>, yes: Self, no: Self) -> Self {
        match mask {
            Mask::Known(holds) => {
                if holds {
                    yes
                } else {
                    no
                }
            }
            Mask::Recorded(recorder, mask) => {
                recorder.number(Operation::Select, [mask, recorder.id(yes), recorder.id(no)])
            }
        }
    }
}
