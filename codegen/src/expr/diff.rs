//! Exact partial derivatives on the graph. In: a node and a symbol. Out: a node.
//! Every function that a file can name has a rule, and no rule divides by something that vanishes where the function
//! is smooth.

use std::collections::HashMap;

use super::{Binary, ExprId, Graph, Node, Unary};

impl Graph {
    /// Derivative of `expression` by the symbol node `variable`.
    pub fn derivative(&mut self, expression: ExprId, variable: ExprId) -> ExprId {
        let one = self.one();
        let zero = self.zero();
        let mut known = HashMap::from([(variable, one)]);
        self.derivative_by(expression, &mut known, zero)
    }

    /// Directional derivative: `seeds` gives the derivative of each symbol node; others have none.
    pub fn derivative_along(&mut self, expression: ExprId, seeds: &[(ExprId, ExprId)]) -> ExprId {
        let zero = self.zero();
        let mut known: HashMap<_, _> = seeds.iter().copied().collect();
        self.derivative_by(expression, &mut known, zero)
    }

    fn derivative_by(
        &mut self,
        expression: ExprId,
        known: &mut HashMap<ExprId, ExprId>,
        zero: ExprId,
    ) -> ExprId {
        if let Some(found) = known.get(&expression) {
            return *found;
        }
        let result = match self.node(expression) {
            Node::Constant(_) | Node::Symbol(_) => zero,
            Node::Unary(operation, a) => {
                let da = self.derivative_by(a, known, zero);
                if da == zero { zero } else { self.unary_rule(operation, expression, a, da) }
            }
            Node::Binary(operation, a, b) => {
                let da = self.derivative_by(a, known, zero);
                let db = self.derivative_by(b, known, zero);
                if da == zero && db == zero {
                    zero
                } else {
                    self.binary_rule(operation, expression, [a, b], [da, db])
                }
            }
        };
        known.insert(expression, result);
        result
    }

    fn unary_rule(&mut self, operation: Unary, value: ExprId, a: ExprId, da: ExprId) -> ExprId {
        match operation {
            Unary::Neg => self.neg(da),
            Unary::Sqrt => {
                let half = self.constant(0.5);
                let numerator = self.mul(half, da);
                self.div(numerator, value)
            }
            Unary::Sin => {
                let cosine = self.cos(a);
                self.mul(cosine, da)
            }
            Unary::Cos => {
                let sine = self.sin(a);
                let product = self.mul(sine, da);
                self.neg(product)
            }
            Unary::Exp => self.mul(value, da),
            Unary::Ln => self.div(da, a),
            Unary::LogCoefficient(rank) => {
                let slope = self.log_coefficient(rank + 1, a);
                self.mul(slope, da)
            }
        }
    }

    fn binary_rule(
        &mut self,
        operation: Binary,
        value: ExprId,
        [a, b]: [ExprId; 2],
        [da, db]: [ExprId; 2],
    ) -> ExprId {
        match operation {
            Binary::Add => self.add(da, db),
            Binary::Sub => self.sub(da, db),
            Binary::Mul => self.dot(&[(da, b), (a, db)]),
            Binary::Div => {
                let pulled = self.mul(value, db);
                let numerator = self.sub(da, pulled);
                self.div(numerator, b)
            }
            Binary::Atan2 => {
                let norm = self.dot(&[(a, a), (b, b)]);
                let minus = self.neg(a);
                let numerator = self.dot(&[(da, b), (minus, db)]);
                self.div(numerator, norm)
            }
            // Its rule is 0/0 at zero. No formula of a file makes this node, and the derivation builds the Jacobian
            // of the logarithm from `log_coefficient` instead.
            Binary::AngleOverSine => unreachable!("nothing differentiates the angle of a relative rotation"),
        }
    }
}
