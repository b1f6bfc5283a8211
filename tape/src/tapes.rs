//! Where back ends have a mechanism's tapes from. In: an entry. Out: its tape, made by then. Never knows who makes it.

use linkwear_runtime::Entry;

use crate::tape::Tape;

/// Tapes of a mechanism by what they answer. Those that nobody asks for need not be there yet.
pub trait Tapes: Send + Sync {
    /// The tape of an entry; none if there will be none.
    fn tape(&self, entry: Entry) -> Option<&Tape>;
}

/// In the order of [`Entry::ALL`].
impl Tapes for Vec<Tape> {
    fn tape(&self, entry: Entry) -> Option<&Tape> {
        self.as_slice().tape(entry)
    }
}

/// In the order of [`Entry::ALL`].
impl Tapes for [Tape] {
    fn tape(&self, entry: Entry) -> Option<&Tape> {
        self.get(entry as usize)
    }
}

impl<T: Tapes + ?Sized> Tapes for &T {
    fn tape(&self, entry: Entry) -> Option<&Tape> {
        (**self).tape(entry)
    }
}
