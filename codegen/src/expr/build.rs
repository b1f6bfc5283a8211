//! Smart constructors: constant folding and identities. In: ids of one graph. Out: ids of it.
//! Invariant: signs are pulled outwards and operands of commutative operations are ordered by id, so
//! that `a - b` and `b - a`, `c x` and `-c x` share their node. Identities hold for finite values.

use super::{Binary, ExprId, Graph, Node, Unary};

impl Graph {
    /// A number. `-0.0` becomes `0.0`.
    pub fn constant(&mut self, value: f64) -> ExprId {
        self.intern(Node::Constant((value + 0.0).to_bits()))
    }

    /// Zero.
    pub fn zero(&mut self) -> ExprId {
        self.constant(0.0)
    }

    /// One.
    pub fn one(&mut self) -> ExprId {
        self.constant(1.0)
    }

    /// Whether the node is the number zero.
    pub fn is_zero(&self, id: ExprId) -> bool {
        self.as_constant(id) == Some(0.0)
    }

    /// Whether the node is the number `value`.
    pub fn is_constant(&self, id: ExprId, value: f64) -> bool {
        self.as_constant(id) == Some(value)
    }

    /// `-a`.
    pub fn neg(&mut self, a: ExprId) -> ExprId {
        match self.node(a) {
            Node::Constant(bits) => self.constant(-f64::from_bits(bits)),
            Node::Unary(Unary::Neg, inner) => inner,
            _ => self.intern(Node::Unary(Unary::Neg, a)),
        }
    }

    /// The positive part of `±x`: (`x`, whether it was negated).
    fn strip_sign(&mut self, a: ExprId) -> (ExprId, bool) {
        match self.node(a) {
            Node::Unary(Unary::Neg, inner) => (inner, true),
            Node::Constant(bits) if f64::from_bits(bits) < 0.0 => {
                (self.constant(-f64::from_bits(bits)), true)
            }
            _ => (a, false),
        }
    }

    fn with_sign(&mut self, a: ExprId, negated: bool) -> ExprId {
        if negated { self.neg(a) } else { a }
    }

    /// `a + b`.
    pub fn add(&mut self, a: ExprId, b: ExprId) -> ExprId {
        if let (Some(x), Some(y)) = (self.as_constant(a), self.as_constant(b)) {
            return self.constant(x + y);
        }
        if self.is_zero(a) {
            return b;
        }
        if self.is_zero(b) {
            return a;
        }
        let ((x, x_negated), (y, y_negated)) = (self.strip_sign(a), self.strip_sign(b));
        match (x_negated, y_negated) {
            (false, false) => self.positive_sum(x, y),
            (true, true) => {
                let sum = self.positive_sum(x, y);
                self.neg(sum)
            }
            (false, true) => self.positive_difference(x, y),
            (true, false) => self.positive_difference(y, x),
        }
    }

    fn positive_sum(&mut self, a: ExprId, b: ExprId) -> ExprId {
        if a == b {
            let two = self.constant(2.0);
            return self.mul(two, a);
        }
        let (a, b) = if a < b { (a, b) } else { (b, a) };
        self.intern(Node::Binary(Binary::Add, a, b))
    }

    fn positive_difference(&mut self, a: ExprId, b: ExprId) -> ExprId {
        if a == b {
            return self.zero();
        }
        if a < b {
            self.intern(Node::Binary(Binary::Sub, a, b))
        } else {
            let flipped = self.intern(Node::Binary(Binary::Sub, b, a));
            self.neg(flipped)
        }
    }

    /// `a - b`.
    pub fn sub(&mut self, a: ExprId, b: ExprId) -> ExprId {
        let minus_b = self.neg(b);
        self.add(a, minus_b)
    }

    /// `a * b`.
    pub fn mul(&mut self, a: ExprId, b: ExprId) -> ExprId {
        if let (Some(x), Some(y)) = (self.as_constant(a), self.as_constant(b)) {
            return self.constant(x * y);
        }
        if self.is_zero(a) || self.is_zero(b) {
            return self.zero();
        }
        let ((x, x_negated), (y, y_negated)) = (self.strip_sign(a), self.strip_sign(b));
        let product = self.positive_product(x, y);
        self.with_sign(product, x_negated != y_negated)
    }

    fn positive_product(&mut self, a: ExprId, b: ExprId) -> ExprId {
        if self.is_constant(a, 1.0) {
            return b;
        }
        if self.is_constant(b, 1.0) {
            return a;
        }
        // c1 * (c2 * x) = (c1 c2) * x; keeps chains of constant factors at one operation.
        for (factor, other) in [(a, b), (b, a)] {
            if let (Some(c), Node::Binary(Binary::Mul, p, q)) = (self.as_constant(factor), self.node(other)) {
                if let Some(d) = self.as_constant(p) {
                    let merged = self.constant(c * d);
                    return self.mul(merged, q);
                }
                if let Some(d) = self.as_constant(q) {
                    let merged = self.constant(c * d);
                    return self.mul(merged, p);
                }
            }
        }
        let (a, b) = if a < b { (a, b) } else { (b, a) };
        self.intern(Node::Binary(Binary::Mul, a, b))
    }

    /// `a / b`; division by a number becomes a product with its reciprocal.
    pub fn div(&mut self, a: ExprId, b: ExprId) -> ExprId {
        if let Some(y) = self.as_constant(b) {
            let reciprocal = self.constant(1.0 / y);
            return self.mul(a, reciprocal);
        }
        if self.is_zero(a) {
            return a;
        }
        if a == b {
            return self.one();
        }
        let ((x, x_negated), (y, y_negated)) = (self.strip_sign(a), self.strip_sign(b));
        let quotient = self.intern(Node::Binary(Binary::Div, x, y));
        self.with_sign(quotient, x_negated != y_negated)
    }

    /// `1 / a`.
    pub fn reciprocal(&mut self, a: ExprId) -> ExprId {
        let one = self.one();
        self.div(one, a)
    }

    /// `a * a`.
    pub fn square(&mut self, a: ExprId) -> ExprId {
        self.mul(a, a)
    }

    /// `a ^ n` by repeated squaring.
    pub fn power(&mut self, a: ExprId, n: i32) -> ExprId {
        let mut result = self.one();
        let mut factor = a;
        let mut left = n.unsigned_abs();
        while left > 0 {
            if left & 1 == 1 {
                result = self.mul(result, factor);
            }
            left >>= 1;
            if left > 0 {
                factor = self.square(factor);
            }
        }
        if n < 0 { self.reciprocal(result) } else { result }
    }

    /// Square root.
    pub fn sqrt(&mut self, a: ExprId) -> ExprId {
        match self.as_constant(a) {
            Some(x) => self.constant(x.sqrt()),
            None => self.intern(Node::Unary(Unary::Sqrt, a)),
        }
    }

    /// Sine of an angle [rad].
    pub fn sin(&mut self, a: ExprId) -> ExprId {
        if let Some(x) = self.as_constant(a) {
            return self.constant(x.sin());
        }
        let (x, negated) = self.strip_sign(a);
        let sine = self.intern(Node::Unary(Unary::Sin, x));
        self.with_sign(sine, negated)
    }

    /// Cosine of an angle [rad].
    pub fn cos(&mut self, a: ExprId) -> ExprId {
        if let Some(x) = self.as_constant(a) {
            return self.constant(x.cos());
        }
        let (x, _) = self.strip_sign(a);
        self.intern(Node::Unary(Unary::Cos, x))
    }

    /// Exponential.
    pub fn exp(&mut self, a: ExprId) -> ExprId {
        match self.as_constant(a) {
            Some(x) => self.constant(x.exp()),
            None => self.intern(Node::Unary(Unary::Exp, a)),
        }
    }

    /// Natural logarithm.
    pub fn ln(&mut self, a: ExprId) -> ExprId {
        match self.as_constant(a) {
            Some(x) => self.constant(x.ln()),
            None => self.intern(Node::Unary(Unary::Ln, a)),
        }
    }

    /// Angle of the vector (`x`, `y`) [rad].
    pub fn atan2(&mut self, y: ExprId, x: ExprId) -> ExprId {
        if let (Some(a), Some(b)) = (self.as_constant(y), self.as_constant(x)) {
            return self.constant(a.atan2(b));
        }
        self.intern(Node::Binary(Binary::Atan2, y, x))
    }

    /// theta / sin theta from sin² theta and cos theta, series-safe at zero.
    pub fn angle_over_sine(&mut self, sine_squared: ExprId, cosine: ExprId) -> ExprId {
        self.intern(Node::Binary(Binary::AngleOverSine, sine_squared, cosine))
    }

    /// Series-safe coefficient of the inverse Jacobian of SE(3), `rank` times differentiated by theta².
    pub fn log_coefficient(&mut self, rank: u8, theta_squared: ExprId) -> ExprId {
        self.intern(Node::Unary(Unary::LogCoefficient(rank), theta_squared))
    }

    /// Sum of products `a_i b_i`.
    pub fn dot(&mut self, pairs: &[(ExprId, ExprId)]) -> ExprId {
        let mut sum = self.zero();
        for (a, b) in pairs {
            let product = self.mul(*a, *b);
            sum = self.add(sum, product);
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_share_their_node_whatever_the_order() {
        let mut g = Graph::new();
        let (a, b) = (g.symbol("a"), g.symbol("b"));
        let forward = g.sub(a, b);
        let backward = g.sub(b, a);
        assert_eq!(g.neg(forward), backward);
    }

    #[test]
    fn constant_factors_merge() {
        let mut g = Graph::new();
        let x = g.symbol("x");
        let (two, minus_three) = (g.constant(2.0), g.constant(-3.0));
        let inner = g.mul(two, x);
        let product = g.mul(minus_three, inner);
        let (six, _) = (g.constant(6.0), ());
        let expected = g.mul(six, x);
        assert_eq!(g.neg(expected), product);
    }
}
