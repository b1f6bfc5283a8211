//! `c (a + b / c) = c a + b`: a term of a scaled sum that was scaled the other way before is taken as it is.

use super::program::Program;
use super::terms::{Kind, Terms, terms};
use crate::expr::{Binary, ExprId, Graph, Node};

/// Two numbers whose product is one but for this are reciprocals: a few roundings of either.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// A scaled sum: which of its terms are left to be scaled, and which are taken as they are.
struct Scaled {
    factor: f64,
    scaled: Vec<(bool, ExprId)>,
    plain: Vec<(bool, ExprId)>,
}

/// Takes terms out of sums that only a product with a number reads.
pub fn unscaled(program: &Program) -> Option<Program> {
    let (graph, uses) = (&program.graph, program.uses());
    let list = terms(graph, &uses, Kind::Sum);
    let mut sums: Vec<Option<Terms<'_>>> = vec![None; uses.len()];
    list.iter().for_each(|sum| sums[sum.root.index()] = Some(sum));
    let mut formulas: Vec<Option<Scaled>> = (0..uses.len()).map(|_| None).collect();
    let mut left_out = vec![false; uses.len()];
    let mut found = false;
    for index in (0..uses.len()).filter(|index| uses[*index] > 0) {
        let Some((factor, inner)) = by_number(graph, ExprId::new(index)) else { continue };
        let Some(sum) = sums[inner.index()].as_ref().filter(|_| uses[inner.index()] == 1) else { continue };
        let mut formula = Scaled { factor, scaled: Vec::new(), plain: Vec::new() };
        for (negative, term) in sum.terms {
            match by_number(graph, *term) {
                // What is made anew itself stays as it is.
                Some((number, plain))
                    if formulas[term.index()].is_none()
                        && ((number * factor).abs() - 1.0).abs() <= ROUNDING =>
                {
                    formula.plain.push((*negative != (number * factor < 0.0), plain));
                }
                _ => formula.scaled.push((*negative, *term)),
            }
        }
        if !formula.plain.is_empty() {
            found = true;
            formulas[index] = Some(formula);
            left_out[inner.index()] = true;
            sum.inner.iter().for_each(|id| left_out[id.index()] = true);
        }
    }
    found.then(|| {
        program.rebuilt(|rebuild, id| match &formulas[id.index()] {
            Some(formula) => {
                let add = |terms: &[(bool, ExprId)], first| {
                    terms.iter().fold(first, |sum, (negative, term)| {
                        let term = rebuild.get(*term);
                        if *negative { sum - term } else { sum + term }
                    })
                };
                let scaled = formula.factor * add(&formula.scaled, rebuild.scope.zero());
                let new = add(&formula.plain, scaled);
                rebuild.set(id, new);
            }
            None if left_out[id.index()] => {}
            None => rebuild.again(id),
        })
    })
}

/// A product with a number: the number and the other factor.
fn by_number(graph: &Graph, id: ExprId) -> Option<(f64, ExprId)> {
    let Node::Binary(Binary::Mul, a, b) = graph.node(id) else { return None };
    [(a, b), (b, a)].into_iter().find_map(|(number, other)| Some((graph.as_constant(number)?, other)))
}
