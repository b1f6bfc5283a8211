//! Which instructions do an operation: operands are read from memory where nothing is gained by loading them, comparisons
//! go through the mask register where there is one. Never knows bytes.

use crate::straight::allocate::{Allocation, Processor};
use crate::straight::bounds::Lengths;
use crate::straight::graph::{Function, Id, Node, Operation};
use crate::straight::place::{Address, Base, Register, Shape};

use super::bounds;
use super::encode::Encoder;
use super::instruction::{Binary, Instruction, Lanes, Operand, Target};

impl Processor for Target {
    type Instruction = Instruction;
    /// The node that the mask register holds.
    type Memory = Option<Id>;

    fn shape(self) -> Shape {
        let value = self.lanes.bytes();
        Shape { value, step: value, registers: self.registers, columns: self.columns }
    }

    /// Four lanes read four copies. Eight lanes read one, which their instructions spread, except where a called function
    /// wants all eight. Bitwise operations of one lane read 16 bytes.
    fn copies(self, reader: Option<Operation>) -> usize {
        match (self.lanes, reader) {
            (Lanes::One, reader) => 1 + usize::from(reader.is_some_and(is_bitwise)),
            (Lanes::Four, _) => 4,
            (Lanes::Eight, Some(Operation::Call(_))) => 8,
            (Lanes::Eight, _) => 1,
        }
    }

    fn load(self, to: Register, from: Address) -> Instruction {
        Instruction::Load { to, from: self.in_memory(from) }
    }

    fn store(self, from: Register, to: Address) -> Instruction {
        Instruction::Store { from, to }
    }

    fn argument(self, number: u8, address: Address) -> Instruction {
        Instruction::Argument { number, address }
    }

    fn operation(allocation: &mut Allocation<'_, Self>, mask: &mut Option<Id>, id: Id) {
        let node = allocation.node(id);
        match (node.operation, node.arguments()) {
            (Operation::SquareRoot, [of]) => square_root(allocation, id, *of),
            (Operation::Select, [by, yes, no]) => select(allocation, mask, id, [*by, *yes, *no]),
            (operation, [first, second]) => binary(allocation, mask, id, operation, [*first, *second]),
            // No others are left.
            _ => {}
        }
    }

    fn call(allocation: &mut Allocation<'_, Self>, mask: &mut Option<Id>, function: Function) {
        *mask = None;
        if allocation.processor.lanes != Lanes::One {
            allocation.push(Instruction::ClearUpper);
        }
        allocation.push(Instruction::Call(function));
    }

    fn framed(self, body: Vec<Instruction>, calls: bool, _: Register) -> Vec<Instruction> {
        let mut all = Vec::with_capacity(body.len() + 4);
        all.extend(calls.then_some(Instruction::Enter));
        all.extend(body);
        all.extend((self.lanes != Lanes::One).then_some(Instruction::ClearUpper));
        all.extend(calls.then_some(Instruction::Leave));
        all.push(Instruction::Return);
        all
    }

    fn is_within(self, instruction: Instruction, lengths: Lengths) -> bool {
        bounds::is_within(instruction, self, lengths)
    }

    fn encode(self, instructions: &[Instruction], functions: &dyn Fn(Function) -> usize) -> Vec<u8> {
        let mut encoder = Encoder::new(self, functions);
        for instruction in instructions {
            encoder.instruction(*instruction);
        }
        encoder.finish()
    }
}

impl Target {
    fn in_memory(self, address: Address) -> Operand {
        if self.lanes == Lanes::Eight && address.base == Base::Pool {
            Operand::Broadcast(address)
        } else {
            Operand::Memory(address)
        }
    }
}

fn operand(allocation: &mut Allocation<'_, Target>, id: Id, reader: &Node) -> Operand {
    if let Some(register) = allocation.register_of(id) {
        return Operand::Register(register);
    }
    let address = allocation.home_of(id);
    let target = allocation.processor;
    // Bitwise operations read 16 bytes, which only constants have.
    let too_short = target.lanes == Lanes::One && is_bitwise(reader.operation) && address.base != Base::Pool;
    if too_short || allocation.is_worth_a_register(id) {
        return Operand::Register(allocation.load(id, reader.arguments()));
    }
    target.in_memory(address)
}

fn square_root(allocation: &mut Allocation<'_, Target>, id: Id, of: Id) {
    let node = allocation.node(id);
    let of = if allocation.processor.lanes == Lanes::One {
        Operand::Register(allocation.load(of, &[]))
    } else {
        operand(allocation, of, &node)
    };
    let to = allocation.result(&node);
    allocation.push(Instruction::SquareRoot { to, of });
    allocation.define(id, to);
}

/// Whether arguments may be exchanged without a change of bits.
const fn commutes(operation: Operation) -> bool {
    matches!(operation, Operation::Add | Operation::Multiply | Operation::And | Operation::Xor)
}

/// Whether the instruction reads whole registers even when only one number is asked for.
const fn is_bitwise(operation: Operation) -> bool {
    matches!(operation, Operation::And | Operation::AndNot | Operation::Xor | Operation::Select)
}

fn binary(
    allocation: &mut Allocation<'_, Target>,
    mask: &mut Option<Id>,
    id: Id,
    operation: Operation,
    [first, second]: [Id; 2],
) {
    let node = allocation.node(id);
    let (first, second) =
        if commutes(operation) { allocation.in_good_order(first, second) } else { (first, second) };
    let first = allocation.load(first, node.arguments());
    let second = operand(allocation, second, &node);
    let to = allocation.result(&node);
    let operation = match operation {
        Operation::Add => Binary::Add,
        Operation::Subtract => Binary::Subtract,
        Operation::Multiply => Binary::Multiply,
        Operation::Divide => Binary::Divide,
        Operation::And => Binary::And,
        Operation::AndNot => Binary::AndNot,
        Operation::Xor => Binary::Xor,
        _ => {
            less(allocation, mask, id, to, (first, second));
            return allocation.define(id, to);
        }
    };
    allocation.push(Instruction::Binary { operation, to, first, second });
    allocation.define(id, to);
}

/// Only registers below 16 and no eight lanes can be compared into a register; others go by the mask register.
fn less(
    allocation: &mut Allocation<'_, Target>,
    mask: &mut Option<Id>,
    id: Id,
    to: Register,
    (first, second): (Register, Operand),
) {
    let high = matches!(second, Operand::Register(register) if register > 15) || first > 15 || to > 15;
    if high || allocation.processor.lanes == Lanes::Eight {
        allocation.push(Instruction::LessToMask { first, second });
        allocation.push(Instruction::MaskToRegister { to });
        *mask = Some(id);
    } else {
        allocation.push(Instruction::Binary { operation: Binary::Less, to, first, second });
    }
}

fn select(allocation: &mut Allocation<'_, Target>, mask: &mut Option<Id>, id: Id, [by, yes, no]: [Id; 3]) {
    let node = allocation.node(id);
    let locked = node.arguments();
    let by_mask = allocation.processor.registers > 16;
    let known = by_mask && *mask == Some(by);
    let held = if known { None } else { Some(allocation.load(by, locked)) };
    let no = allocation.load(no, locked);
    let yes = operand(allocation, yes, &node);
    if let (Some(of), true) = (held, by_mask) {
        allocation.push(Instruction::SignToMask { of });
        *mask = Some(by);
    }
    let to = allocation.result(&node);
    allocation.push(match held {
        Some(mask) if !by_mask => Instruction::Select { to, no, yes, mask },
        _ => Instruction::SelectByMask { to, no, yes },
    });
    allocation.define(id, to);
}
