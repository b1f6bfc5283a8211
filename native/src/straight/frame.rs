//! Places in the caller's workspace. In: values that come and end. Out: their addresses.

use super::place::{Address, Base};

#[derive(Clone, Debug)]
pub(super) struct Frame {
    /// Length of a value in bytes.
    value: usize,
    len: usize,
    free: Vec<Address>,
    /// Of values that the next instruction reads for the last time.
    ended: Vec<Address>,
}

impl Frame {
    pub(super) const fn new(value: usize) -> Self {
        Self { value, len: 0, free: Vec::new(), ended: Vec::new() }
    }

    /// In values.
    pub(super) const fn len(&self) -> usize {
        self.len
    }

    pub(super) fn take(&mut self) -> Address {
        self.free.pop().unwrap_or_else(|| {
            let offset = (self.len * self.value) as i32;
            self.len += 1;
            Address { base: Base::Frame, offset }
        })
    }

    /// The value at an address is read for the last time; others than those of the frame are no matter.
    pub(super) fn end(&mut self, address: Address) {
        if address.base == Base::Frame {
            self.ended.push(address);
        }
    }

    /// The instruction that read them is written.
    pub(super) fn free_ended(&mut self) {
        self.free.append(&mut self.ended);
    }
}
