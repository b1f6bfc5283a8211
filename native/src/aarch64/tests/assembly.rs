//! Instructions as assembly text, one line for each of the machine's.

use crate::aarch64::instruction::{Binary, Instruction, Lanes, Unary};
use crate::straight::place::{Address, Base, Register};

/// The address of every called function.
pub(super) const FUNCTION: u64 = 0x1234_5678_9ABC;

pub(super) struct Assembly {
    lanes: Lanes,
    entered: bool,
}

impl Assembly {
    pub(super) fn new(lanes: Lanes) -> Self {
        Self { lanes, entered: false }
    }

    pub(super) fn lines(&mut self, instruction: Instruction) -> Vec<String> {
        match instruction {
            Instruction::Unary { operation, to, of } => {
                let name = match operation {
                    Unary::SquareRoot => "fsqrt",
                    Unary::Negate => "fneg",
                    Unary::Absolute => "fabs",
                };
                vec![format!("{name} {}, {}", self.numbers(to), self.numbers(of))]
            }
            Instruction::Binary { operation, to, first, second } => {
                vec![self.binary(operation, to, first, second)]
            }
            Instruction::Select { to, no, yes, mask } => self.select(to, no, yes, mask),
            Instruction::Load { to, from } => self.memory("ldr", to, from),
            Instruction::Store { from, to } => self.memory("str", from, to),
            Instruction::Enter => {
                self.entered = true;
                let saves = ["stp x29, x30, [sp, #-48]!", "mov x29, sp"];
                let more = ["stp x19, x20, [sp, #16]", "stp x21, x22, [sp, #32]"];
                let moves = ["mov x19, x0", "mov x20, x1", "mov x21, x2", "mov x22, x3"];
                saves.into_iter().chain(more).chain(moves).map(str::to_owned).collect()
            }
            Instruction::Leave => {
                ["ldp x21, x22, [sp, #32]", "ldp x19, x20, [sp, #16]", "ldp x29, x30, [sp], #48"]
                    .map(str::to_owned)
                    .into()
            }
            Instruction::Keep => [
                "stp d8, d9, [sp, #-64]!",
                "stp d10, d11, [sp, #16]",
                "stp d12, d13, [sp, #32]",
                "stp d14, d15, [sp, #48]",
            ]
            .map(str::to_owned)
            .into(),
            Instruction::GiveBack => [
                "ldp d14, d15, [sp, #48]",
                "ldp d12, d13, [sp, #32]",
                "ldp d10, d11, [sp, #16]",
                "ldp d8, d9, [sp], #64",
            ]
            .map(str::to_owned)
            .into(),
            Instruction::Argument { number, address: Address { base, offset } } => {
                let base = self.pointer(base);
                if (0..4096).contains(&offset) {
                    return vec![format!("add x{number}, {base}, #{offset}")];
                }
                let mut lines = of_offset(offset);
                lines.push(format!("add x{number}, {base}, w16, sxtw"));
                lines
            }
            Instruction::Call(_) => {
                let part = |place: u32| FUNCTION >> (16 * place) & 0xFFFF;
                let mut lines = vec![format!("movz x16, #{}", part(0))];
                lines.extend((1..4).map(|place| format!("movk x16, #{}, lsl #{}", part(place), 16 * place)));
                lines.push("blr x16".into());
                lines
            }
            Instruction::Return => vec!["ret".into()],
        }
    }

    fn binary(&self, operation: Binary, to: Register, first: Register, second: Register) -> String {
        let numbers = |name: &str, first: Register, second: Register| {
            format!("{name} {}, {}, {}", self.numbers(to), self.numbers(first), self.numbers(second))
        };
        match operation {
            Binary::Add => numbers("fadd", first, second),
            Binary::Subtract => numbers("fsub", first, second),
            Binary::Multiply => numbers("fmul", first, second),
            Binary::Divide => numbers("fdiv", first, second),
            // The second is greater than the first.
            Binary::Less => numbers("fcmgt", second, first),
            Binary::And => self.bits("and", to, first, second),
            // The second, and not the first.
            Binary::AndNot => self.bits("bic", to, second, first),
            Binary::Xor => self.bits("eor", to, first, second),
        }
    }

    fn select(&self, to: Register, no: Register, yes: Register, mask: Register) -> Vec<String> {
        if to == no {
            return vec![self.bits("bit", to, yes, mask)];
        }
        if to == yes {
            return vec![self.bits("bif", to, no, mask)];
        }
        let chosen = self.bits("bsl", to, yes, no);
        if to == mask { vec![chosen] } else { vec![self.bits("orr", to, mask, mask), chosen] }
    }

    fn bits(&self, name: &str, to: Register, first: Register, second: Register) -> String {
        let length = match self.lanes {
            Lanes::One => "8b",
            Lanes::Two => "16b",
        };
        let [to, first, second] = [to, first, second].map(|number| format!("v{}.{length}", vector(number)));
        format!("{name} {to}, {first}, {second}")
    }

    fn numbers(&self, number: Register) -> String {
        match self.lanes {
            Lanes::One => format!("d{}", vector(number)),
            Lanes::Two => format!("v{}.2d", vector(number)),
        }
    }

    fn memory(&self, name: &str, number: Register, Address { base, offset }: Address) -> Vec<String> {
        let letter = if self.lanes == Lanes::One { "d" } else { "q" };
        let (number, base) = (vector(number), self.pointer(base));
        let value = self.lanes.bytes() as i32;
        if offset >= 0 && offset % value == 0 && offset / value < 4096 {
            return vec![format!("{name} {letter}{number}, [{base}, #{offset}]")];
        }
        let mut lines = of_offset(offset);
        lines.push(format!("{name} {letter}{number}, [{base}, w16, sxtw]"));
        lines
    }

    fn pointer(&self, base: Base) -> &'static str {
        let [passed, kept] = match base {
            Base::Input => ["x0", "x19"],
            Base::Output => ["x1", "x20"],
            Base::Pool => ["x2", "x21"],
            Base::Frame => ["x3", "x22"],
        };
        if self.entered { kept } else { passed }
    }
}

/// v8 to v15, which a caller wants back, are the last.
fn vector(number: Register) -> Register {
    const ORDER: [Register; 32] = [
        0, 1, 2, 3, 4, 5, 6, 7, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30, 31, 8, 9, 10, 11,
        12, 13, 14, 15,
    ];
    ORDER[usize::from(number)]
}

fn of_offset(offset: i32) -> Vec<String> {
    let low = format!("movz w16, #{}", offset & 0xFFFF);
    let high = format!("movk w16, #{}, lsl #16", offset >> 16 & 0xFFFF);
    if (0..65536).contains(&offset) { vec![low] } else { vec![low, high] }
}
