//! Expressions with operators, so that a formula reads like the book's.
//! In: a [`Scope`]. Out: [`Expr`]s of it. Never knows what is computed.

use std::fmt;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use super::scope::Scope;
use super::{ExprId, Graph};

/// An expression: a node and the graph that it belongs to.
#[derive(Clone, Copy)]
#[must_use]
pub struct Expr<'g> {
    scope: &'g Scope,
    id: ExprId,
}

impl Scope {
    /// A new input, `name` as it reads in generated code.
    pub fn symbol(&self, name: impl Into<String>) -> Expr<'_> {
        Expr { scope: self, id: self.make(|g| g.symbol(name)) }
    }

    /// A number.
    pub fn number(&self, value: f64) -> Expr<'_> {
        Expr { scope: self, id: self.make(|g| g.constant(value)) }
    }

    /// Zero.
    pub fn zero(&self) -> Expr<'_> {
        self.number(0.0)
    }

    /// Sum of any number of terms.
    pub fn sum<'g>(&'g self, terms: impl IntoIterator<Item = Expr<'g>>) -> Expr<'g> {
        terms.into_iter().fold(self.zero(), |sum, term| sum + term)
    }

    /// `sum weight_k number_k`.
    pub fn weighted<'g>(&'g self, numbers: impl IntoIterator<Item = f64>, weights: &[Expr<'g>]) -> Expr<'g> {
        self.sum(numbers.into_iter().zip(weights).map(|(number, weight)| number * *weight))
    }
}

impl fmt::Debug for Expr<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.id.fmt(f)
    }
}

impl From<Expr<'_>> for ExprId {
    fn from(expression: Expr<'_>) -> Self {
        expression.id
    }
}

impl<'g> Expr<'g> {
    /// The node.
    pub const fn id(self) -> ExprId {
        self.id
    }

    /// The graph under construction.
    pub const fn scope(self) -> &'g Scope {
        self.scope
    }

    /// The number, if it is one.
    pub fn as_number(self) -> Option<f64> {
        self.scope.make(|g| g.as_constant(self.id))
    }

    /// Whether it is the number zero.
    pub fn is_zero(self) -> bool {
        self.as_number() == Some(0.0)
    }

    /// Gives the node a readable name, unless it is a constant, an input or named already.
    pub fn label(self, name: impl Into<String>) {
        self.scope.make(|g| g.label(self.id, name));
    }

    fn with(self, build: impl FnOnce(&mut Graph) -> ExprId) -> Self {
        Self { id: self.scope.make(build), ..self }
    }

    /// `1 / self`.
    pub fn recip(self) -> Self {
        self.with(|g| g.reciprocal(self.id))
    }

    /// `self²`.
    pub fn square(self) -> Self {
        self * self
    }

    /// `self ^ n` by repeated squaring.
    pub fn powi(self, n: i32) -> Self {
        self.with(|g| g.power(self.id, n))
    }

    /// Square root.
    pub fn sqrt(self) -> Self {
        self.with(|g| g.sqrt(self.id))
    }

    /// Sine of an angle [rad].
    pub fn sin(self) -> Self {
        self.with(|g| g.sin(self.id))
    }

    /// Cosine of an angle [rad].
    pub fn cos(self) -> Self {
        self.with(|g| g.cos(self.id))
    }

    /// Exponential.
    pub fn exp(self) -> Self {
        self.with(|g| g.exp(self.id))
    }

    /// Natural logarithm.
    pub fn ln(self) -> Self {
        self.with(|g| g.ln(self.id))
    }

    /// Angle of the vector (`x`, `self`) [rad].
    pub fn atan2(self, x: Self) -> Self {
        self.with(|g| g.atan2(self.id, x.id))
    }

    /// theta / sin theta, where `self` is sin² theta; series-safe at zero.
    pub fn angle_over_sine(self, cosine: Self) -> Self {
        self.with(|g| g.angle_over_sine(self.id, cosine.id))
    }

    /// Series-safe coefficient of the inverse Jacobian of SE(3) at theta² = `self`, `rank` times differentiated by it.
    pub fn log_coefficient(self, rank: u8) -> Self {
        self.with(|g| g.log_coefficient(rank, self.id))
    }

    /// Derivative by the symbol `variable`.
    pub fn derivative(self, variable: Self) -> Self {
        self.with(|g| g.derivative(self.id, variable.id))
    }
}

macro_rules! operator {
    ($($trait:ident $method:ident),*) => {$(
        impl $trait for Expr<'_> {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                self.with(|g| g.$method(self.id, other.id))
            }
        }

        impl<'g> $trait<Expr<'g>> for f64 {
            type Output = Expr<'g>;
            fn $method(self, other: Expr<'g>) -> Expr<'g> {
                other.scope.number(self).$method(other)
            }
        }

        impl $trait<f64> for Expr<'_> {
            type Output = Self;
            fn $method(self, number: f64) -> Self {
                self.$method(self.scope.number(number))
            }
        }
    )*};
}
operator!(Add add, Sub sub, Mul mul, Div div);

impl Neg for Expr<'_> {
    type Output = Self;
    fn neg(self) -> Self {
        self.with(|g| g.neg(self.id))
    }
}

impl AddAssign for Expr<'_> {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Expr<'_> {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}
