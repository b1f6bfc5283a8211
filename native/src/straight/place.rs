//! Where values are: registers, memory. Never knows instructions.

/// A vector register, by its number.
pub(crate) type Register = u8;

/// Registers that any processor has at most.
pub(crate) const MOST_REGISTERS: usize = 32;

/// What an address counts from: the four pointers that the code is called with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Base {
    Input,
    Output,
    /// The constants.
    Pool,
    /// The caller's workspace.
    Frame,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Address {
    pub(crate) base: Base,
    /// In bytes.
    pub(crate) offset: i32,
}

/// How values lie in registers and in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Shape {
    /// Length of one value: the numbers of the lanes that one pass computes, in bytes.
    pub(crate) value: usize,
    /// From one entry of inputs or outputs to the next, in bytes: the numbers of all lanes, pass after pass.
    pub(crate) step: usize,
    /// Vector registers that may be used.
    pub(crate) registers: u8,
    /// Whether inputs and outputs lie apart, each behind its pointer in a table, and not value by value.
    pub(crate) columns: bool,
}
