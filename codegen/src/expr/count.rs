//! Live operations of roots, as a tape will have them: what passes are judged by.
//! In: a graph and roots. Out: a number. Never knows tapes.

use super::signs::Signs;
use super::{ExprId, Graph, Node, Unary};

impl Graph {
    /// Operations that `roots` need: each node once, a sine and cosine of one angle together, and no change of sign
    /// that another operation takes over.
    pub fn operations(&self, roots: &[ExprId]) -> usize {
        // Of all that was ever tried, one way needs little.
        let (needed, uses) = self.needed(roots);
        let live: Vec<ExprId> = (0..uses.len()).map(ExprId::new).collect();
        needed.count(&uses, &live)
    }

    /// The same of a graph that has little else, with the [`Graph::uses`] of the roots.
    pub fn operations_of_most(&self, uses: &[u32]) -> usize {
        self.count(uses, &self.live(uses))
    }

    fn count(&self, uses: &[u32], live: &[ExprId]) -> usize {
        let signs = Signs::of(self, uses, live);
        let mut angles = vec![false; uses.len()];
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

    /// The nodes that `roots` need, in their order, without names and sections, and how often each of them is read.
    fn needed(&self, roots: &[ExprId]) -> (Self, Vec<u32>) {
        const BITS: usize = u64::BITS as usize;
        let end = roots.iter().map(|root| root.index() + 1).max().unwrap_or(0);
        let mut words = vec![0_u64; end.div_ceil(BITS)];
        for root in roots {
            words[root.index() / BITS] |= 1 << (root.index() % BITS);
        }
        // Children come before parents: one sweep from the end meets every node after all that read it.
        for word in (0..words.len()).rev() {
            let mut left = words[word];
            while left != 0 {
                let bit = BITS - 1 - left.leading_zeros() as usize;
                left ^= 1 << bit;
                self.nodes[word * BITS + bit].each_child(|child| {
                    let (of, bit) = (child.index() / BITS, child.index() % BITS);
                    words[of] |= 1 << bit;
                    left |= u64::from(of == word) << bit;
                });
            }
        }
        let mut count = 0;
        let before: Vec<usize> = words
            .iter()
            .map(|word| {
                let before = count;
                count += word.count_ones() as usize;
                before
            })
            .collect();
        let place = |id: ExprId| {
            let (word, bit) = (id.index() / BITS, id.index() % BITS);
            ExprId::new(before[word] + (words[word] & ((1 << bit) - 1)).count_ones() as usize)
        };
        let (mut nodes, mut uses) = (Vec::with_capacity(count), vec![0; count]);
        for root in roots {
            uses[place(*root).index()] += 1;
        }
        for (word, bits) in words.iter().enumerate() {
            let mut left = *bits;
            while left != 0 {
                let bit = left.trailing_zeros() as usize;
                left &= left - 1;
                let node = self.nodes[word * BITS + bit].of(place);
                node.each_child(|child| uses[child.index()] += 1);
                nodes.push(node);
            }
        }
        (Self { nodes, ..Self::default() }, uses)
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
