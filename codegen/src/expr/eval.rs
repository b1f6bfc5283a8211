//! The slow, obvious evaluator: the oracle of the tape and its back ends.
//! In: a graph and a number per symbol. Out: a number per node. Never knows tapes.

use super::{Binary, ExprId, Graph, Node, Unary};
use linkwear_runtime::{Scalar, angle_over_sine, log_coefficient};

impl Graph {
    /// Values of every node, in node order, for the given symbol values.
    ///
    /// # Panics
    /// If `symbols` is shorter than the number of symbols made.
    pub fn evaluate_all<T: Scalar>(&self, symbols: &[T]) -> Vec<T> {
        let mut values: Vec<T> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            let at = |id: &ExprId| values[id.index()];
            values.push(match node {
                Node::Constant(bits) => T::constant(f64::from_bits(*bits)),
                Node::Symbol(symbol) => symbols[symbol.index()],
                Node::Unary(operation, a) => unary(*operation, at(a)),
                Node::Binary(operation, a, b) => binary(*operation, at(a), at(b)),
            });
        }
        values
    }
}

/// Applies a function of one value.
pub fn unary<T: Scalar>(operation: Unary, a: T) -> T {
    match operation {
        Unary::Neg => -a,
        Unary::Sqrt => a.sqrt(),
        Unary::Sin => a.sin_cos().0,
        Unary::Cos => a.sin_cos().1,
        Unary::Exp => a.exp(),
        Unary::Ln => a.ln(),
        Unary::LogCoefficient(rank) => log_coefficient(rank, a),
    }
}

/// Applies a function of two values.
pub fn binary<T: Scalar>(operation: Binary, a: T, b: T) -> T {
    match operation {
        Binary::Add => a + b,
        Binary::Sub => a - b,
        Binary::Mul => a * b,
        Binary::Div => a / b,
        Binary::Atan2 => a.atan2(b),
        Binary::AngleOverSine => angle_over_sine(a, b),
    }
}
