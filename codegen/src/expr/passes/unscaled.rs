//! `c (a + b / c) = c a + b`: a term of a scaled sum that was scaled the other way before is taken as it is. And
//! `c (k a + x y) = (c k) a + (c x) y` where `c x` is there anyway: terms that all take the factor for nothing take it.

use super::formula::Formula;
use super::program::Program;
use super::terms::{Kind, Terms};
use crate::expr::{Binary, ExprId, Graph, Node};

/// Two numbers whose product is one but for this are reciprocals: a few roundings of either.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Products in a product that are looked through.
const DEPTH: usize = 4;

/// Takes terms that were scaled the other way out of sums that only a product with a number reads.
pub fn unscaled(program: &Program) -> Option<Program> {
    by_terms(program, |factor, sum| factor.undoes(sum))
}

/// Scales sums term by term where no term takes an operation for that.
pub fn scaled_by_terms(program: &Program) -> Option<Program> {
    by_terms(program, |factor, sum| factor.passes(sum))
}

/// Makes every product of a number and a sum that nothing else reads anew, if `times` tells how.
fn by_terms(program: &Program, times: fn(&Factor<'_>, &Terms<'_>) -> Option<Formula>) -> Option<Program> {
    let (graph, uses) = (&program.graph, program.uses());
    let formula = |product: usize| {
        let (number, sum) = by_number(graph, ExprId::new(product)).filter(|_| uses[product] > 0)?;
        let sum = program.terms(Kind::Sum).of(sum).filter(|sum| uses[sum.root.index()] == 1)?;
        Some((ExprId::new(product), times(&Factor { graph, uses, number }, &sum)?))
    };
    let formulas: Vec<(ExprId, Formula)> = (0..uses.len()).filter_map(formula).collect();
    let mut next = formulas.iter().peekable();
    (!formulas.is_empty()).then(|| {
        program.rebuilt(|rebuild, id| match next.next_if(|(product, _)| *product == id) {
            Some((_, formula)) => {
                let new = formula.make(rebuild);
                rebuild.set(id, new);
            }
            None => rebuild.again(id),
        })
    })
}

/// A number that scales a sum.
struct Factor<'a> {
    graph: &'a Graph,
    uses: &'a [u32],
    number: f64,
}

impl Factor<'_> {
    /// It times a sum, where some terms were scaled the other way.
    fn undoes(&self, sum: &Terms<'_>) -> Option<Formula> {
        let (mut scaled, mut plain) = (Vec::new(), Vec::new());
        for (negative, term) in sum.terms {
            match self.undone(*term) {
                Some(term) => plain.push((*negative, Formula::Node(term))),
                None => scaled.push((*negative, Formula::Node(*term))),
            }
        }
        if plain.is_empty() {
            return None;
        }
        let scaled = Formula::Product(vec![Formula::Number(self.number), Formula::Sum(scaled)]);
        Some(Formula::Sum(std::iter::once((false, scaled)).chain(plain).collect()))
    }

    /// It times a sum, where every term takes it for nothing.
    fn passes(&self, sum: &Terms<'_>) -> Option<Formula> {
        let taken = |(negative, term): &(bool, ExprId)| Some((*negative, self.taken(*term, DEPTH)?));
        sum.terms.iter().map(taken).collect::<Option<_>>().map(Formula::Sum)
    }

    /// What it makes of a term that was scaled the other way. Numbers in products are positive.
    fn undone(&self, term: ExprId) -> Option<ExprId> {
        let (number, plain) = by_number(self.graph, term)?;
        ((number * self.number - 1.0).abs() <= ROUNDING).then_some(plain)
    }

    /// It times a term, if that takes no operation more than the term.
    fn taken(&self, term: ExprId, depth: usize) -> Option<Formula> {
        if let Some(plain) = self.undone(term) {
            return Some(Formula::Node(plain));
        }
        let number = Formula::Number(self.number);
        if self.is_there(term) {
            return Some(Formula::Product(vec![number, Formula::Node(term)]));
        }
        let Node::Binary(Binary::Mul, a, b) = self.graph.node(term) else { return None };
        if self.uses[term.index()] != 1 || depth == 0 {
            return None;
        }
        if let Some((other, plain)) = by_number(self.graph, term) {
            return Some(Formula::Product(vec![Formula::Number(self.number * other), Formula::Node(plain)]));
        }
        [(a, b), (b, a)].into_iter().find_map(|(one, other)| {
            Some(Formula::Product(vec![self.taken(one, depth - 1)?, Formula::Node(other)]))
        })
    }

    /// Whether something needs it times a term already.
    fn is_there(&self, term: ExprId) -> bool {
        let product = self.graph.scaled(self.number, term);
        product.is_some_and(|product| self.uses[product.index()] > 0)
    }
}

/// A product with a number: the number and the other factor.
fn by_number(graph: &Graph, id: ExprId) -> Option<(f64, ExprId)> {
    let Node::Binary(Binary::Mul, a, b) = graph.node(id) else { return None };
    [(a, b), (b, a)].into_iter().find_map(|(number, other)| Some((graph.as_constant(number)?, other)))
}
