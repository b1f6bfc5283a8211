//! The instructions that straight-line code is made of. Never knows their bytes, nor why they are there.

use crate::straight::graph::Function;
use crate::straight::place::{Address, Register};

/// How many states one call evaluates side by side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Lanes {
    One,
    Four,
    Eight,
}

impl Lanes {
    pub(super) const fn count(self) -> usize {
        match self {
            Self::One => 1,
            Self::Four => 4,
            Self::Eight => 8,
        }
    }

    /// Length of one value in memory.
    pub(super) const fn bytes(self) -> usize {
        size_of::<f64>() * self.count()
    }
}

/// What the code may use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Target {
    pub(super) lanes: Lanes,
    /// Vector registers: 16 with AVX, 32 with AVX-512.
    pub(super) registers: u8,
    /// Whether inputs and outputs lie apart, each behind its pointer in a table, and not value by value.
    pub(super) columns: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Operand {
    Register(Register),
    /// A whole value.
    Memory(Address),
    /// One number, which every lane gets.
    Broadcast(Address),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Binary {
    Add,
    Subtract,
    Multiply,
    Divide,
    And,
    AndNot,
    Xor,
    /// Registers below 16 only, and not for eight lanes.
    Less,
}

/// The mask register is always the same one, and named by no instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Instruction {
    Binary {
        operation: Binary,
        to: Register,
        first: Register,
        second: Operand,
    },
    SquareRoot {
        to: Register,
        of: Operand,
    },
    /// Registers below 16 only: `yes` where the sign of `mask` is set.
    Select {
        to: Register,
        no: Register,
        yes: Operand,
        mask: Register,
    },
    LessToMask {
        first: Register,
        second: Operand,
    },
    SignToMask {
        of: Register,
    },
    MaskToRegister {
        to: Register,
    },
    SelectByMask {
        to: Register,
        no: Register,
        yes: Operand,
    },
    Load {
        to: Register,
        from: Operand,
    },
    Store {
        from: Register,
        to: Address,
    },
    /// Saves the registers that the caller wants back, and puts the pointers where calls leave them.
    Enter,
    /// Undoes `Enter`.
    Leave,
    /// Puts the address of the result (0) or of an argument where a called function looks for it.
    Argument {
        number: u8,
        address: Address,
    },
    Call(Function),
    /// Without it, code that was written for narrower registers runs slowly.
    ClearUpper,
    Return,
}
