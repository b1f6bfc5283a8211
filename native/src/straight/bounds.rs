//! The lengths of what the code is called with. In: addresses. Out: whether a value there is within.

use super::place::{Address, Base};

/// Lengths in bytes of what the four pointers point to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lengths {
    pub(crate) input: usize,
    pub(crate) output: usize,
    pub(crate) pool: usize,
    pub(crate) frame: usize,
}

impl Lengths {
    /// Whether so many bytes at an address may be read, or written.
    pub(crate) fn hold(self, Address { base, offset }: Address, bytes: usize, written: bool) -> bool {
        let (length, writable) = match base {
            Base::Input => (self.input, false),
            Base::Output => (self.output, true),
            Base::Pool => (self.pool, false),
            Base::Frame => (self.frame, true),
        };
        let end = usize::try_from(offset).map(|offset| offset + bytes);
        end.is_ok_and(|end| end <= length) && (writable || !written)
    }
}
