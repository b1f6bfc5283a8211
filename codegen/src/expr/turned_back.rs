//! What a turn and the same turn back leave: `c (c a + s b) + s (s a - c b)` is `a` where c and s are cosine and sine of one
//! angle, because `c² + s²` is one.

use super::expression::Expr;
use super::{Binary, ExprId, Graph, Node, Unary};

/// A factor with its sign; nothing is zero.
type Part = Option<(ExprId, bool)>;

/// Cosine or sine of an angle.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Circular {
    Cosine,
    Sine,
}

impl Graph {
    fn circular(&self, x: ExprId) -> Option<(Circular, ExprId)> {
        match self.node(x) {
            Node::Unary(Unary::Cos, angle) => Some((Circular::Cosine, angle)),
            Node::Unary(Unary::Sin, angle) => Some((Circular::Sine, angle)),
            _ => None,
        }
    }

    /// What cosine or sine of `angle` is multiplied with in a product.
    fn beside(&self, product: ExprId, angle: ExprId) -> Option<(Circular, ExprId)> {
        let Node::Binary(Binary::Mul, a, b) = self.node(product) else { return None };
        let of = |factor, other| {
            let (kind, _) = self.circular(factor).filter(|(_, of)| *of == angle)?;
            Some((kind, other))
        };
        of(a, b).or_else(|| of(b, a))
    }

    /// What cosine and sine of `angle` are multiplied with in `x`, if it is a sum of such products.
    fn parts(&self, x: ExprId, angle: ExprId, negated: bool) -> Option<[Part; 2]> {
        let terms = match self.node(x) {
            Node::Binary(Binary::Add, a, b) => [Some((a, negated)), Some((b, negated))],
            Node::Binary(Binary::Sub, a, b) => [Some((a, negated)), Some((b, !negated))],
            _ => [Some((x, negated)), None],
        };
        let mut found = [None; 2];
        for (term, negated) in terms.into_iter().flatten() {
            let (kind, other) = self.beside(term, angle)?;
            let place = &mut found[usize::from(kind == Circular::Sine)];
            if place.replace((other, negated)).is_some() {
                return None;
            }
        }
        Some(found)
    }

    /// The sum or difference of two products, if it is what a turn and the same turn back leave.
    fn turned_back(&self, one: ExprId, other: ExprId, difference: bool) -> Option<Part> {
        let (Node::Binary(Binary::Mul, a, b), Node::Binary(Binary::Mul, c, d)) =
            (self.node(one), self.node(other))
        else {
            return None;
        };
        for (factor, inner) in [(a, b), (b, a)] {
            let Some((kind, angle)) = self.circular(factor) else { continue };
            for (other_factor, other_inner) in [(c, d), (d, c)] {
                let Some((other_kind, other_angle)) = self.circular(other_factor) else { continue };
                if kind == other_kind || angle != other_angle {
                    continue;
                }
                let [(of_cosine, minus_cosine), (of_sine, minus_sine)] = match kind {
                    Circular::Cosine => [(inner, false), (other_inner, difference)],
                    Circular::Sine => [(other_inner, difference), (inner, false)],
                };
                let Some([a, b]) = self.parts(of_cosine, angle, minus_cosine) else { continue };
                let Some([b_back, a_again]) = self.parts(of_sine, angle, minus_sine) else { continue };
                // c (c a + s b) + s (s a - c b)
                if a == a_again && b == opposite(b_back) {
                    return Some(a);
                }
            }
        }
        None
    }
}

fn opposite(part: Part) -> Part {
    part.map(|(id, negated)| (id, !negated))
}

impl Expr<'_> {
    /// `self + other`, or `self - other`, if it is what a turn and the same turn back leave.
    pub(super) fn turned_back(self, other: Self, difference: bool) -> Option<Self> {
        let left = self.scope().make(|g| g.turned_back(self.id(), other.id(), difference))?;
        Some(left.map_or_else(|| self.scope().zero(), |(id, negated)| self.at(id).with_sign(negated)))
    }
}

#[cfg(test)]
mod tests {
    use crate::expr::Scope;

    #[test]
    fn turns_and_the_same_turns_back_leave_what_was_there() {
        let g = Scope::new();
        let [a, b, angle] = ["a", "b", "angle"].map(|name| g.symbol(name));
        let (s, c) = (angle.sin(), angle.cos());
        for (a, b) in [(a, b), (b, a), (-a, b), (a, -b), (a, g.zero())] {
            let (x, y) = (c * a - s * b, s * a + c * b);
            assert_eq!((c * x + s * y).id(), a.id());
            assert_eq!((c * y - s * x).id(), b.id());
            assert_eq!((s * x - c * y).id(), (-b).id());
            let (x, y) = (c * a + s * b, c * b - s * a);
            assert_eq!((c * x - s * y).id(), a.id());
            assert_eq!((s * x + c * y).id(), b.id());
        }
    }

    #[test]
    fn other_turns_stay() {
        let g = Scope::new();
        let [a, b, first, second] = ["a", "b", "first", "second"].map(|name| g.symbol(name));
        let (s, c) = (first.sin(), first.cos());
        let (x, y) = (c * a - s * b, s * a + c * b);
        for sum in [c * x - s * y, second.cos() * x + second.sin() * y, c * x + s * x] {
            assert!([a, b, -a, -b].iter().all(|other| other.id() != sum.id()));
        }
    }
}
