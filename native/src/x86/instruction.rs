//! The instructions that straight-line code is made of. Never knows their bytes, nor why they are there.

use crate::straight::graph::Function;
use crate::straight::place::{Address, Register};

/// How many numbers stand side by side: the states that one call evaluates, or the values of one state that one instruction computes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Lanes {
    One,
    Two,
    Four,
    Eight,
}

impl Lanes {
    pub(super) const fn count(self) -> usize {
        match self {
            Self::One => 1,
            Self::Two => 2,
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

impl Target {
    /// The lanes of an instruction on so many values side by side.
    pub(super) const fn lanes_of(self, width: usize) -> Lanes {
        match (self.lanes, width) {
            (Lanes::One, 2) => Lanes::Two,
            (Lanes::One, 4) => Lanes::Four,
            (lanes, _) => lanes,
        }
    }

    /// An instruction on so many values side by side.
    pub(super) const fn wide(self, width: usize, instruction: Instruction) -> Wide {
        Wide { lanes: self.lanes_of(width), instruction }
    }
}

/// A mask register, by its number, from 1 on: 0 stands for no mask.
pub(crate) type MaskRegister = u8;

/// How many numbers mask registers have, with that of no mask.
pub(super) const MASKS: usize = 8;

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
    Larger,
    Smaller,
    /// Registers below 16 only, and not for eight lanes.
    Less,
}

/// An instruction and the numbers that it computes side by side: the states of the code, or, where that has one, several of its values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Wide {
    pub(super) lanes: Lanes,
    pub(super) instruction: Instruction,
}

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
        mask: MaskRegister,
        first: Register,
        second: Operand,
    },
    SignToMask {
        mask: MaskRegister,
        of: Register,
    },
    MaskToRegister {
        to: Register,
        mask: MaskRegister,
    },
    SelectByMask {
        to: Register,
        no: Register,
        yes: Operand,
        mask: MaskRegister,
    },
    Load {
        to: Register,
        from: Operand,
    },
    Store {
        from: Register,
        to: Address,
    },
    /// Two halves side by side.
    Pair {
        to: Register,
        low: Register,
        high: Operand,
    },
    /// The first half of a pair; lanes are those of the pair, as for `High`.
    Low {
        to: Register,
        of: Register,
    },
    /// The second half.
    High {
        to: Register,
        of: Register,
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
