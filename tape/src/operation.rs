//! Operations and what they read. Never knows order or names.

/// Functions of one value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[allow(missing_docs, reason = "named as in mathematics")]
pub enum Unary {
    Neg,
    Sqrt,
    Sin,
    Cos,
    Exp,
    Ln,
    /// The largest whole number that is not above it; see `linkwear_runtime::Scalar::floor`.
    Floor,
    /// Series-safe coefficients of the logarithm on SE(3), by rank of derivative; see
    /// `linkwear_runtime::log_coefficient`. The argument is theta², the squared rotation angle.
    LogCoefficient(u8),
}

impl Unary {
    /// Another number for every function.
    pub const fn number(self) -> u64 {
        match self {
            Self::Neg => 0,
            Self::Sqrt => 1,
            Self::Sin => 2,
            Self::Cos => 3,
            Self::Exp => 4,
            Self::Ln => 5,
            Self::Floor => 6,
            Self::LogCoefficient(rank) => 7 + rank as u64,
        }
    }
}

/// Functions of two values.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[allow(missing_docs, reason = "named as in mathematics")]
pub enum Binary {
    Add,
    Sub,
    Mul,
    Div,
    /// `atan2(first, second)`: angle of the vector (second, first).
    Atan2,
    /// theta / sin theta from (sin² theta, cos theta), series-safe at zero; see
    /// `linkwear_runtime::angle_over_sine`.
    AngleOverSine,
}

/// A value computed by a statement.
pub type Value = u32;

/// Where an operation reads from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Operand {
    /// Result of an earlier statement.
    Value(Value),
    /// Entry of the flat input.
    Input(u32),
    /// A number.
    Constant(f64),
}

/// An operation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Op {
    /// One operand, one result.
    Unary(Unary, Operand),
    /// Two operands, one result.
    Binary(Binary, Operand, Operand),
    /// Sine (this value) and cosine (the next value) of an angle.
    SinCos(Operand),
    /// The second where the first is below zero, else the third. No branch: both are there.
    Select(Operand, Operand, Operand),
}

impl Op {
    /// The operands, in order.
    pub fn operands(&self) -> impl Iterator<Item = Operand> {
        let (first, second, third) = match self {
            Self::Unary(_, a) | Self::SinCos(a) => (*a, None, None),
            Self::Binary(_, a, b) => (*a, Some(*b), None),
            Self::Select(a, yes, no) => (*a, Some(*yes), Some(*no)),
        };
        std::iter::once(first).chain(second).chain(third)
    }

    /// The same on other operands.
    pub(crate) fn map(&self, mut other: impl FnMut(Operand) -> Operand) -> Self {
        match *self {
            Self::Unary(operation, a) => Self::Unary(operation, other(a)),
            Self::SinCos(a) => Self::SinCos(other(a)),
            Self::Binary(operation, a, b) => Self::Binary(operation, other(a), other(b)),
            Self::Select(a, yes, no) => Self::Select(other(a), other(yes), other(no)),
        }
    }
}
