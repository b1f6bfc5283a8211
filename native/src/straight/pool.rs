//! Constants in memory. In: a graph and an order. Out: the numbers, and where each constant lies.

use rustc_hash::FxHashMap;

use super::graph::{Graph, Id, Operation};
use super::place::{Address, Base};

/// Lays out what `order` and `outputs` read; `copies_read_by` tells how many copies side by side an operation reads, or an
/// output; a constant that stands side by side with itself has so many.
pub(super) fn lay_out(
    graph: &Graph,
    order: &[Id],
    outputs: &[Id],
    copies_read_by: impl Fn(Option<Operation>) -> usize,
) -> (Vec<u64>, FxHashMap<Id, Address>) {
    let mut copies: Vec<(Id, u64, usize)> = Vec::new();
    let mut place: FxHashMap<Id, usize> = FxHashMap::default();
    let mut read = |id: Id, count: usize| {
        if let Operation::Constant(bits) = graph.node(id).operation {
            let at = *place.entry(id).or_insert_with(|| {
                copies.push((id, bits, 0));
                copies.len() - 1
            });
            copies[at].2 = copies[at].2.max(count).max(graph.node(id).width());
        }
    };
    for id in outputs {
        read(*id, copies_read_by(None));
    }
    for id in order {
        let node = graph.node(*id);
        let count = copies_read_by(Some(node.operation));
        for argument in node.arguments() {
            read(*argument, count);
        }
    }
    // Longer ones first: each then lies at a multiple of its length, as the pool does.
    copies.sort_by_key(|(_, _, count)| std::cmp::Reverse(*count));
    let mut pool = Vec::new();
    let mut addresses = FxHashMap::with_capacity_and_hasher(copies.len(), Default::default());
    for (id, bits, count) in copies {
        let offset = (size_of::<u64>() * pool.len()) as i32;
        addresses.insert(id, Address { base: Base::Pool, offset });
        pool.extend(std::iter::repeat_n(bits, count));
    }
    (pool, addresses)
}
