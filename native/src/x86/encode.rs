//! From instructions to bytes, by VEX where that can name the operands and by EVEX elsewhere (Intel's manual, volume 2,
//! sections 2.3 and 2.7). In: instructions. Out: machine code. Never knows what it computes.

use crate::straight::graph::Function;
use crate::straight::place::{Address, Base, Register};

use super::instruction::{Binary, Instruction, Lanes, Operand, Target, Wide};

/// Predicate of comparisons: ordered, less than, silent on NaN.
const LESS_THAN: u8 = 0x11;
/// Names the upper half of a register of 32 bytes.
const UPPER: u8 = 1;
/// The general register that holds the pointer to a column, rax: nothing else stays there.
const COLUMN: u8 = 0;

/// Where an instruction's operation is told: the map of opcodes, the prefix it stands for, the opcode.
#[derive(Clone, Copy)]
struct Form {
    map: u8,
    prefix: u8,
    opcode: u8,
    /// Whether it reads one number where one lane is computed, not the whole register.
    scalar: bool,
    /// Whether only EVEX has it.
    extended: bool,
}

const fn plain(prefix: u8, opcode: u8) -> Form {
    Form { map: 1, prefix, opcode, scalar: false, extended: false }
}

pub(super) struct Encoder<'a> {
    code: Vec<u8>,
    /// Of the instruction at hand.
    lanes: Lanes,
    /// Whether inputs and outputs are behind tables of pointers.
    columns: bool,
    /// Where the functions lie that the code calls.
    functions: &'a dyn Fn(Function) -> usize,
    /// Whether the pointers lie where calls leave them.
    entered: bool,
}

impl<'a> Encoder<'a> {
    pub(super) fn new(
        Target { lanes, columns, .. }: Target,
        functions: &'a dyn Fn(Function) -> usize,
    ) -> Self {
        Self { code: Vec::new(), lanes, columns, functions, entered: false }
    }

    pub(super) fn finish(self) -> Vec<u8> {
        self.code
    }

    pub(super) fn instruction(&mut self, Wide { lanes, instruction }: Wide) {
        self.lanes = lanes;
        match instruction {
            Instruction::Binary { operation: Binary::Less, to, first, second } => {
                self.vector(self.arithmetic(0xC2), to, first, second, 0);
                self.code.push(LESS_THAN);
            }
            Instruction::Binary { operation, to, first, second } => {
                self.vector(self.binary(operation), to, first, second, 0);
            }
            Instruction::SquareRoot { to, of } => {
                // The scalar form takes its upper half from a second source: the same one, so that it waits for no other.
                let upper = match (self.lanes, of) {
                    (Lanes::One, Operand::Register(register)) => register,
                    _ => 0,
                };
                self.vector(self.arithmetic(0x51), to, upper, of, 0);
            }
            Instruction::Select { to, no, yes, mask } => {
                self.vector(Form { map: 3, ..plain(1, 0x4B) }, to, no, yes, 0);
                self.code.push(mask << 4);
            }
            Instruction::LessToMask { mask, first, second } => {
                self.vector(Form { extended: true, ..self.arithmetic(0xC2) }, mask, first, second, 0);
                self.code.push(LESS_THAN);
            }
            Instruction::SignToMask { mask, of } => {
                let form = Form { map: 2, extended: true, ..plain(2, 0x39) };
                self.vector(form, mask, 0, Operand::Register(of), 0);
            }
            Instruction::MaskToRegister { to, mask } => {
                let form = Form { map: 2, extended: true, ..plain(2, 0x38) };
                self.vector(form, to, 0, Operand::Register(mask), 0);
            }
            Instruction::SelectByMask { to, no, yes, mask } => {
                self.vector(Form { map: 2, extended: true, ..plain(1, 0x65) }, to, no, yes, mask);
            }
            Instruction::Load { to, from: Operand::Broadcast(from) } => {
                let form = Form { map: 2, scalar: true, ..plain(1, 0x19) };
                self.vector(form, to, 0, Operand::Memory(from), 0);
            }
            Instruction::Load { to, from } => self.vector(self.arithmetic(0x10), to, 0, from, 0),
            Instruction::Store { from, to } => {
                self.vector(self.arithmetic(0x11), from, 0, Operand::Memory(to), 0)
            }
            Instruction::Pair { to, low, high } => {
                let (form, half) = match (lanes, high) {
                    (Lanes::Four, _) => (Form { map: 3, ..plain(1, 0x18) }, true),
                    (_, Operand::Register(_)) => (plain(1, 0x14), false),
                    (_, _) => (plain(1, 0x16), false),
                };
                self.vector(form, to, low, high, 0);
                self.code.extend(half.then_some(UPPER));
            }
            Instruction::Low { to, of } => {
                self.lanes = Lanes::Two;
                self.vector(plain(1, 0x28), to, 0, Operand::Register(of), 0);
            }
            Instruction::High { to, of } if lanes == Lanes::Four => {
                self.vector(Form { map: 3, ..plain(1, 0x19) }, of, 0, Operand::Register(to), 0);
                self.code.push(UPPER);
            }
            Instruction::High { to, of } => self.vector(plain(1, 0x15), to, of, Operand::Register(of), 0),
            Instruction::Enter => {
                // push rbx, rbp, r14, r15; sub rsp, 8, which puts the stack on a multiple of 16.
                self.code.extend([0x53, 0x55, 0x41, 0x56, 0x41, 0x57, 0x48, 0x83, 0xEC, 0x08]);
                // mov rbx, rdi; mov rbp, rsi; mov r14, rdx; mov r15, rcx.
                self.code.extend([0x48, 0x89, 0xFB, 0x48, 0x89, 0xF5, 0x49, 0x89, 0xD6, 0x49, 0x89, 0xCF]);
                self.entered = true;
            }
            // add rsp, 8; pop r15, r14, rbp, rbx.
            Instruction::Leave => {
                self.code.extend([0x48, 0x83, 0xC4, 0x08, 0x41, 0x5F, 0x41, 0x5E, 0x5D, 0x5B]);
            }
            Instruction::Argument { number, address } => {
                // rdi, rsi, rdx, rcx, the places of the first arguments.
                let to = [7, 6, 2, 1][usize::from(number)];
                if self.is_column(address.base) {
                    self.pointer(to, address);
                } else {
                    let base = self.register_of(address.base);
                    // lea to, [base + offset].
                    self.code.extend([0x48 | base >> 3, 0x8D, 0x80 | to << 3 | base & 7]);
                    self.code.extend(address.offset.to_le_bytes());
                }
            }
            Instruction::Call(function) => {
                // mov rax, address; call rax.
                self.code.extend([0x48, 0xB8]);
                self.code.extend(((self.functions)(function) as u64).to_le_bytes());
                self.code.extend([0xFF, 0xD0]);
            }
            Instruction::ClearUpper => self.code.extend([0xC5, 0xF8, 0x77]),
            Instruction::Return => self.code.push(0xC3),
        }
    }

    fn arithmetic(&self, opcode: u8) -> Form {
        Form { scalar: true, ..plain(if self.lanes == Lanes::One { 3 } else { 1 }, opcode) }
    }

    fn binary(&self, operation: Binary) -> Form {
        match operation {
            Binary::Add => self.arithmetic(0x58),
            Binary::Multiply => self.arithmetic(0x59),
            Binary::Subtract => self.arithmetic(0x5C),
            Binary::Divide => self.arithmetic(0x5E),
            Binary::Smaller => self.arithmetic(0x5D),
            Binary::Larger => self.arithmetic(0x5F),
            Binary::Less => self.arithmetic(0xC2),
            Binary::And => plain(1, 0x54),
            Binary::AndNot => plain(1, 0x55),
            Binary::Xor => plain(1, 0x57),
        }
    }

    /// Whether what counts from a base lies behind a table of pointers.
    fn is_column(&self, base: Base) -> bool {
        self.columns && matches!(base, Base::Input | Base::Output)
    }

    /// The pointer to a column: mov to, [table + 8 number].
    fn pointer(&mut self, to: u8, Address { base, offset }: Address) {
        let number = offset / self.lanes.bytes() as i32;
        let table = self.register_of(base);
        self.code.extend([0x48 | table >> 3, 0x8B, 0x80 | to << 3 | table & 7]);
        self.code.extend((number * size_of::<usize>() as i32).to_le_bytes());
    }

    /// The general register that holds a pointer: as it was passed, or where calls leave it.
    fn register_of(&self, base: Base) -> u8 {
        let [passed, kept] = match base {
            Base::Input => [7, 3],
            Base::Output => [6, 5],
            Base::Pool => [2, 14],
            Base::Frame => [1, 15],
        };
        if self.entered { kept } else { passed }
    }

    /// An instruction with a register, up to one source in a register, and one operand anywhere.
    fn vector(&mut self, form: Form, register: Register, source: Register, operand: Operand, mask: u8) {
        if let Operand::Memory(address) | Operand::Broadcast(address) = operand
            && self.is_column(address.base)
        {
            self.pointer(COLUMN, address);
        }
        let wide = register > 15 || source > 15 || matches!(operand, Operand::Register(r) if r > 15);
        let broadcast = matches!(operand, Operand::Broadcast(_));
        if wide || broadcast || form.extended || self.lanes == Lanes::Eight {
            self.evex(form, register, source, operand, mask);
        } else {
            self.vex(form, register, source, operand);
        }
    }

    /// The general register that an address counts from, and the distance: none from the pointer to a column.
    fn counted_from(&self, Address { base, offset }: Address) -> (u8, i32) {
        if self.is_column(base) { (COLUMN, 0) } else { (self.register_of(base), offset) }
    }

    /// 0, 1, 2: 16, 32, 64 bytes.
    fn length(&self) -> u8 {
        match self.lanes {
            Lanes::One | Lanes::Two => 0,
            Lanes::Four => 1,
            Lanes::Eight => 2,
        }
    }

    fn low_register(&self, operand: Operand) -> u8 {
        match operand {
            Operand::Register(register) => register,
            Operand::Memory(address) | Operand::Broadcast(address) => self.counted_from(address).0,
        }
    }

    fn vex(&mut self, form: Form, register: Register, source: Register, operand: Operand) {
        let (high, low) = (register >> 3 & 1, self.low_register(operand) >> 3 & 1);
        let rest = (!source & 15) << 3 | self.length() << 2 | form.prefix;
        if form.map == 1 && low == 0 {
            self.code.extend([0xC5, (high ^ 1) << 7 | rest]);
        } else {
            self.code.extend([0xC4, (high ^ 1) << 7 | 0x40 | (low ^ 1) << 5 | form.map, rest]);
        }
        self.code.push(form.opcode);
        self.operand(register, operand, 1);
    }

    fn evex(&mut self, form: Form, register: Register, source: Register, operand: Operand, mask: u8) {
        let low = self.low_register(operand);
        // Bit 4 of a register operand stands where addresses have the index.
        let index = if matches!(operand, Operand::Register(_)) { low >> 4 & 1 } else { 0 };
        let broadcast = u8::from(matches!(operand, Operand::Broadcast(_)));
        let not = |number: u8, bit: u8| !number >> bit & 1;
        let first =
            not(register, 3) << 7 | (index ^ 1) << 6 | not(low, 3) << 5 | not(register, 4) << 4 | form.map;
        let second = 0x80 | (!source & 15) << 3 | 4 | form.prefix;
        let third = self.length() << 5 | broadcast << 4 | not(source, 4) << 3 | mask;
        self.code.extend([0x62, first, second, third, form.opcode]);
        let whole = 16 << self.length();
        let number = form.map == 2 && form.opcode == 0x19 || self.lanes == Lanes::One;
        let half = form.map == 3 || form.map == 1 && form.opcode == 0x16;
        let unit = if broadcast == 1 || form.scalar && number {
            8
        } else if half {
            self.lanes.bytes() as i32 / 2
        } else {
            whole
        };
        self.operand(register, operand, unit);
    }

    /// The bytes that name the operand; offsets of one byte count in units.
    fn operand(&mut self, register: Register, operand: Operand, unit: i32) {
        let register = (register & 7) << 3;
        match operand {
            Operand::Register(other) => self.code.push(0xC0 | register | other & 7),
            Operand::Memory(address) | Operand::Broadcast(address) => self.address(register, address, unit),
        }
    }

    fn address(&mut self, register: u8, address: Address, unit: i32) {
        let (base, offset) = self.counted_from(address);
        let base = base & 7;
        let short = i8::try_from(offset / unit).ok().filter(|_| offset % unit == 0);
        match short {
            // Without an offset the code of rbp means something else.
            Some(0) if base != 5 => self.code.push(register | base),
            Some(units) => self.code.extend([0x40 | register | base, units.cast_unsigned()]),
            None => {
                self.code.push(0x80 | register | base);
                self.code.extend(offset.to_le_bytes());
            }
        }
    }
}
