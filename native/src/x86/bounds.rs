//! The last look before code is believed: no instruction reaches past what the function is called with, nor for what the
//! processor lacks. In: an instruction, lengths. Out: whether it is within.

use crate::straight::bounds::Lengths;

use super::instruction::{Binary, Instruction, Lanes, MASKS, MaskRegister, Operand, Target, Wide};

/// Whether an instruction stays within its memory and its registers.
pub(super) fn is_within(Wide { lanes, instruction }: Wide, target: Target, lengths: Lengths) -> bool {
    // Values of one state stand side by side, states of a value do not.
    if lanes != target.lanes && (target.lanes != Lanes::One || lanes == Lanes::Eight) {
        return false;
    }
    let value = lanes.bytes();
    // Bitwise instructions read whole registers.
    let whole = value.max(16);
    let register = |register: u8| register < target.registers;
    let masked = |mask: MaskRegister| target.registers > 16 && (1..MASKS).contains(&usize::from(mask));
    // Forms that only the shorter encoding has.
    let low = |register: u8| register < target.registers.min(16) && lanes != Lanes::Eight;
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
        Instruction::LessToMask { mask, first, second } => {
            masked(mask) && register(first) && read(second, value)
        }
        Instruction::SignToMask { mask, of: number } | Instruction::MaskToRegister { to: number, mask } => {
            masked(mask) && register(number)
        }
        Instruction::SelectByMask { to, no, yes, mask } => {
            masked(mask) && register(to) && register(no) && read(yes, whole)
        }
        Instruction::Load { to, from } => register(to) && read(from, value),
        Instruction::Store { from, to } => register(from) && lengths.hold(to, value, true),
        Instruction::Pair { to, low, high } => {
            lanes != Lanes::One && register(to) && register(low) && read(high, value / 2)
        }
        Instruction::Low { to, of } | Instruction::High { to, of } => {
            lanes != Lanes::One && register(to) && register(of)
        }
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

#[cfg(test)]
mod tests {
    use crate::straight::place::{Address, Base};

    use super::*;

    const LENGTHS: Lengths = Lengths { input: 32, output: 32, pool: 16, frame: 32 };

    fn is_found(lanes: Lanes, registers: u8, instruction: Instruction) -> bool {
        let target = Target { lanes, registers, columns: false };
        !is_within(Wide { lanes, instruction }, target, LENGTHS)
    }

    fn load(base: Base, offset: i32) -> Instruction {
        Instruction::Load { to: 0, from: Operand::Memory(Address { base, offset }) }
    }

    #[test]
    fn the_last_value_is_within_and_the_next_is_not() {
        for (base, last) in [(Base::Input, 24), (Base::Output, 24), (Base::Pool, 8), (Base::Frame, 24)] {
            assert!(!is_found(Lanes::One, 16, load(base, last)));
            assert!(is_found(Lanes::One, 16, load(base, last + 1)));
            assert!(is_found(Lanes::One, 16, load(base, -1)));
            assert_eq!(is_found(Lanes::Four, 16, load(base, 0)), base == Base::Pool);
        }
    }

    #[test]
    fn bitwise_operations_read_sixteen_bytes() {
        let and = |offset| Instruction::Binary {
            operation: Binary::And,
            to: 0,
            first: 0,
            second: Operand::Memory(Address { base: Base::Pool, offset }),
        };
        assert!(!is_found(Lanes::One, 16, and(0)));
        assert!(is_found(Lanes::One, 16, and(8)));
    }

    #[test]
    fn inputs_and_constants_are_never_written() {
        for base in [Base::Input, Base::Pool] {
            let address = Address { base, offset: 0 };
            assert!(is_found(Lanes::One, 16, Instruction::Store { from: 0, to: address }));
            assert!(is_found(Lanes::One, 16, Instruction::Argument { number: 0, address }));
            assert!(!is_found(Lanes::One, 16, Instruction::Argument { number: 1, address }));
        }
    }

    #[test]
    fn registers_and_masks_that_the_processor_lacks_are_found() {
        let add =
            Instruction::Binary { operation: Binary::Add, to: 16, first: 0, second: Operand::Register(1) };
        assert!(is_found(Lanes::One, 16, add) && !is_found(Lanes::One, 32, add));
        let mask = |mask| Instruction::SignToMask { mask, of: 0 };
        assert!(is_found(Lanes::One, 16, mask(7)) && !is_found(Lanes::One, 32, mask(7)));
        assert!(is_found(Lanes::One, 32, mask(0)) && is_found(Lanes::One, 32, mask(8)));
        let select = Instruction::Select { to: 0, no: 1, yes: Operand::Register(2), mask: 16 };
        assert!(is_found(Lanes::One, 32, select));
        assert!(is_found(
            Lanes::Eight,
            32,
            Instruction::Select { mask: 3, to: 0, no: 1, yes: Operand::Register(2) }
        ));
    }

    #[test]
    fn values_of_one_state_stand_side_by_side_and_states_do_not() {
        let is_within = |of: Lanes, lanes, instruction| {
            let target = Target { lanes: of, registers: 32, columns: false };
            is_within(Wide { lanes, instruction }, target, LENGTHS)
        };
        let pair = |offset| Instruction::Pair {
            to: 0,
            low: 1,
            high: Operand::Memory(Address { base: Base::Input, offset }),
        };
        for (lanes, last) in [(Lanes::Two, 24), (Lanes::Four, 16)] {
            assert!(
                is_within(Lanes::One, lanes, pair(last)) && !is_within(Lanes::One, lanes, pair(last + 1))
            );
            assert!(!is_within(Lanes::Eight, lanes, pair(last)));
        }
        assert!(!is_within(Lanes::One, Lanes::One, pair(0)));
        assert!(!is_within(Lanes::One, Lanes::Eight, Instruction::Low { to: 0, of: 1 }));
        assert!(!is_within(Lanes::One, Lanes::Two, Instruction::High { to: 0, of: 32 }));
    }
}
