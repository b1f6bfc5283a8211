//! The instructions that straight-line code is made of. Never knows their bytes, nor why they are there.

use crate::straight::graph::Function;
use crate::straight::place::{Address, Register};

/// All vector registers. The last eight are those whose lower halves a caller wants back.
pub(crate) const REGISTERS: u8 = 32;
/// The first register that a caller wants back.
pub(super) const KEPT: Register = 24;

/// How many states one pass evaluates side by side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Lanes {
    One,
    Two,
}

impl Lanes {
    pub(super) const fn count(self) -> usize {
        match self {
            Self::One => 1,
            Self::Two => 2,
        }
    }

    /// Length of one value in a register.
    pub(super) const fn bytes(self) -> usize {
        size_of::<f64>() * self.count()
    }
}

/// What the code may use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Target {
    pub(crate) lanes: Lanes,
    /// States side by side in memory, a multiple of the lanes.
    pub(crate) states: usize,
    pub(crate) registers: u8,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Unary {
    SquareRoot,
    Negate,
    Absolute,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Binary {
    Add,
    Subtract,
    Multiply,
    Divide,
    And,
    /// Not the first, and the second.
    AndNot,
    Xor,
    /// All bits set where the first is less than the second, else none.
    Less,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Instruction {
    Unary {
        operation: Unary,
        to: Register,
        of: Register,
    },
    Binary {
        operation: Binary,
        to: Register,
        first: Register,
        second: Register,
    },
    /// `yes` where the bits of `mask` are set.
    Select {
        to: Register,
        no: Register,
        yes: Register,
        mask: Register,
    },
    Load {
        to: Register,
        from: Address,
    },
    Store {
        from: Register,
        to: Address,
    },
    /// Saves what the caller wants back of the general registers, and puts the pointers where calls leave them.
    Enter,
    /// Undoes `Enter`.
    Leave,
    /// Saves what the caller wants back of the vector registers.
    Keep,
    /// Undoes `Keep`.
    GiveBack,
    /// Puts the address of the result (0) or of an argument where a called function looks for it.
    Argument {
        number: u8,
        address: Address,
    },
    Call(Function),
    Return,
}
