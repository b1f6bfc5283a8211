//! Passes that shorten one function: other expressions of the same values but for rounding.
//! In: a graph and roots. Out: [`Program`], a graph of its own. Never knows what is computed.
//!
//! Every pass is judged by [`Graph::operations`]: what does not get smaller is thrown away, so no function gets dearer.
//! Ties are broken by the order of nodes, so the result repeats.

mod equal;
mod factor;
mod formula;
mod program;
mod rebuild;
mod share;
mod terms;
mod unscaled;

use super::{ExprId, Graph};
use factor::factor;
use program::Whole;
use share::{share_products, share_sums};
use unscaled::{scaled_by_terms, unscaled};

pub use program::Program;

/// A pass; nothing if it finds nothing to do.
type Pass = fn(&Program) -> Option<Program>;

/// Orders of the passes: what one leaves decides what another finds. The shortest result counts, the first among equals.
const ORDERS: [[Pass; 4]; 2] =
    [[factor, share_sums, share_products, unscaled], [unscaled, factor, share_sums, share_products]];

/// Passes after those, which find less in what this takes apart.
const LATER: [Pass; 5] = [scaled_by_terms, factor, share_sums, share_products, unscaled];

/// Rounds of all passes at most; nothing shipped takes more than three.
const ROUNDS: usize = 4;

/// The function with these inputs (all symbols that it reads) and outputs, shortened.
pub fn shortened(graph: &Graph, inputs: &[ExprId], roots: &[ExprId]) -> Program {
    let whole = Whole { graph, inputs, roots };
    let merged = equal::merged(&whole);
    let whole = merged.operations();
    let (mut least, mut best) = passed((whole, &merged), &ORDERS[0]);
    for order in &ORDERS[1..] {
        // The same again if the first pass finds nothing.
        if let Some((count, program)) = begun((whole, &merged), order).filter(|(count, _)| *count < least) {
            (least, best) = (count, Some(program));
        }
    }
    let best = best.unwrap_or(merged);
    // The others have found all that there was.
    match begun((least, &best), &LATER) {
        Some((_, later)) => later,
        None => best,
    }
}

/// What rounds of the passes make of a program of so many operations, if the first of them makes it shorter.
fn begun((count, program): (usize, &Program), passes: &[Pass]) -> Option<(usize, Program)> {
    let first = passes[0](program).map(|first| (first.operations(), first));
    let (count, first) = first.filter(|(shorter, _)| *shorter < count)?;
    let (count, next) = passed((count, &first), passes);
    Some((count, next.unwrap_or(first)))
}

/// What rounds of the passes leave of a program of so many operations, each kept where it makes it shorter: how many
/// operations, and the program, if it has changed.
fn passed((count, program): (usize, &Program), passes: &[Pass]) -> (usize, Option<Program>) {
    let (mut best, mut least) = (None, count);
    // By pass: for how many operations it found nothing. Of the same program it would find nothing again.
    let mut nothing = vec![usize::MAX; passes.len()];
    for _ in 0..ROUNDS {
        let before = least;
        for (pass, nothing) in passes.iter().zip(&mut nothing) {
            if *nothing == least {
                continue;
            }
            let next = pass(best.as_ref().unwrap_or(program)).map(|next| (next.operations(), next));
            match next.filter(|(count, _)| *count < least) {
                Some((count, next)) => (best, least) = (Some(next), count),
                None => *nothing = least,
            }
        }
        if least == before {
            break;
        }
    }
    (least, best)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::{Expr, Scope};

    /// Operations before and after, with the outputs before and after at one point.
    fn shortened_at<const N: usize>(
        point: [f64; 4],
        build: impl for<'g> Fn([Expr<'g>; 4]) -> [Expr<'g>; N],
    ) -> ([usize; 2], [[f64; N]; 2]) {
        let g = Scope::new();
        let symbols = ["a", "b", "c", "d"].map(|name| g.symbol(name));
        let roots = build(symbols).map(Expr::id);
        let graph = g.into_graph();
        let short = shortened(&graph, &symbols_of(&graph), &roots);
        let values = |graph: &Graph, roots: &[ExprId]| {
            let all = graph.evaluate_all(&point);
            std::array::from_fn(|i| all[roots[i].index()])
        };
        let outputs = [values(&graph, &roots), values(&short.graph, &short.roots)];
        ([graph.operations(&roots), short.operations()], outputs)
    }

    fn symbols_of(graph: &Graph) -> Vec<ExprId> {
        (0..4).map(ExprId::new).inspect(|id| assert!(graph.as_symbol(*id).is_some())).collect()
    }

    #[test]
    fn common_factors_of_a_sum_are_taken_out() {
        let (counts, [before, after]) =
            shortened_at([2.0, 3.0, 5.0, 7.0], |[a, b, c, d]| [a * b + c * d - a * (c * c)]);
        assert_eq!(counts, [6, 5]);
        assert_eq!(before, after);
    }

    #[test]
    fn pairs_of_terms_in_several_sums_are_added_once() {
        let (counts, [before, after]) =
            shortened_at([2.0, 3.0, 5.0, 7.0], |[a, b, c, d]| [(a + c) - b, (a + d) - b, (b + c.sin()) - a]);
        assert_eq!(counts, [7, 5]);
        assert_eq!(before[..2], after[..2]);
        assert!((before[2] - after[2]).abs() < 1e-15);
    }

    #[test]
    fn a_value_that_something_else_reads_stays() {
        let (counts, [before, after]) =
            shortened_at([2.0, 3.0, 5.0, 7.0], |[a, b, c, _]| [a * b + a * c, a * b, (a * c).sqrt()]);
        assert_eq!(counts, [4, 4]);
        assert_eq!(before, after);
    }

    #[test]
    fn numbers_that_differ_by_rounding_are_one() {
        let (counts, _) =
            shortened_at([1.0; 4], |[a, b, ..]| [0.42 * a * b, (0.420_000_000_000_000_04 * a).sqrt()]);
        assert_eq!(counts, [4, 3]);
    }

    #[test]
    fn a_sum_is_scaled_by_terms_where_they_take_the_factor_for_nothing() {
        // 0.3 sin a is wanted besides, and 2 d is 0.6 d then.
        let (counts, [before, after]) = shortened_at([2.0, 3.0, 5.0, 7.0], |[a, b, c, d]| {
            [0.3 * (a.sin() * b - 2.0 * d), 0.3 * a.sin() - c]
        });
        assert_eq!(counts, [7, 6]);
        assert!((0..2).all(|i| (before[i] - after[i]).abs() < 1e-15));
        // The other term would take an operation for it.
        let (counts, _) = shortened_at([1.0; 4], |[a, b, c, d]| [0.3 * (a * b + c * d), 0.3 * a]);
        assert_eq!(counts, [5, 5]);
    }
}
