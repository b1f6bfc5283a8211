//! What a turn and the same turn back leave: `c (c a + s b) + s (s a - c b)` is `a` where c and s are cosine and sine of one
//! angle, because `c² + s²` is one.

use super::expression::Expr;
use super::{Binary, ExprId, Node, Unary};

/// A factor with its sign; nothing is zero.
type Part = Option<(ExprId, bool)>;

/// Cosine or sine of an angle.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Circular {
    Cosine,
    Sine,
}

fn circular(x: Expr<'_>) -> Option<(Circular, ExprId)> {
    match x.node() {
        Node::Unary(Unary::Cos, angle) => Some((Circular::Cosine, angle)),
        Node::Unary(Unary::Sin, angle) => Some((Circular::Sine, angle)),
        _ => None,
    }
}

/// Every way to see a product as cosine or sine times something.
fn products<'g>(x: Expr<'g>) -> impl Iterator<Item = (Circular, ExprId, Expr<'g>)> {
    let pair = match x.node() {
        Node::Binary(Binary::Mul, a, b) => Some((x.at(a), x.at(b))),
        _ => None,
    };
    let both = pair.into_iter().flat_map(|(a, b)| [(a, b), (b, a)]);
    both.filter_map(|(factor, other)| circular(factor).map(|(kind, angle)| (kind, angle, other)))
}

/// What cosine and sine of `angle` are multiplied with in `x`, if it is a sum of such products.
fn parts(x: Expr<'_>, angle: ExprId, negated: bool) -> Option<[Part; 2]> {
    let terms = match x.node() {
        Node::Binary(Binary::Add, a, b) => [Some((a, negated)), Some((b, negated))],
        Node::Binary(Binary::Sub, a, b) => [Some((a, negated)), Some((b, !negated))],
        _ => [Some((x.id(), negated)), None],
    };
    let mut found = [None; 2];
    for (term, negated) in terms.into_iter().flatten() {
        let (kind, _, other) = products(x.at(term)).find(|(_, of, _)| *of == angle)?;
        let place = &mut found[usize::from(kind == Circular::Sine)];
        if place.replace((other.id(), negated)).is_some() {
            return None;
        }
    }
    Some(found)
}

fn opposite(part: Part) -> Part {
    part.map(|(id, negated)| (id, !negated))
}

impl Expr<'_> {
    /// `self + other`, or `self - other`, if it is what a turn and the same turn back leave.
    pub(super) fn turned_back(self, other: Self, difference: bool) -> Option<Self> {
        for (kind, angle, inner) in products(self) {
            for (other_kind, other_angle, other_inner) in products(other) {
                if kind == other_kind || angle != other_angle {
                    continue;
                }
                let [(of_cosine, minus_cosine), (of_sine, minus_sine)] = match kind {
                    Circular::Cosine => [(inner, false), (other_inner, difference)],
                    Circular::Sine => [(other_inner, difference), (inner, false)],
                };
                let by_cosine = parts(of_cosine, angle, minus_cosine);
                let by_sine = parts(of_sine, angle, minus_sine);
                let (Some([a, b]), Some([b_back, a_again])) = (by_cosine, by_sine) else { continue };
                // c (c a + s b) + s (s a - c b)
                if a == a_again && b == opposite(b_back) {
                    let zero = self.scope().zero();
                    return Some(a.map_or(zero, |(id, negated)| self.at(id).with_sign(negated)));
                }
            }
        }
        None
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
