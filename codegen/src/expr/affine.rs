//! Values that are affine in some symbols, taken apart. In: roots and symbols. Out: constant terms and factors.

use rustc_hash::FxHashMap;

use super::expression::Expr;
use super::{Binary, ExprId, Node, Scope, Unary};

/// `constant + sum of factor_k symbol_k`; only factors that are not zero.
#[derive(Clone)]
pub struct Affine<'g> {
    /// What is left where all symbols are zero.
    pub constant: Expr<'g>,
    /// Number of the symbol, and its factor.
    pub factors: Vec<(usize, Expr<'g>)>,
}

impl<'g> Affine<'g> {
    fn map(self, by: impl Fn(Expr<'g>) -> Expr<'g>) -> Self {
        let factors = self.factors.into_iter().map(|(k, factor)| (k, by(factor)));
        Self {
            constant: by(self.constant),
            factors: factors.filter(|(_, factor)| !factor.is_zero()).collect(),
        }
    }

    fn sum(mut self, other: Self) -> Self {
        self.constant += other.constant;
        for (k, factor) in other.factors {
            match self.factors.iter_mut().find(|(known, _)| *known == k) {
                Some((_, sum)) => *sum += factor,
                None => self.factors.push((k, factor)),
            }
        }
        self
    }

    /// The factor of a symbol.
    pub fn factor(&self, symbol: usize) -> Expr<'g> {
        let own = self.factors.iter().find(|(k, _)| *k == symbol);
        own.map_or_else(|| self.constant.scope().zero(), |(_, factor)| *factor)
    }
}

impl Scope {
    /// Takes roots apart that are affine in the symbols; nothing if one is not.
    pub fn affine<'g>(&'g self, roots: &[Expr<'g>], symbols: &[Expr<'g>]) -> Option<Vec<Affine<'g>>> {
        let mut known: FxHashMap<_, Affine<'g>> = FxHashMap::default();
        let one = self.number(1.0);
        for (k, symbol) in symbols.iter().enumerate() {
            known.insert(symbol.id(), Affine { constant: self.zero(), factors: vec![(k, one)] });
        }
        let Some(first) = roots.first() else { return Some(Vec::new()) };
        // Children come before parents; what is not among the known does not depend on the symbols.
        let ids: Vec<ExprId> = roots.iter().map(|root| root.id()).collect();
        for (id, node) in self.nodes(&ids) {
            let of = |id| known.get(&id).cloned();
            let plain = |id| Affine { constant: first.at(id), factors: Vec::new() };
            if known.contains_key(&id) || node.children().all(|child| !known.contains_key(&child)) {
                continue;
            }
            self.enter_section_of(id);
            let affine = match node {
                Node::Unary(Unary::Neg, a) => of(a)?.map(|x| -x),
                Node::Binary(Binary::Add, a, b) => {
                    of(a).unwrap_or_else(|| plain(a)).sum(of(b).unwrap_or_else(|| plain(b)))
                }
                Node::Binary(Binary::Sub, a, b) => {
                    of(a).unwrap_or_else(|| plain(a)).sum(of(b).unwrap_or_else(|| plain(b)).map(|x| -x))
                }
                Node::Binary(Binary::Mul, a, b) => match (of(a), of(b)) {
                    (Some(a), None) => a.map(|x| x * first.at(b)),
                    (None, Some(b)) => b.map(|x| first.at(a) * x),
                    _ => return None,
                },
                Node::Binary(Binary::Div, a, b) if !known.contains_key(&b) => of(a)?.map(|x| x / first.at(b)),
                _ => return None,
            };
            known.insert(id, affine);
        }
        let apart = |root: &Expr<'g>| {
            known.get(&root.id()).cloned().unwrap_or_else(|| Affine { constant: *root, factors: Vec::new() })
        };
        Some(roots.iter().map(apart).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::super::Scope;

    #[test]
    fn constants_and_factors() {
        let g = Scope::new();
        let [a, b, x, y] = ["a", "b", "x", "y"].map(|name| g.symbol(name));
        let apart = g.affine(&[a * (b - 2.0 * x) / b + y, a * b], &[x, y]).unwrap();
        assert_eq!(apart[0].factor(0).id(), (a * (-2.0 * g.number(1.0)) / b).id());
        assert_eq!(apart[0].factor(1).as_number(), Some(1.0));
        assert!(apart[1].factors.is_empty() && apart[1].constant.id() == (a * b).id());
        assert!(g.affine(&[x * y], &[x, y]).is_none());
        assert!(g.affine(&[x.sin()], &[x, y]).is_none());
    }
}
