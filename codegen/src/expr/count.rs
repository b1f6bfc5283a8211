//! Live operations of roots, as a tape will have them: what passes are judged by.
//! In: a graph and roots. Out: a number. Never knows tapes.

use super::signs::Signs;
use super::{ExprId, Graph, Node, Unary};

impl Graph {
    /// Operations that `roots` need: each node once, a sine and cosine of one angle together, and no change of sign
    /// that another operation takes over.
    pub fn operations(&self, roots: &[ExprId]) -> usize {
        let uses = self.uses(roots);
        let live = self.live(&uses);
        let signs = Signs::of(self, &uses, &live);
        let mut angles = vec![false; self.nodes.len()];
        live.iter()
            .filter(|id| match self.node(**id) {
                Node::Constant(_) | Node::Symbol(_) => false,
                Node::Unary(Unary::Neg, inner) => !signs.is_reversed(inner),
                Node::Unary(Unary::Sin | Unary::Cos, angle) => {
                    !std::mem::replace(&mut angles[angle.index()], true)
                }
                Node::Unary(..) | Node::Binary(..) | Node::Select(..) => true,
            })
            .count()
    }
}

#[cfg(test)]
mod tests {
    use crate::expr::{Expr, Scope};

    fn counted<const N: usize>(build: impl for<'g> Fn([Expr<'g>; 3]) -> [Expr<'g>; N]) -> usize {
        let g = Scope::new();
        let roots = build(["a", "b", "c"].map(|name| g.symbol(name))).map(Expr::id);
        g.into_graph().operations(&roots)
    }

    #[test]
    fn sine_and_cosine_of_one_angle_count_once() {
        assert_eq!(counted(|[a, b, _]| [a.sin(), a.cos(), b.cos()]), 2);
    }

    #[test]
    fn signs_that_an_operation_takes_over_are_free() {
        assert_eq!(counted(|[a, b, _]| [-(2.0 * a), b - a]), 2);
        assert_eq!(counted(|[a, b, c]| [-((a - b) * c), -((a - 2.0 * b) / c + c), -(1.0 / a)]), 7);
        assert_eq!(counted(|[a, b, _]| [-(a * b)]), 2);
    }

    #[test]
    fn a_sign_is_not_free_where_both_signs_are_wanted() {
        assert_eq!(counted(|[a, b, c]| [(a - b) * c, -((a - b) * c)]), 3);
    }
}
