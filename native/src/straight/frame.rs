//! Places in the caller's workspace. In: values that come and end. Out: their addresses.

use std::collections::BTreeMap;

use super::place::{Address, Base};

#[derive(Clone, Debug)]
pub(super) struct Frame {
    /// Length of a value in bytes.
    value: usize,
    len: usize,
    /// Free places by the width that they have.
    free: BTreeMap<usize, Vec<Address>>,
    /// Of values that the next instruction reads for the last time, and their width.
    ended: Vec<(Address, usize)>,
}

impl Frame {
    pub(super) const fn new(value: usize) -> Self {
        Self { value, len: 0, free: BTreeMap::new(), ended: Vec::new() }
    }

    /// In values.
    pub(super) const fn len(&self) -> usize {
        self.len
    }

    /// A place for so many values side by side.
    pub(super) fn take(&mut self, width: usize) -> Address {
        if let Some(address) = self.free.get_mut(&width).and_then(Vec::pop) {
            return address;
        }
        let offset = (self.len * self.value) as i32;
        self.len += width;
        Address { base: Base::Frame, offset }
    }

    /// What lies at an address is read for the last time; others than those of the frame are no matter.
    pub(super) fn end(&mut self, address: Address, width: usize) {
        if address.base == Base::Frame {
            self.ended.push((address, width));
        }
    }

    /// The instruction that read them is written.
    pub(super) fn free_ended(&mut self) {
        for (address, width) in self.ended.drain(..) {
            self.free.entry(width).or_default().push(address);
        }
    }
}
