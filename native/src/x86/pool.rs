//! Constants in memory. In: a graph and an order. Out: the numbers, and where each constant lies.

use std::collections::HashMap;

use super::graph::{Graph, Id, Operation};
use super::instruction::{Address, Base, Lanes};

/// Lays out what `order` and `outputs` read.
///
/// Four lanes read four copies. Eight lanes read one, which their instructions spread, except where a called function
/// wants all eight. Bitwise operations of one lane read 16 bytes.
pub(super) fn lay_out(
    graph: &Graph,
    order: &[Id],
    outputs: &[Id],
    lanes: Lanes,
) -> (Vec<u64>, HashMap<Id, Address>) {
    let mut copies: Vec<(Id, u64, usize)> = Vec::new();
    let mut place: HashMap<Id, usize> = HashMap::new();
    let mut read = |id: Id, count: usize| {
        if let Operation::Constant(bits) = graph.node(id).operation {
            let at = *place.entry(id).or_insert_with(|| {
                copies.push((id, bits, 0));
                copies.len() - 1
            });
            copies[at].2 = copies[at].2.max(count);
        }
    };
    for id in outputs {
        read(*id, if lanes == Lanes::Four { 4 } else { 1 });
    }
    for id in order {
        let node = graph.node(*id);
        let count = match (lanes, node.operation) {
            (Lanes::One, operation) => 1 + usize::from(operation.is_bitwise()),
            (Lanes::Four, _) => 4,
            (Lanes::Eight, Operation::Call(_)) => 8,
            (Lanes::Eight, _) => 1,
        };
        for argument in node.arguments() {
            read(*argument, count);
        }
    }
    // Longer ones first: each then lies at a multiple of its length, as the pool does.
    copies.sort_by_key(|(_, _, count)| std::cmp::Reverse(*count));
    let mut pool = Vec::new();
    let mut addresses = HashMap::with_capacity(copies.len());
    for (id, bits, count) in copies {
        let offset = (size_of::<u64>() * pool.len()) as i32;
        addresses.insert(id, Address { base: Base::Pool, offset });
        pool.extend(std::iter::repeat_n(bits, count));
    }
    (pool, addresses)
}
