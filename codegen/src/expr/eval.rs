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
            let at = |id: ExprId| values[id.index()];
            values.push(match *node {
                Node::Constant(bits) => T::constant(f64::from_bits(bits)),
                Node::Symbol(symbol) => symbols[symbol.index()],
                Node::Unary(Unary::Neg, a) => -at(a),
                Node::Unary(Unary::Sqrt, a) => at(a).sqrt(),
                Node::Unary(Unary::Sin, a) => at(a).sin_cos().0,
                Node::Unary(Unary::Cos, a) => at(a).sin_cos().1,
                Node::Unary(Unary::Exp, a) => at(a).exp(),
                Node::Unary(Unary::Ln, a) => at(a).ln(),
                Node::Unary(Unary::Floor, a) => at(a).floor(),
                Node::Select(a, yes, no) => T::select(at(a).lt(T::constant(0.0)), at(yes), at(no)),
                Node::Unary(Unary::LogCoefficient(rank), a) => log_coefficient(rank, at(a)),
                Node::Binary(Binary::Add, a, b) => at(a) + at(b),
                Node::Binary(Binary::Sub, a, b) => at(a) - at(b),
                Node::Binary(Binary::Mul, a, b) => at(a) * at(b),
                Node::Binary(Binary::Div, a, b) => at(a) / at(b),
                Node::Binary(Binary::Atan2, a, b) => at(a).atan2(at(b)),
                Node::Binary(Binary::AngleOverSine, a, b) => angle_over_sine(at(a), at(b)),
            });
        }
        values
    }
}
