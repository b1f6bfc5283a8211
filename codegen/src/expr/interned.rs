//! Which nodes there are already. In: nodes in the order of their ids. Out: ids. Never knows what nodes mean.
//!
//! A table of ids and half hashes, since the graph has the nodes: a fifth of a derivation is spent here, most of it waiting for
//! memory.

use super::node::Node;
use crate::id::ExprId;

/// Slots of a small table.
const FEWEST: usize = 256;
/// Slots of a large one: a quarter of a megabyte.
const MANY: usize = 1 << 15;

/// A large odd number without pattern, by which products fill all high bits.
const MIX: u64 = 0x9E37_79B9_7F4A_7C15;

/// The ids of all nodes by what the nodes are.
#[derive(Clone, Debug, Default)]
pub(super) struct Interned {
    /// High half of the hash of a node, and one more than its id; or 0. A power of two of them, at most half of them used. A node
    /// is in the slot that the first bits of its hash tell, or in the next that was free, round the end.
    slots: Vec<u64>,
    /// Bits of a hash that do not tell a slot.
    rest: u32,
    used: usize,
}

/// Where a node that is not there yet belongs.
pub(super) struct Free {
    slot: usize,
    hash: u64,
}

impl Interned {
    /// The id of a node, or where it belongs.
    #[inline]
    pub fn find(&mut self, nodes: &[Node], node: Node) -> Result<ExprId, Free> {
        if 2 * (self.used + 1) > self.slots.len() {
            self.grow();
        }
        self.search(nodes, node)
    }

    /// The id of a node, if it is there.
    pub fn get(&self, nodes: &[Node], node: Node) -> Option<ExprId> {
        if self.slots.is_empty() { None } else { self.search(nodes, node).ok() }
    }

    #[inline]
    fn search(&self, nodes: &[Node], node: Node) -> Result<ExprId, Free> {
        let hash = hash(node);
        let last = self.slots.len() - 1;
        let mut slot = (hash >> self.rest) as usize;
        loop {
            let known = self.slots[slot];
            if known == 0 {
                return Err(Free { slot, hash });
            }
            // A look at the node itself waits for memory: most others differ in the hash.
            let at = (known as u32) as usize;
            if (known ^ hash) >> 32 == 0 && nodes[at - 1] == node {
                return Ok(ExprId::new(at - 1));
            }
            slot = (slot + 1) & last;
        }
    }

    /// Puts a node there; nothing was put elsewhere since it was looked for.
    #[inline]
    pub fn put(&mut self, Free { slot, hash }: Free, id: ExprId) {
        self.slots[slot] = hash >> 32 << 32 | u64::from(id.number() + 1);
        self.used += 1;
    }

    /// Four times as many slots while they are few, for a derivation makes some ten thousand nodes; then twice as many: every page of
    /// them is new memory.
    fn grow(&mut self) {
        let times = if self.slots.len() < MANY { 4 } else { 2 };
        let slots = vec![0; (times * self.slots.len()).max(FEWEST)];
        let last = slots.len() - 1;
        self.rest = u64::BITS - slots.len().trailing_zeros();
        for known in std::mem::replace(&mut self.slots, slots) {
            if known != 0 {
                let mut slot = (known >> self.rest) as usize;
                while self.slots[slot] != 0 {
                    slot = (slot + 1) & last;
                }
                self.slots[slot] = known;
            }
        }
    }
}

#[inline]
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
    (mixed ^ mixed >> 32).wrapping_mul(MIX)
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
