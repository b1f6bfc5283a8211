//! From instructions to words (Arm Architecture Reference Manual for A-profile, chapter C4), by the procedure call
//! standard of the Arm 64-bit architecture. In: instructions. Out: machine code. Never knows what it computes.

use crate::straight::graph::Function;
use crate::straight::place::{Address, Base, Register};

use super::instruction::{Binary, Instruction, KEPT, Lanes, Unary};

/// The general register for what lives no longer than an instruction; a call may change it as well.
const SCRATCH: u32 = 16;
/// Whole registers, not their lower halves, in instructions for all bits.
const WHOLE: u32 = 1 << 30;

pub(super) struct Encoder<'a> {
    code: Vec<u8>,
    lanes: Lanes,
    /// Where the functions lie that the code calls.
    functions: &'a dyn Fn(Function) -> usize,
    /// Whether the pointers lie where calls leave them.
    entered: bool,
}

impl<'a> Encoder<'a> {
    pub(super) fn new(lanes: Lanes, functions: &'a dyn Fn(Function) -> usize) -> Self {
        Self { code: Vec::new(), lanes, functions, entered: false }
    }

    pub(super) fn finish(self) -> Vec<u8> {
        self.code
    }

    pub(super) fn instruction(&mut self, instruction: Instruction) {
        match instruction {
            Instruction::Unary { operation, to, of } => {
                let word = self.unary(operation);
                self.word(word | vector(of) << 5 | vector(to));
            }
            Instruction::Binary { operation, to, first, second } => self.binary(operation, to, first, second),
            Instruction::Select { to, no, yes, mask } => self.select(to, no, yes, mask),
            Instruction::Load { to, from } => self.memory(true, to, from),
            Instruction::Store { from, to } => self.memory(false, from, to),
            Instruction::Enter => {
                // stp x29, x30, [sp, #-48]!; mov x29, sp; stp x19, x20, [sp, #16]; stp x21, x22, [sp, #32].
                self.words(&[0xA9BD_7BFD, 0x9100_03FD, 0xA901_53F3, 0xA902_5BF5]);
                // mov x19, x0; mov x20, x1; mov x21, x2; mov x22, x3.
                self.words(&[0xAA00_03F3, 0xAA01_03F4, 0xAA02_03F5, 0xAA03_03F6]);
                self.entered = true;
            }
            // ldp x21, x22, [sp, #32]; ldp x19, x20, [sp, #16]; ldp x29, x30, [sp], #48.
            Instruction::Leave => self.words(&[0xA942_5BF5, 0xA941_53F3, 0xA8C3_7BFD]),
            // stp d8, d9, [sp, #-64]!; stp d10, d11, [sp, #16]; stp d12, d13, [sp, #32]; stp d14, d15, [sp, #48].
            Instruction::Keep => self.words(&[0x6DBC_27E8, 0x6D01_2FEA, 0x6D02_37EC, 0x6D03_3FEE]),
            // ldp d14, d15, [sp, #48]; ldp d12, d13, [sp, #32]; ldp d10, d11, [sp, #16]; ldp d8, d9, [sp], #64.
            Instruction::GiveBack => self.words(&[0x6D43_3FEE, 0x6D42_37EC, 0x6D41_2FEA, 0x6CC4_27E8]),
            Instruction::Argument { number, address } => self.argument(number, address),
            Instruction::Call(function) => self.call((self.functions)(function) as u64),
            // ret.
            Instruction::Return => self.word(0xD65F_03C0),
        }
    }

    fn word(&mut self, word: u32) {
        self.code.extend(word.to_le_bytes());
    }

    fn words(&mut self, words: &[u32]) {
        words.iter().for_each(|word| self.word(*word));
    }

    /// `f..` of one number, or of two in `.2d`.
    fn unary(&self, operation: Unary) -> u32 {
        match (operation, self.lanes) {
            (Unary::SquareRoot, Lanes::One) => 0x1E61_C000,
            (Unary::SquareRoot, Lanes::Two) => 0x6EE1_F800,
            (Unary::Negate, Lanes::One) => 0x1E61_4000,
            (Unary::Negate, Lanes::Two) => 0x6EE0_F800,
            (Unary::Absolute, Lanes::One) => 0x1E60_C000,
            (Unary::Absolute, Lanes::Two) => 0x4EE0_F800,
        }
    }

    fn binary(&mut self, operation: Binary, to: Register, first: Register, second: Register) {
        let word = match (operation, self.lanes) {
            (Binary::Add, Lanes::One) => 0x1E60_2800,
            (Binary::Add, Lanes::Two) => 0x4E60_D400,
            (Binary::Subtract, Lanes::One) => 0x1E60_3800,
            (Binary::Subtract, Lanes::Two) => 0x4EE0_D400,
            (Binary::Multiply, Lanes::One) => 0x1E60_0800,
            (Binary::Multiply, Lanes::Two) => 0x6E60_DC00,
            (Binary::Divide, Lanes::One) => 0x1E60_1800,
            (Binary::Divide, Lanes::Two) => 0x6E60_FC00,
            // fcmgt, whose second source is the smaller one.
            (Binary::Less, Lanes::One) => return self.three(0x7EE0_E400, to, second, first),
            (Binary::Less, Lanes::Two) => return self.three(0x6EE0_E400, to, second, first),
            (Binary::And, _) => return self.bitwise(0x0E20_1C00, to, first, second),
            // bic, which turns its second source.
            (Binary::AndNot, _) => return self.bitwise(0x0E60_1C00, to, second, first),
            (Binary::Xor, _) => return self.bitwise(0x2E20_1C00, to, first, second),
        };
        self.three(word, to, first, second);
    }

    fn three(&mut self, word: u32, to: Register, first: Register, second: Register) {
        self.word(word | vector(second) << 16 | vector(first) << 5 | vector(to));
    }

    fn bitwise(&mut self, word: u32, to: Register, first: Register, second: Register) {
        let whole = if self.lanes == Lanes::Two { WHOLE } else { 0 };
        self.three(word | whole, to, first, second);
    }

    /// Three instructions that differ in which of their operands they write over.
    fn select(&mut self, to: Register, no: Register, yes: Register, mask: Register) {
        const BSL: u32 = 0x2E60_1C00;
        const BIT: u32 = 0x2EA0_1C00;
        const BIF: u32 = 0x2EE0_1C00;
        // A move is an `orr` of a register with itself.
        const ORR: u32 = 0x0EA0_1C00;
        if to == no {
            self.bitwise(BIT, to, yes, mask);
        } else if to == yes {
            self.bitwise(BIF, to, no, mask);
        } else {
            if to != mask {
                self.bitwise(ORR, to, mask, mask);
            }
            self.bitwise(BSL, to, yes, no);
        }
    }

    /// The general register that holds a pointer: as it was passed, or where calls leave it.
    fn register_of(&self, base: Base) -> u32 {
        let number = match base {
            Base::Input => 0,
            Base::Output => 1,
            Base::Pool => 2,
            Base::Frame => 3,
        };
        if self.entered { number + 19 } else { number }
    }

    /// `ldr` or `str` of `d` or `q`: at a multiple of the value's length, or by an offset in a register.
    fn memory(&mut self, loads: bool, register: Register, Address { base, offset }: Address) {
        let (near, far) = match (self.lanes, loads) {
            (Lanes::One, true) => (0xFD40_0000, 0xFC60_C800),
            (Lanes::One, false) => (0xFD00_0000, 0xFC20_C800),
            (Lanes::Two, true) => (0x3DC0_0000, 0x3CE0_C800),
            (Lanes::Two, false) => (0x3D80_0000, 0x3CA0_C800),
        };
        let base = self.register_of(base) << 5;
        let value = self.lanes.bytes() as u32;
        match u32::try_from(offset) {
            Ok(offset) if offset.is_multiple_of(value) && offset / value < 4096 => {
                self.word(near | (offset / value) << 10 | base | vector(register));
            }
            _ => {
                self.offset(offset);
                self.word(far | SCRATCH << 16 | base | vector(register));
            }
        }
    }

    fn argument(&mut self, number: u8, Address { base, offset }: Address) {
        let base = self.register_of(base) << 5;
        let to = u32::from(number);
        match u32::try_from(offset) {
            // add, with a number.
            Ok(offset) if offset < 4096 => self.word(0x9100_0000 | offset << 10 | base | to),
            // add, with w16 as a number with a sign.
            _ => {
                self.offset(offset);
                self.word(0x8B20_C000 | SCRATCH << 16 | base | to);
            }
        }
    }

    /// movz and, if need be, movk of w16.
    fn offset(&mut self, offset: i32) {
        let bits = offset.cast_unsigned();
        self.word(0x5280_0000 | (bits & 0xFFFF) << 5 | SCRATCH);
        if bits >> 16 != 0 {
            self.word(0x72A0_0000 | (bits >> 16) << 5 | SCRATCH);
        }
    }

    fn call(&mut self, address: u64) {
        let part = |place: u32| (address >> (16 * place) & 0xFFFF) as u32;
        // movz, movk of x16.
        self.word(0xD280_0000 | part(0) << 5 | SCRATCH);
        for place in 1..4 {
            self.word(0xF280_0000 | place << 21 | part(place) << 5 | SCRATCH);
        }
        // blr.
        self.word(0xD63F_0000 | SCRATCH << 5);
    }
}

/// The number that the processor knows a vector register by: those that a caller wants back, v8 to v15, are the last.
fn vector(register: Register) -> u32 {
    u32::from(match register {
        0..8 => register,
        8..KEPT => register + 8,
        _ => register - 16,
    })
}
