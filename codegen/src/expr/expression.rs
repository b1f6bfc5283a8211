//! Expressions with operators, so that a formula reads like the book's: constants fold, identities hold.
//! In: a [`Scope`]. Out: [`Expr`]s of it. Never knows what is computed.
//!
//! Invariant: signs are pulled outwards and operands of commutative operations are ordered by id, so
//! that `a - b` and `b - a`, `c x` and `-c x` share their node. Identities hold for finite values.

use std::fmt;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use super::scope::Scope;
use super::{Binary, ExprId, Node, Unary};

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

    /// A number. `-0.0` becomes `0.0`.
    pub fn number(&self, value: f64) -> Expr<'_> {
        self.expression(Node::Constant((value + 0.0).to_bits()))
    }

    fn expression(&self, node: Node) -> Expr<'_> {
        Expr { scope: self, id: self.make(|g| g.intern(node)) }
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
    /// The node's id.
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

    /// `1 / self`.
    pub fn recip(self) -> Self {
        1.0 / self
    }

    /// `self²`.
    pub fn square(self) -> Self {
        self * self
    }

    /// `self ^ n` by repeated squaring.
    pub fn powi(self, n: i32) -> Self {
        let mut result = self.scope.number(1.0);
        let mut factor = self;
        let mut left = n.unsigned_abs();
        while left > 0 {
            if left & 1 == 1 {
                result = result * factor;
            }
            left >>= 1;
            if left > 0 {
                factor = factor.square();
            }
        }
        if n < 0 { result.recip() } else { result }
    }

    /// Square root.
    pub fn sqrt(self) -> Self {
        self.folded(f64::sqrt, |x| x.unary(Unary::Sqrt))
    }

    /// Sine of an angle [rad].
    pub fn sin(self) -> Self {
        self.folded(f64::sin, |angle| {
            let (x, negated) = angle.strip_sign();
            x.unary(Unary::Sin).with_sign(negated)
        })
    }

    /// Cosine of an angle [rad].
    pub fn cos(self) -> Self {
        self.folded(f64::cos, |angle| angle.strip_sign().0.unary(Unary::Cos))
    }

    /// Exponential.
    pub fn exp(self) -> Self {
        self.folded(f64::exp, |x| x.unary(Unary::Exp))
    }

    /// Natural logarithm.
    pub fn ln(self) -> Self {
        self.folded(f64::ln, |x| x.unary(Unary::Ln))
    }

    /// Angle of the vector (`x`, `self`) [rad].
    pub fn atan2(self, x: Self) -> Self {
        match (self.as_number(), x.as_number()) {
            (Some(a), Some(b)) => self.scope.number(a.atan2(b)),
            _ => self.binary(Binary::Atan2, x),
        }
    }

    /// theta / sin theta, where `self` is sin² theta; series-safe at zero.
    pub fn angle_over_sine(self, cosine: Self) -> Self {
        self.binary(Binary::AngleOverSine, cosine)
    }

    /// Series-safe coefficient of the inverse Jacobian of SE(3) at theta² = `self`, `rank` times differentiated by it.
    pub fn log_coefficient(self, rank: u8) -> Self {
        self.unary(Unary::LogCoefficient(rank))
    }

    /// The node behind it.
    pub(super) fn node(self) -> Node {
        self.scope.make(|g| g.node(self.id))
    }

    /// Another node of the same graph.
    pub(super) fn at(self, id: ExprId) -> Self {
        Self { id, ..self }
    }

    fn unary(self, operation: Unary) -> Self {
        self.scope.expression(Node::Unary(operation, self.id))
    }

    fn binary(self, operation: Binary, other: Self) -> Self {
        self.scope.expression(Node::Binary(operation, self.id, other.id))
    }

    /// Of a commutative operation.
    fn ordered(self, operation: Binary, other: Self) -> Self {
        if self.id < other.id { self.binary(operation, other) } else { other.binary(operation, self) }
    }

    /// The value of a number, else a node.
    fn folded(self, value: fn(f64) -> f64, make: impl FnOnce(Self) -> Self) -> Self {
        self.as_number().map_or_else(|| make(self), |x| self.scope.number(value(x)))
    }

    /// The positive part of `±x`: (`x`, whether it was negated).
    fn strip_sign(self) -> (Self, bool) {
        match self.node() {
            Node::Unary(Unary::Neg, inner) => (self.at(inner), true),
            Node::Constant(bits) if f64::from_bits(bits) < 0.0 => (-self, true),
            _ => (self, false),
        }
    }

    fn with_sign(self, negated: bool) -> Self {
        if negated { -self } else { self }
    }

    fn positive_sum(self, other: Self) -> Self {
        if self.id == other.id { 2.0 * self } else { self.ordered(Binary::Add, other) }
    }

    fn positive_difference(self, other: Self) -> Self {
        match self.id.cmp(&other.id) {
            std::cmp::Ordering::Equal => self.scope.zero(),
            std::cmp::Ordering::Less => self.binary(Binary::Sub, other),
            std::cmp::Ordering::Greater => -other.binary(Binary::Sub, self),
        }
    }

    fn positive_product(self, other: Self) -> Self {
        // c1 * (c2 * x) = (c1 c2) * x; keeps chains of constant factors at one operation.
        for (factor, other) in [(self, other), (other, self)] {
            let Some(c) = factor.as_number() else { continue };
            if c == 1.0 {
                return other;
            }
            let Node::Binary(Binary::Mul, p, q) = other.node() else { continue };
            for (number, rest) in [(p, q), (q, p)] {
                if let Some(d) = self.at(number).as_number() {
                    return c * d * self.at(rest);
                }
            }
        }
        self.ordered(Binary::Mul, other)
    }
}

impl Neg for Expr<'_> {
    type Output = Self;
    fn neg(self) -> Self {
        match self.node() {
            Node::Constant(bits) => self.scope.number(-f64::from_bits(bits)),
            Node::Unary(Unary::Neg, inner) => self.at(inner),
            _ => self.unary(Unary::Neg),
        }
    }
}

impl Add for Expr<'_> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        match (self.as_number(), other.as_number()) {
            (Some(x), Some(y)) => return self.scope.number(x + y),
            (Some(0.0), _) => return other,
            (_, Some(0.0)) => return self,
            _ => {}
        }
        let ((x, x_negated), (y, y_negated)) = (self.strip_sign(), other.strip_sign());
        match (x_negated, y_negated) {
            (false, false) => x.positive_sum(y),
            (true, true) => -x.positive_sum(y),
            (false, true) => x.positive_difference(y),
            (true, false) => y.positive_difference(x),
        }
    }
}

impl Sub for Expr<'_> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Expr<'_> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        match (self.as_number(), other.as_number()) {
            (Some(x), Some(y)) => return self.scope.number(x * y),
            (Some(0.0), _) | (_, Some(0.0)) => return self.scope.zero(),
            _ => {}
        }
        let ((x, x_negated), (y, y_negated)) = (self.strip_sign(), other.strip_sign());
        x.positive_product(y).with_sign(x_negated != y_negated)
    }
}

/// Division by a number becomes a product with its reciprocal.
impl Div for Expr<'_> {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        if let Some(y) = other.as_number() {
            return self * (1.0 / y);
        }
        if self.is_zero() {
            return self;
        }
        if self.id == other.id {
            return self.scope.number(1.0);
        }
        let ((x, x_negated), (y, y_negated)) = (self.strip_sign(), other.strip_sign());
        x.binary(Binary::Div, y).with_sign(x_negated != y_negated)
    }
}

macro_rules! with_numbers {
    ($($trait:ident $method:ident),*) => {$(
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
with_numbers!(Add add, Sub sub, Mul mul, Div div);

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_share_their_node_whatever_the_order() {
        let g = Scope::new();
        let (a, b) = (g.symbol("a"), g.symbol("b"));
        let (forward, backward) = (a - b, b - a);
        assert_eq!((-forward).id, backward.id);
    }

    #[test]
    fn constant_factors_merge() {
        let g = Scope::new();
        let x = g.symbol("x");
        let product = -3.0 * (2.0 * x);
        assert_eq!((-(6.0 * x)).id, product.id);
    }
}
