//! `a b + a c = a (b + c)`: a factor that most products of a sum have is taken out first.

use std::cmp::Reverse;

use super::formula::Formula;
use super::program::Program;
use super::terms::{Kind, terms};
use crate::expr::{Binary, ExprId, Graph, Node};

/// A product with its sign; `true` subtracts.
type Product = (bool, Vec<ExprId>);

/// Takes common factors out of every sum, of products that only the sum reads.
pub fn factor(program: &Program) -> Option<Program> {
    let (graph, uses) = (&program.graph, program.uses());
    let mut formulas: Vec<Option<Formula>> = vec![None; uses.len()];
    let mut left_out = vec![false; uses.len()];
    let mut found = false;
    let is_product =
        |id: ExprId| uses[id.index()] == 1 && matches!(graph.node(id), Node::Binary(Binary::Mul, ..));
    for sum in terms(graph, &uses, Kind::Sum) {
        if sum.terms.iter().filter(|(_, id)| is_product(*id)).count() < 2 {
            continue;
        }
        let mut inner = sum.inner;
        let products: Vec<Product> = sum
            .terms
            .iter()
            .map(|(negative, id)| (*negative, factors(graph, &uses, *id, &mut inner)))
            .collect();
        if commonest(&products).is_some() {
            found = true;
            formulas[sum.root.index()] = Some(Formula::Sum(grouped(products)));
            inner.iter().for_each(|id| left_out[id.index()] = true);
        }
    }
    found.then(|| {
        program.rebuilt(|rebuild, id| match &formulas[id.index()] {
            Some(formula) => {
                let new = formula.make(rebuild);
                rebuild.set(id, new);
            }
            None if left_out[id.index()] => {}
            None => rebuild.again(id),
        })
    })
}

/// Factors of a term; the products that only it reads go to `inner`.
fn factors(graph: &Graph, uses: &[u32], id: ExprId, inner: &mut Vec<ExprId>) -> Vec<ExprId> {
    let mut factors = Vec::new();
    let mut stack = vec![id];
    while let Some(id) = stack.pop() {
        match graph.node(id) {
            Node::Binary(Binary::Mul, a, b) if uses[id.index()] == 1 => {
                inner.push(id);
                stack.extend([b, a]);
            }
            _ => factors.push(id),
        }
    }
    factors
}

/// The factor of most products, if several have it; the first made among equals.
fn commonest(products: &[Product]) -> Option<ExprId> {
    let several = products.iter().enumerate().filter(|(_, (_, factors))| factors.len() > 1);
    let mut all: Vec<(ExprId, usize)> =
        several.flat_map(|(at, (_, factors))| factors.iter().map(move |factor| (*factor, at))).collect();
    all.sort_unstable();
    // Of a square, one factor counts.
    all.dedup();
    let counts = all.chunk_by(|one, other| one.0 == other.0).map(|same| (same.len(), Reverse(same[0].0)));
    counts.filter(|(count, _)| *count > 1).max().map(|(_, Reverse(id))| id)
}

fn grouped(products: Vec<Product>) -> Vec<(bool, Formula)> {
    let Some(common) = commonest(&products) else {
        return products.into_iter().map(|(negative, factors)| (negative, product(factors))).collect();
    };
    let (with, without): (Vec<Product>, Vec<Product>) =
        products.into_iter().partition(|(_, factors)| factors.len() > 1 && factors.contains(&common));
    let others = with.into_iter().map(|(negative, mut factors)| {
        if let Some(at) = factors.iter().position(|factor| *factor == common) {
            factors.remove(at);
        }
        (negative, factors)
    });
    let taken_out = Formula::Product(vec![Formula::Node(common), Formula::Sum(grouped(others.collect()))]);
    let mut terms = vec![(false, taken_out)];
    terms.extend(grouped(without));
    terms
}

fn product(factors: Vec<ExprId>) -> Formula {
    Formula::Product(factors.into_iter().map(Formula::Node).collect())
}
