//! The last look before code is believed: no instruction reaches past what the function is called with, nor for
//! registers that it may not use. In: an instruction, lengths. Out: whether it is within.

use crate::straight::bounds::Lengths;
use crate::straight::place::Register;

use super::instruction::{Instruction, Target};

/// Whether an instruction stays within its memory and its registers.
pub(super) fn is_within(instruction: Instruction, target: Target, lengths: Lengths) -> bool {
    let value = target.lanes.bytes();
    let are_registers = |all: &[Register]| all.iter().all(|register| *register < target.registers);
    match instruction {
        Instruction::Unary { to, of, .. } => are_registers(&[to, of]),
        Instruction::Binary { to, first, second, .. } => are_registers(&[to, first, second]),
        Instruction::Select { to, no, yes, mask } => are_registers(&[to, no, yes, mask]),
        Instruction::Load { to, from } => are_registers(&[to]) && lengths.hold(from, value, false),
        Instruction::Store { from, to } => are_registers(&[from]) && lengths.hold(to, value, true),
        // The result is written, arguments are read.
        Instruction::Argument { number, address } => number < 4 && lengths.hold(address, value, number == 0),
        Instruction::Enter
        | Instruction::Leave
        | Instruction::Keep
        | Instruction::GiveBack
        | Instruction::Call(_)
        | Instruction::Return => true,
    }
}

#[cfg(test)]
mod tests {
    use crate::aarch64::instruction::{Binary, Lanes, Unary};
    use crate::straight::place::{Address, Base};

    use super::*;

    const LENGTHS: Lengths = Lengths { input: 32, output: 32, pool: 16, frame: 32 };

    fn is_found(lanes: Lanes, instruction: Instruction) -> bool {
        let target = Target { lanes, states: lanes.count(), registers: 24 };
        !is_within(instruction, target, LENGTHS)
    }

    fn load(base: Base, offset: i32) -> Instruction {
        Instruction::Load { to: 0, from: Address { base, offset } }
    }

    #[test]
    fn the_last_value_is_within_and_the_next_is_not() {
        for (base, last) in [(Base::Input, 24), (Base::Output, 24), (Base::Pool, 8), (Base::Frame, 24)] {
            assert!(!is_found(Lanes::One, load(base, last)));
            assert!(is_found(Lanes::One, load(base, last + 1)));
            assert!(is_found(Lanes::One, load(base, -1)));
            assert!(!is_found(Lanes::Two, load(base, last - 8)));
            assert!(is_found(Lanes::Two, load(base, last)));
        }
    }

    #[test]
    fn inputs_and_constants_are_never_written() {
        for base in [Base::Input, Base::Pool] {
            let address = Address { base, offset: 0 };
            assert!(is_found(Lanes::One, Instruction::Store { from: 0, to: address }));
            assert!(is_found(Lanes::One, Instruction::Argument { number: 0, address }));
            assert!(!is_found(Lanes::One, Instruction::Argument { number: 1, address }));
            assert!(is_found(Lanes::One, Instruction::Argument { number: 4, address }));
        }
    }

    #[test]
    fn registers_that_may_not_be_used_are_found() {
        let address = Address { base: Base::Frame, offset: 0 };
        for [a, b, c, d] in [[24, 0, 0, 0], [0, 24, 0, 0], [0, 0, 24, 0], [0, 0, 0, 24]] {
            assert!(is_found(Lanes::Two, Instruction::Select { to: a, no: b, yes: c, mask: d }));
            let add = Instruction::Binary { operation: Binary::Add, to: a, first: b, second: c };
            assert_eq!(is_found(Lanes::Two, add), d == 0);
            let root = Instruction::Unary { operation: Unary::SquareRoot, to: a, of: b };
            assert_eq!(is_found(Lanes::Two, root), c == 0 && d == 0);
        }
        assert!(is_found(Lanes::One, Instruction::Load { to: 24, from: address }));
        assert!(is_found(Lanes::One, Instruction::Store { from: 24, to: address }));
    }
}
