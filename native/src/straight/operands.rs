//! Which operands stay in memory, for processors whose instructions read them there.

use super::allocate::{Allocation, Processor};
use super::graph::Id;
use super::place::{Address, Register};

/// An operand in memory is loaded if it is read again within so many operations and a register is free.
const SOON: u32 = 8;

impl<P: Processor> Allocation<'_, P> {
    pub(crate) fn register_of(&self, id: Id) -> Option<Register> {
        self.register[id as usize]
    }

    /// Where two values lie next to each other in memory, if they do and are in no registers.
    pub(crate) fn side_by_side(&self, first: Id, second: Id) -> Option<Address> {
        if self.register_of(first).or(self.register_of(second)).is_some() {
            return None;
        }
        let (low, high) = (self.home[first as usize]?, self.home[second as usize]?);
        let length = (self.node(first).width() * size_of::<f64>()) as i32;
        (low.base == high.base && high.offset == low.offset + length).then_some(low)
    }

    /// Of two arguments that may be exchanged the one to load first: what is in a register, else what is read again sooner.
    pub(crate) fn in_good_order(&self, first: Id, second: Id) -> (Id, Id) {
        let is_held = |id: Id| self.register_of(id).is_some();
        let far = |id: Id| self.next_read(id).unwrap_or(u32::MAX);
        let exchange = !is_held(first) && (is_held(second) || far(second) < far(first));
        if exchange { (second, first) } else { (first, second) }
    }

    /// Whether it is better to load a value than to read it from memory.
    pub(crate) fn is_worth_a_register(&self, id: Id) -> bool {
        let again = self.next_read(id).is_some_and(|next| next - self.now <= SOON);
        again && self.free_register().is_some()
    }
}
