//! Operators of expressions: what folds, what cancels, and how signs and operands are ordered.
//!
//! Invariant: signs are pulled outwards and operands of commutative operations are ordered by id, so
//! that `a - b` and `b - a`, `c x` and `-c x` share their node. Identities hold for finite values.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use super::expression::Expr;
use super::{Binary, Node, Unary};

/// A sum of two numbers that is this part of them is what their roundings leave of zero: a product of directions that are at right
/// angles would stay an operation by the digits of a factor.
const CANCELLED: f64 = 4.0 * f64::EPSILON;

impl Expr<'_> {
    /// The positive part of `±x`: (`x`, whether it was negated).
    #[inline]
    pub(super) fn strip_sign(self) -> (Self, bool) {
        if !self.may_change_sign() {
            return (self, false);
        }
        match self.node() {
            Node::Unary(Unary::Neg, inner) => (self.at(inner), true),
            Node::Constant(bits) if f64::from_bits(bits) < 0.0 => (-self, true),
            _ => (self, false),
        }
    }

    #[inline]
    pub(super) fn with_sign(self, negated: bool) -> Self {
        if negated { -self } else { self }
    }

    fn positive_sum(self, other: Self) -> Self {
        if self.id() == other.id() {
            return 2.0 * self;
        }
        // (a - b) + b is a: what a row gives and a recursion adds again is one value.
        let nodes = (self.node(), other.node());
        match nodes {
            (Node::Binary(Binary::Sub, a, b), _) if b == other.id() => return self.at(a),
            (_, Node::Binary(Binary::Sub, a, b)) if b == self.id() => return self.at(a),
            (Node::Binary(Binary::Mul, ..), Node::Binary(Binary::Mul, ..)) => {
                if let Some(left) = self.turned_back(other, false) {
                    return left;
                }
            }
            _ => {}
        }
        self.ordered(Binary::Add, other)
    }

    fn positive_difference(self, other: Self) -> Self {
        // (a + b) - b is a, a - (a - b) is b, a - (a + b) is -b.
        let nodes = (self.node(), other.node());
        match nodes {
            (Node::Binary(Binary::Mul, ..), Node::Binary(Binary::Mul, ..)) => {
                if let Some(left) = self.turned_back(other, true) {
                    return left;
                }
            }
            (Node::Binary(Binary::Add, a, b), _) if b == other.id() => return self.at(a),
            (Node::Binary(Binary::Add, b, a), _) if b == other.id() => return self.at(a),
            (_, Node::Binary(Binary::Sub, a, b)) if a == self.id() => return self.at(b),
            (_, Node::Binary(Binary::Add, a, b)) if a == self.id() => return -self.at(b),
            (_, Node::Binary(Binary::Add, b, a)) if a == self.id() => return -self.at(b),
            (Node::Binary(Binary::Sub, a, b), _) if a == other.id() => return -self.at(b),
            _ => {}
        }
        match self.id().cmp(&other.id()) {
            std::cmp::Ordering::Equal => self.scope().zero(),
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
    #[inline]
    fn neg(self) -> Self {
        if !self.may_change_sign() {
            return self.unary(Unary::Neg);
        }
        if self.is_zero() {
            return self;
        }
        match self.node() {
            Node::Constant(bits) => self.scope().number(-f64::from_bits(bits)),
            Node::Unary(Unary::Neg, inner) => self.at(inner),
            _ => self.unary(Unary::Neg),
        }
    }
}

impl Add for Expr<'_> {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        if self.is_zero() {
            return other;
        }
        if other.is_zero() {
            return self;
        }
        if let (Some(x), Some(y)) = (self.as_number(), other.as_number()) {
            let sum = x + y;
            // What is infinite or no number stays so.
            return self.scope().number(if sum.abs() < CANCELLED * x.abs().max(y.abs()) { 0.0 } else { sum });
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
    #[inline]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Expr<'_> {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        // Most factors of most matrices are zero.
        if self.is_zero() {
            return self;
        }
        if other.is_zero() {
            return other;
        }
        if let (Some(x), Some(y)) = (self.as_number(), other.as_number()) {
            return self.scope().number(x * y);
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
        if self.id() == other.id() {
            return self.scope().number(1.0);
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
                other.scope().number(self).$method(other)
            }
        }

        impl $trait<f64> for Expr<'_> {
            type Output = Self;
            fn $method(self, number: f64) -> Self {
                self.$method(self.scope().number(number))
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
    use crate::expr::Scope;

    #[test]
    fn differences_share_their_node_whatever_the_order() {
        let g = Scope::new();
        let (a, b) = (g.symbol("a"), g.symbol("b"));
        let (forward, backward) = (a - b, b - a);
        assert_eq!((-forward).id(), backward.id());
    }

    #[test]
    fn constant_factors_merge() {
        let g = Scope::new();
        let x = g.symbol("x");
        let product = -3.0 * (2.0 * x);
        assert_eq!((-(6.0 * x)).id(), product.id());
    }

    /// 0.6 0.8 and 0.48 are one number but for rounding, 1 + 1e-12 and 1 are two.
    #[test]
    fn numbers_that_cancel_but_for_rounding_leave_nothing() {
        let g = Scope::new();
        let mass = 1.3;
        assert_ne!(0.6 * mass * 0.8, mass * 0.48);
        assert!((g.number(0.6 * mass * 0.8) - g.number(mass * 0.48)).is_zero());
        assert!(!(g.number(1.0 + 1e-12) - 1.0).is_zero());
        assert_eq!((g.number(f64::INFINITY) + 1.0).as_number(), Some(f64::INFINITY));
    }

    #[test]
    fn what_is_added_and_taken_away_again_is_not_computed() {
        let g = Scope::new();
        let (a, b) = (g.symbol("a"), g.symbol("b"));
        for (found, expected) in [
            ((a - b) + b, a),
            (b + (a - b), a),
            ((a + b) - b, a),
            ((a + b) - a, b),
            (a - (a - b), b),
            ((a - b) - a, -b),
            (a - (a + b), -b),
            (b - (a + b), -a),
        ] {
            assert_eq!(found.id(), expected.id());
        }
    }
}
