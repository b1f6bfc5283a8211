//! Which instructions do an operation: operands are read from memory where nothing is gained by loading them, comparisons
//! go into mask registers where there are any. Never knows bytes.

use crate::straight::allocate::{Allocation, Processor};
use crate::straight::bounds::Lengths;
use crate::straight::graph::{Function, Id, Node, Operation};
use crate::straight::place::{Address, Base, Register, Shape};

use super::bounds;
use super::emit::push;
use super::encode::Encoder;
use super::instruction::{Binary, Instruction, Lanes, Operand, Target, Wide};
use super::masks::Masks;

impl Processor for Target {
    type Instruction = Wide;
    type Memory = Written;

    fn shape(self) -> Shape {
        let value = self.lanes.bytes();
        Shape { value, step: value, registers: self.registers, columns: self.columns }
    }

    fn widest(self) -> usize {
        if self.lanes == Lanes::One { 4 } else { 1 }
    }

    fn has_extremes(self) -> bool {
        true
    }

    /// Four lanes read four copies. Eight lanes read one, which their instructions spread, except where a called function
    /// wants all eight. Bitwise operations of one lane read 16 bytes.
    fn copies(self, reader: Option<Operation>) -> usize {
        match (self.lanes, reader) {
            (Lanes::One, reader) => 1 + usize::from(reader.is_some_and(is_bitwise)),
            (Lanes::Two, _) => 2,
            (Lanes::Four, _) => 4,
            (Lanes::Eight, Some(Operation::Call(_))) => 8,
            (Lanes::Eight, _) => 1,
        }
    }

    fn load(self, to: Register, from: Address, width: usize) -> Wide {
        self.wide(width, Instruction::Load { to, from: self.in_memory(from) })
    }

    fn store(self, from: Register, to: Address, width: usize) -> Wide {
        self.wide(width, Instruction::Store { from, to })
    }

    fn argument(self, number: u8, address: Address) -> Wide {
        self.wide(1, Instruction::Argument { number, address })
    }

    fn operation(allocation: &mut Allocation<'_, Self>, written: &mut Written, id: Id) {
        let node = allocation.node(id);
        written.upper |= fills_upper(allocation.processor.lanes_of(node.width()));
        match (node.operation, node.arguments()) {
            (Operation::SquareRoot, [of]) => square_root(allocation, id, *of),
            (Operation::Low | Operation::High, [of]) => half(allocation, id, *of),
            (Operation::Pair, [low, high]) => pair(allocation, id, [*low, *high]),
            (Operation::Select, [by, yes, no]) => {
                written.masks.copy(allocation, &[*yes, *no], node.arguments());
                select(allocation, &mut written.masks, id, [*by, *yes, *no]);
            }
            (Operation::Less, [first, second]) if allocation.processor.has_masks() => {
                less_to_mask(allocation, &mut written.masks, id, [*first, *second]);
            }
            (operation, [first, second]) => {
                written.masks.copy(allocation, node.arguments(), node.arguments());
                binary(allocation, id, operation, [*first, *second]);
            }
            // No others are left.
            _ => {}
        }
    }

    fn call(allocation: &mut Allocation<'_, Self>, written: &mut Written, function: Function) {
        written.masks.save(allocation);
        let target = allocation.processor;
        if written.upper || fills_upper(target.lanes) {
            allocation.push(target.wide(1, Instruction::ClearUpper));
            written.upper = false;
        }
        allocation.push(target.wide(1, Instruction::Call(function)));
    }

    fn framed(self, body: Vec<Wide>, calls: bool, _: Register) -> Vec<Wide> {
        let upper = fills_upper(self.lanes) || body.iter().any(|wide| fills_upper(wide.lanes));
        let mut all = Vec::with_capacity(body.len() + 4);
        let alone = |instruction| self.wide(1, instruction);
        all.extend(calls.then_some(Instruction::Enter).map(alone));
        all.extend(body);
        all.extend(upper.then_some(Instruction::ClearUpper).map(alone));
        all.extend(calls.then_some(Instruction::Leave).map(alone));
        all.push(alone(Instruction::Return));
        all
    }

    fn is_within(self, instruction: Wide, lengths: Lengths) -> bool {
        bounds::is_within(instruction, self, lengths)
    }

    fn encode(self, instructions: &[Wide], functions: &dyn Fn(Function) -> usize) -> Vec<u8> {
        let mut encoder = Encoder::new(self, functions);
        for instruction in instructions {
            encoder.instruction(*instruction);
        }
        encoder.finish()
    }
}

/// What earlier operations leave behind.
#[derive(Default)]
pub(crate) struct Written {
    masks: Masks,
    /// Whether upper halves of registers may be in use.
    upper: bool,
}

/// Whether more than the first 16 bytes of registers are written.
const fn fills_upper(lanes: Lanes) -> bool {
    matches!(lanes, Lanes::Four | Lanes::Eight)
}

impl Target {
    /// Whether there are mask registers.
    const fn has_masks(self) -> bool {
        self.registers > 16
    }

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
    let too_short = target.lanes_of(reader.width()) == Lanes::One
        && is_bitwise(reader.operation)
        && address.base != Base::Pool;
    if too_short || allocation.is_worth_a_register(id) {
        return Operand::Register(allocation.load(id, reader.arguments()));
    }
    target.in_memory(address)
}

fn square_root(allocation: &mut Allocation<'_, Target>, id: Id, of: Id) {
    let node = allocation.node(id);
    let of = if allocation.processor.lanes_of(node.width()) == Lanes::One {
        Operand::Register(allocation.load(of, &[]))
    } else {
        operand(allocation, of, &node)
    };
    let to = allocation.result(&node);
    push(allocation, id, Instruction::SquareRoot { to, of });
    allocation.define(id, to);
}

/// Numbers that lie side by side in memory come by one load.
fn pair(allocation: &mut Allocation<'_, Target>, id: Id, [low, high]: [Id; 2]) {
    let node = allocation.node(id);
    if let Some(from) = allocation.side_by_side(low, high) {
        let to = allocation.result(&node);
        push(allocation, id, Instruction::Load { to, from: Operand::Memory(from) });
        return allocation.define(id, to);
    }
    let low = allocation.load(low, node.arguments());
    let high = operand(allocation, high, &node);
    let to = allocation.result(&node);
    push(allocation, id, Instruction::Pair { to, low, high });
    allocation.define(id, to);
}

fn half(allocation: &mut Allocation<'_, Target>, id: Id, pair: Id) {
    let node = allocation.node(id);
    let of = allocation.load(pair, &[]);
    let to = allocation.result(&node);
    let is_low = node.operation == Operation::Low;
    let half = if is_low { Instruction::Low { to, of } } else { Instruction::High { to, of } };
    push(allocation, pair, half);
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

fn binary(allocation: &mut Allocation<'_, Target>, id: Id, operation: Operation, [first, second]: [Id; 2]) {
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
        Operation::Larger => Binary::Larger,
        Operation::Smaller => Binary::Smaller,
        // Without mask registers there are 16 registers and at most four lanes: the shorter encoding has it.
        _ => Binary::Less,
    };
    push(allocation, id, Instruction::Binary { operation, to, first, second });
    allocation.define(id, to);
}

/// No register holds what is less: selections mostly go by the mask alone.
fn less_to_mask(
    allocation: &mut Allocation<'_, Target>,
    masks: &mut Masks,
    id: Id,
    [first, second]: [Id; 2],
) {
    let node = allocation.node(id);
    let first = allocation.load(first, node.arguments());
    let second = operand(allocation, second, &node);
    let mask = masks.take(allocation, id, node.arguments());
    push(allocation, id, Instruction::LessToMask { mask, first, second });
    allocation.has_read(&node);
}

fn select(allocation: &mut Allocation<'_, Target>, masks: &mut Masks, id: Id, [by, yes, no]: [Id; 3]) {
    let node = allocation.node(id);
    let locked = node.arguments();
    let by_mask = allocation.processor.has_masks();
    let mask = if by_mask { masks.mask_of(allocation, by, locked) } else { allocation.load(by, locked) };
    let no = allocation.load(no, locked);
    let yes = operand(allocation, yes, &node);
    let to = allocation.result(&node);
    let select = if by_mask {
        Instruction::SelectByMask { to, no, yes, mask }
    } else {
        Instruction::Select { to, no, yes, mask }
    };
    push(allocation, id, select);
    allocation.define(id, to);
}
