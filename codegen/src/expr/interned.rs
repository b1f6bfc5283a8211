//! Which nodes there are already. In: nodes in the order of their ids. Out: ids. Never knows what nodes mean.
//!
//! A table of ids alone, since the graph has the nodes: half of a derivation is spent here, most of it waiting for memory.

use super::node::Node;
use crate::id::ExprId;

/// Slots of a small table.
const FEWEST: usize = 256;

/// A large odd number without pattern, by which products fill all high bits.
const MIX: u64 = 0x9E37_79B9_7F4A_7C15;

/// The ids of all nodes by what the nodes are.
#[derive(Clone, Debug, Default)]
pub(super) struct Interned {
    /// One more than an id, or 0; a power of two of them, at most half of them used.
    slots: Vec<u32>,
    used: usize,
}

impl Interned {
    /// For about as many nodes without growing.
    pub fn with_capacity(nodes: usize) -> Self {
        Self { slots: vec![0; (2 * nodes).next_power_of_two().max(FEWEST)], used: 0 }
    }

    /// The id of a node that is there.
    pub fn get(&self, nodes: &[Node], node: Node) -> Option<ExprId> {
        if self.slots.is_empty() {
            return None;
        }
        let slot = self.slots[self.slot(nodes, node)];
        (slot > 0).then(|| ExprId::new(slot as usize - 1))
    }

    /// Adds the last of the nodes, which is not there yet.
    pub fn insert(&mut self, nodes: &[Node], id: ExprId) {
        if 2 * (self.used + 1) > self.slots.len() {
            let grown = Self::with_capacity(2 * nodes.len());
            *self = (0..id.index()).fold(grown, |mut grown, index| {
                grown.put(nodes, ExprId::new(index));
                grown
            });
        }
        self.put(nodes, id);
    }

    fn put(&mut self, nodes: &[Node], id: ExprId) {
        let slot = self.slot(nodes, nodes[id.index()]);
        self.slots[slot] = id.number() + 1;
        self.used += 1;
    }

    /// Where a node is, or the free slot where it belongs: the first from its own on, round the end.
    fn slot(&self, nodes: &[Node], node: Node) -> usize {
        let last = self.slots.len() - 1;
        let mut at = hash(node) as usize & last;
        loop {
            let slot = self.slots[at] as usize;
            if slot == 0 || nodes[slot - 1] == node {
                return at;
            }
            at = (at + 1) & last;
        }
    }
}

fn hash(node: Node) -> u64 {
    let pair = |a: ExprId, b: ExprId| u64::from(a.number()) << 32 | u64::from(b.number());
    let (kind, rest) = match node {
        Node::Constant(bits) => (0, bits),
        Node::Symbol(id) => (1, u64::from(id.number())),
        Node::Unary(operation, a) => (2 + 8 * operation.number(), u64::from(a.number())),
        Node::Binary(operation, a, b) => (3 + 8 * operation as u64, pair(a, b)),
        Node::Select(a, yes, no) => (4 + 8 * u64::from(a.number()), pair(yes, no)),
    };
    let mixed = (rest ^ kind.wrapping_mul(MIX)).wrapping_mul(MIX);
    // The low bits of a product know the low bits of its factors only.
    let mixed = (mixed ^ mixed >> 32).wrapping_mul(MIX);
    mixed ^ mixed >> 32
}

#[cfg(test)]
mod tests {
    use crate::expr::Scope;

    #[test]
    fn every_node_is_found_again_however_many_there_are() {
        let g = Scope::new();
        let x = g.symbol("x");
        let made: Vec<_> = (0..2000).map(|i| (x * f64::from(i)).sin() + f64::from(i)).collect();
        let size = g.size();
        for (i, first) in (0..).zip(&made) {
            assert_eq!(((x * f64::from(i)).sin() + f64::from(i)).id(), first.id());
        }
        assert_eq!(g.size(), size);
    }
}
