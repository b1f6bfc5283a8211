//! The last look before code is believed: no instruction reaches past what the function is called with. Memory stays
//! safe by this and the encoder, whatever stages before did. In: instructions, lengths. Out: the first that reaches out.

use super::instruction::{Address, Base, Binary, Instruction, Lanes, Operand, Target};

/// Lengths in bytes of what the four pointers point to.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lengths {
    pub(super) input: usize,
    pub(super) output: usize,
    pub(super) pool: usize,
    pub(super) frame: usize,
}

impl Lengths {
    fn hold(self, Address { base, offset }: Address, bytes: usize, written: bool) -> bool {
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

/// The first instruction that reaches past its memory or its registers.
pub(super) fn first_out_of_bounds(
    instructions: &[Instruction],
    target: Target,
    lengths: Lengths,
) -> Option<Instruction> {
    instructions.iter().copied().find(|instruction| !is_within(*instruction, target, lengths))
}

fn is_within(instruction: Instruction, target: Target, lengths: Lengths) -> bool {
    let value = target.lanes.bytes();
    // Bitwise instructions read whole registers.
    let whole = value.max(16);
    let register = |register: u8| register < target.registers;
    // Forms that only the shorter encoding has.
    let low = |register: u8| register < target.registers.min(16) && target.lanes != Lanes::Eight;
    let read = |operand: Operand, bytes: usize| match operand {
        Operand::Register(number) => register(number),
        Operand::Memory(address) => lengths.hold(address, bytes, false),
        Operand::Broadcast(address) => {
            target.registers > 16 && lengths.hold(address, size_of::<f64>(), false)
        }
    };
    match instruction {
        Instruction::Binary { operation, to, first, second } => match operation {
            Binary::And | Binary::AndNot | Binary::Xor => {
                register(to) && register(first) && read(second, whole)
            }
            Binary::Less => low(to) && low(first) && read(second, value) && is_low(second),
            _ => register(to) && register(first) && read(second, value),
        },
        Instruction::SquareRoot { to, of } => register(to) && read(of, value),
        Instruction::Select { to, no, yes, mask } => {
            low(to) && low(no) && low(mask) && read(yes, whole) && is_low(yes)
        }
        Instruction::LessToMask { first, second } => {
            target.registers > 16 && register(first) && read(second, value)
        }
        Instruction::SignToMask { of: number } | Instruction::MaskToRegister { to: number } => {
            target.registers > 16 && register(number)
        }
        Instruction::SelectByMask { to, no, yes } => {
            target.registers > 16 && register(to) && register(no) && read(yes, whole)
        }
        Instruction::Load { to, from } => register(to) && read(from, value),
        Instruction::Store { from, to } => register(from) && lengths.hold(to, value, true),
        // The result is written, arguments are read.
        Instruction::Argument { number, address } => number < 4 && lengths.hold(address, value, number == 0),
        Instruction::Enter
        | Instruction::Leave
        | Instruction::Call(_)
        | Instruction::ClearUpper
        | Instruction::Return => true,
    }
}

fn is_low(operand: Operand) -> bool {
    match operand {
        Operand::Register(number) => number < 16,
        Operand::Memory(_) => true,
        Operand::Broadcast(_) => false,
    }
}
