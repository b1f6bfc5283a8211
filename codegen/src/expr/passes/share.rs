//! A pair of terms that several sums have is added once, and a pair of factors that several products have multiplied once: the
//! pair of most sums first.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use rustc_hash::FxHashMap;

use super::program::Program;
use super::rebuild::Rebuild;
use super::terms::{Kind, Terms};
use crate::expr::{Expr, ExprId};

/// A term: an old node, or behind those a pair by its number.
type Term = u32;

/// Two terms, the first made first, and whether their signs differ.
type Pair = (Term, Term, bool);

/// Adds pairs that several sums have once.
pub fn share_sums(program: &Program) -> Option<Program> {
    share(program, Kind::Sum)
}

/// Multiplies pairs that several products have once.
pub fn share_products(program: &Program) -> Option<Program> {
    share(program, Kind::Product)
}

fn share(program: &Program, kind: Kind) -> Option<Program> {
    let uses = program.uses();
    let sums: Vec<Terms<'_>> = program.terms(kind).iter().collect();
    let mut sharing = Sharing::new(kind, &sums, uses.len());
    sharing.run();
    if sharing.pairs.is_empty() {
        return None;
    }
    let mut changed: Vec<Option<usize>> = vec![None; uses.len()];
    let mut left_out = vec![false; uses.len()];
    for (at, sum) in sums.iter().enumerate().filter(|(at, _)| sharing.changed[*at]) {
        changed[sum.root.index()] = Some(at);
        sum.inner.iter().for_each(|id| left_out[id.index()] = true);
    }
    // Pairs by node of the new graph, made where the first sum needs them.
    let mut made: Vec<Option<ExprId>> = vec![None; sharing.pairs.len()];
    Some(program.rebuilt(|rebuild, id| match changed[id.index()] {
        Some(at) => {
            let mut joined = rebuild.scope.number(if kind == Kind::Sum { 0.0 } else { 1.0 });
            for (negative, term) in &sharing.terms[at] {
                let term = sharing.term(rebuild, &mut made, *term);
                joined = join(kind, joined, term, *negative);
            }
            rebuild.set(id, joined);
        }
        None if left_out[id.index()] => {}
        None => rebuild.again(id),
    }))
}

fn join<'g>(kind: Kind, one: Expr<'g>, other: Expr<'g>, negative: bool) -> Expr<'g> {
    match kind {
        Kind::Product => one * other,
        Kind::Sum if negative => one - other,
        Kind::Sum => one + other,
    }
}

/// Sums while their pairs are being found.
struct Sharing {
    kind: Kind,
    /// Old nodes.
    nodes: usize,
    /// Signed terms of every sum that may have a common pair.
    terms: Vec<Vec<(bool, Term)>>,
    changed: Vec<bool>,
    /// Sums that had the pair when it was found.
    places: FxHashMap<Pair, Vec<u32>>,
    /// By number of sums, then the first made.
    queue: BinaryHeap<(usize, Reverse<Pair>)>,
    /// Chosen, in order.
    pairs: Vec<Pair>,
}

impl Sharing {
    fn new(kind: Kind, sums: &[Terms<'_>], nodes: usize) -> Self {
        // What one sum has alone is in no common pair.
        let mut sums_with = vec![0_u32; nodes];
        for (_, term) in sums.iter().flat_map(|sum| sum.terms) {
            sums_with[term.index()] += 1;
        }
        let mut sharing = Self {
            kind,
            nodes,
            changed: vec![false; sums.len()],
            terms: vec![Vec::new(); sums.len()],
            places: FxHashMap::default(),
            queue: BinaryHeap::new(),
            pairs: Vec::new(),
        };
        let signed = |(negative, id): &(bool, ExprId)| -> (bool, Term) { (*negative, id.number()) };
        let mut common: Vec<(bool, Term)> = Vec::new();
        for (at, sum) in sums.iter().enumerate() {
            common.clear();
            common.extend(sum.terms.iter().map(signed).filter(|(_, term)| sums_with[*term as usize] > 1));
            if common.len() > 1 {
                sharing.terms[at].extend(sum.terms.iter().map(signed));
            }
            for (position, first) in common.iter().enumerate() {
                for second in &common[position + 1..] {
                    sharing.note(at, pair(*first, *second));
                }
            }
        }
        sharing.queue = sharing
            .places
            .iter()
            .filter(|(_, at)| at.len() > 1)
            .map(|(pair, at)| (at.len(), Reverse(*pair)))
            .collect();
        sharing
    }

    fn note(&mut self, sum: usize, pair: Pair) {
        let places = self.places.entry(pair).or_default();
        // Sums are fewer than nodes, which are counted in 32 bits.
        let sum = u32::try_from(sum).unwrap_or(u32::MAX);
        if places.last() != Some(&sum) {
            places.push(sum);
        }
    }

    fn run(&mut self) {
        while let Some((count, Reverse(pair))) = self.queue.pop() {
            let mut places = self.places.get(&pair).cloned().unwrap_or_default();
            places.retain(|at| find(&self.terms[*at as usize], pair).is_some());
            if places.len() == count {
                self.take(pair, &places);
            } else if places.len() > 1 {
                self.queue.push((places.len(), Reverse(pair)));
                self.places.insert(pair, places);
            }
        }
    }

    /// Puts the pair as one new term into every sum that has it.
    fn take(&mut self, chosen: Pair, places: &[u32]) {
        let Ok(new) = Term::try_from(self.nodes + self.pairs.len()) else { return };
        self.pairs.push(chosen);
        let mut found: Vec<Pair> = Vec::new();
        for at in places.iter().map(|at| *at as usize) {
            let Some([first, second]) = find(&self.terms[at], chosen) else { continue };
            // The sign of the pair is that of its first made term.
            let terms = &mut self.terms[at];
            let negative = terms[first].0;
            terms[first.min(second)] = (negative, new);
            terms.remove(first.max(second));
            self.changed[at] = true;
            let others: Vec<Pair> = terms
                .iter()
                .filter(|(_, term)| *term != new)
                .map(|other| pair(*other, (negative, new)))
                .collect();
            for pair in others {
                self.note(at, pair);
                found.push(pair);
            }
        }
        found.sort_unstable();
        found.dedup();
        for pair in found {
            let count = self.places[&pair].len();
            if count > 1 {
                self.queue.push((count, Reverse(pair)));
            }
        }
    }

    /// The node of a term in the new graph.
    fn term<'g>(&self, rebuild: &Rebuild<'_, 'g>, made: &mut [Option<ExprId>], term: Term) -> Expr<'g> {
        let Some(number) = (term as usize).checked_sub(self.nodes) else {
            return rebuild.get(ExprId::new(term as usize));
        };
        if let Some(id) = made[number] {
            return rebuild.scope.zero().at(id);
        }
        let (first, second, differ) = self.pairs[number];
        let [first, second] = [first, second].map(|term| self.term(rebuild, made, term));
        let sum = join(self.kind, first, second, differ);
        made[number] = Some(sum.id());
        sum
    }
}

fn pair(a: (bool, Term), b: (bool, Term)) -> Pair {
    (a.1.min(b.1), a.1.max(b.1), a.0 != b.0)
}

/// Where a sum has both terms of a pair.
fn find(terms: &[(bool, Term)], (first, second, differ): Pair) -> Option<[usize; 2]> {
    let at = terms.iter().position(|(_, term)| *term == first)?;
    let wanted = (terms[at].0 != differ, second);
    let other = terms.iter().enumerate().position(|(other, term)| other != at && *term == wanted)?;
    Some([at, other])
}
