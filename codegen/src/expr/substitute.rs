//! Expressions in place of symbols. In: a node and what its symbols become. Out: a node of the same graph.

use rustc_hash::FxHashMap;

use super::expression::Expr;
use super::{ExprId, Node, Scope};

impl Scope {
    /// The same by ids.
    pub fn with_ids<'g>(&'g self, roots: &[ExprId], values: &[(Expr<'g>, Expr<'g>)]) -> Vec<ExprId> {
        let Some((any, _)) = values.first() else { return roots.to_vec() };
        let roots: Vec<Expr<'g>> = roots.iter().map(|id| any.at(*id)).collect();
        self.with(&roots, values).into_iter().map(Expr::id).collect()
    }

    /// The same roots with expressions in place of symbols. What is made anew stays in its section, and conditions that are
    /// quiet stay so.
    pub fn with<'g>(&'g self, roots: &[Expr<'g>], values: &[(Expr<'g>, Expr<'g>)]) -> Vec<Expr<'g>> {
        let mut known: FxHashMap<ExprId, Expr<'g>> =
            values.iter().map(|(symbol, value)| (symbol.id(), *value)).collect();
        let Some(first) = roots.first() else { return Vec::new() };
        let ids: Vec<ExprId> = roots.iter().map(|root| root.id()).collect();
        for (id, node) in self.nodes(&ids) {
            if known.contains_key(&id) || node.children().all(|child| !known.contains_key(&child)) {
                continue;
            }
            self.enter_section_of(id);
            let of = |id| known.get(&id).copied().unwrap_or_else(|| first.at(id));
            if let Node::Select(by, ..) = node
                && self.make(|g| g.quiet.contains(&by))
            {
                of(by).keep_quiet();
            }
            let made = first.at(id).rebuilt(|child| of(child.id()));
            known.insert(id, made);
        }
        roots.iter().map(|root| known.get(&root.id()).copied().unwrap_or(*root)).collect()
    }
}

impl<'g> Expr<'g> {
    /// The same with expressions in place of symbols.
    pub fn with(self, values: &[(Self, Self)]) -> Self {
        self.substituted(&mut values.iter().map(|(symbol, value)| (symbol.id(), *value)).collect())
    }

    /// The same of what `of` makes of the nodes that it is computed from.
    fn rebuilt(self, mut of: impl FnMut(Self) -> Self) -> Self {
        match self.node() {
            Node::Constant(_) | Node::Symbol(_) => self,
            Node::Unary(operation, a) => of(self.at(a)).through(operation),
            Node::Binary(operation, a, b) => {
                let (a, b) = (of(self.at(a)), of(self.at(b)));
                a.joined(operation, b)
            }
            Node::Select(by, yes, no) => {
                let [by, yes, no] = [by, yes, no].map(|part| of(self.at(part)));
                by.below_zero(yes, no)
            }
        }
    }

    fn substituted(self, known: &mut FxHashMap<ExprId, Self>) -> Self {
        if let Some(found) = known.get(&self.id()) {
            return *found;
        }
        let result = self.rebuilt(|child| child.substituted(known));
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
        let both = g.with(&[x / y + z.sin(), z], &[(x, y), (y, x)]);
        assert_eq!(both.iter().map(|root| root.id()).collect::<Vec<_>>(), [swapped.id(), z.id()]);
        assert_eq!((x * y).with(&[(x, g.number(2.0)), (y, g.number(3.0))]).as_number(), Some(6.0));
    }
}
