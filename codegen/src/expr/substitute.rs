//! Expressions in place of symbols. In: a node and what its symbols become. Out: a node of the same graph.

use rustc_hash::FxHashMap;

use super::expression::Expr;
use super::{ExprId, Node};

impl<'g> Expr<'g> {
    /// The same with expressions in place of symbols.
    pub fn with(self, values: &[(Self, Self)]) -> Self {
        self.substituted(&mut values.iter().map(|(symbol, value)| (symbol.id(), *value)).collect())
    }

    fn substituted(self, known: &mut FxHashMap<ExprId, Self>) -> Self {
        if let Some(found) = known.get(&self.id()) {
            return *found;
        }
        let result = match self.node() {
            Node::Constant(_) | Node::Symbol(_) => self,
            Node::Unary(operation, a) => self.at(a).substituted(known).through(operation),
            Node::Select(a, yes, no) => {
                let [a, yes, no] = [a, yes, no].map(|part| self.at(part).substituted(known));
                a.below_zero(yes, no)
            }
            Node::Binary(operation, a, b) => {
                let (a, b) = (self.at(a).substituted(known), self.at(b).substituted(known));
                a.joined(operation, b)
            }
        };
        known.insert(self.id(), result);
        result
    }
}

#[cfg(test)]
mod tests {
    use super::super::Scope;

    #[test]
    fn symbols_are_replaced_all_at_once() {
        let g = Scope::new();
        let [x, y, z] = ["x", "y", "z"].map(|name| g.symbol(name));
        let swapped = (x / y + z.sin()).with(&[(x, y), (y, x)]);
        assert_eq!(swapped.id(), (y / x + z.sin()).id());
        assert_eq!((x * y).with(&[(x, g.number(2.0)), (y, g.number(3.0))]).as_number(), Some(6.0));
    }
}
