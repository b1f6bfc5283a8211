//! Exact partial derivatives on the graph. In: a node and a symbol. Out: a node.
//! Every function that a file can name has a rule, and no rule divides by something that vanishes where the function
//! is smooth.

use rustc_hash::FxHashMap;

use super::expression::Expr;
use super::{Binary, ExprId, Node, Unary};

impl<'g> Expr<'g> {
    /// Derivative by the symbol `variable`.
    pub fn derivative(self, variable: Self) -> Self {
        let one = self.scope().number(1.0);
        let zero = self.scope().zero();
        self.derivative_by(&mut FxHashMap::from_iter([(variable.id(), one)]), zero)
    }

    fn derivative_by(self, known: &mut FxHashMap<ExprId, Self>, zero: Self) -> Self {
        if let Some(found) = known.get(&self.id()) {
            return *found;
        }
        let result = match self.node() {
            Node::Constant(_) | Node::Symbol(_) => zero,
            Node::Unary(operation, a) => {
                let a = self.at(a);
                let da = a.derivative_by(known, zero);
                if da.is_zero() { zero } else { self.unary_rule(operation, a, da) }
            }
            Node::Select(a, yes, no) => {
                // Between its jumps; where it has one, a derivative means nothing.
                let [yes, no] = [yes, no].map(|side| self.at(side).derivative_by(known, zero));
                self.at(a).below_zero(yes, no)
            }
            Node::Binary(operation, a, b) => {
                let (a, b) = (self.at(a), self.at(b));
                let (da, db) = (a.derivative_by(known, zero), b.derivative_by(known, zero));
                let constant = da.is_zero() && db.is_zero();
                if constant { zero } else { self.binary_rule(operation, [a, b], [da, db]) }
            }
        };
        known.insert(self.id(), result);
        result
    }

    fn unary_rule(self, operation: Unary, a: Self, da: Self) -> Self {
        match operation {
            Unary::Neg => -da,
            Unary::Sqrt => 0.5 * da / self,
            Unary::Sin => a.cos() * da,
            Unary::Cos => -(a.sin() * da),
            Unary::Exp => self * da,
            Unary::Ln => da / a,
            // Between its jumps.
            Unary::Floor => self.scope().zero(),
            Unary::LogCoefficient(rank) => a.log_coefficient(rank + 1) * da,
        }
    }

    fn binary_rule(self, operation: Binary, [a, b]: [Self; 2], [da, db]: [Self; 2]) -> Self {
        match operation {
            Binary::Add => da + db,
            Binary::Sub => da - db,
            Binary::Mul => da * b + a * db,
            Binary::Div => (da - self * db) / b,
            Binary::Atan2 => {
                let norm = a * a + b * b;
                let minus = -a;
                (da * b + minus * db) / norm
            }
            // Its rule is 0/0 at zero. No formula of a file makes this node, and the derivation builds the Jacobian
            // of the logarithm from `log_coefficient` instead.
            #[expect(clippy::unreachable, reason = "only the derivation makes this node, and never asks")]
            Binary::AngleOverSine => unreachable!("nothing differentiates the angle of a relative rotation"),
        }
    }
}
