//! `a b + a c = a (b + c)`: a factor that most products of a sum have is taken out first.

use std::cmp::Reverse;

use super::formula::Formula;
use super::program::Program;
use super::terms::Kind;
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
    // Every sum is looked at and few have a common factor: no lists of its own for each.
    let (mut lists, mut counted) = (Lists::default(), Vec::new());
    for sum in program.terms(Kind::Sum).iter() {
        if sum.terms.iter().filter(|(_, id)| is_product(*id)).count() < 2 {
            continue;
        }
        lists.inner.clear();
        counted.clear();
        for (at, (_, id)) in sum.terms.iter().enumerate() {
            let factors = lists.factors(graph, uses, *id);
            counted.extend(factors.iter().filter(|_| factors.len() > 1).map(|factor| (*factor, at)));
        }
        if most_counted(&mut counted).is_some() {
            found = true;
            lists.inner.iter().chain(sum.inner).for_each(|id| left_out[id.index()] = true);
            let products =
                sum.terms.iter().map(|(negative, id)| (*negative, lists.factors(graph, uses, *id).to_vec()));
            formulas[sum.root.index()] = Some(Formula::Sum(grouped(products.collect())));
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

/// Lists that are filled anew for every term.
#[derive(Default)]
struct Lists {
    factors: Vec<ExprId>,
    /// Products that only the sum reads.
    inner: Vec<ExprId>,
    stack: Vec<ExprId>,
}

impl Lists {
    /// Factors of a term; the products that only it reads come to the others.
    fn factors(&mut self, graph: &Graph, uses: &[u32], id: ExprId) -> &[ExprId] {
        self.factors.clear();
        self.stack.push(id);
        while let Some(id) = self.stack.pop() {
            match graph.node(id) {
                Node::Binary(Binary::Mul, a, b) if uses[id.index()] == 1 => {
                    self.inner.push(id);
                    self.stack.extend([b, a]);
                }
                _ => self.factors.push(id),
            }
        }
        &self.factors
    }
}

/// The factor of most products, if several have it; the first made among equals.
fn commonest(products: &[Product]) -> Option<ExprId> {
    let several = products.iter().enumerate().filter(|(_, (_, factors))| factors.len() > 1);
    let mut all: Vec<(ExprId, usize)> =
        several.flat_map(|(at, (_, factors))| factors.iter().map(move |factor| (*factor, at))).collect();
    most_counted(&mut all)
}

/// The same of factors, each with the number of its product.
fn most_counted(all: &mut Vec<(ExprId, usize)>) -> Option<ExprId> {
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
