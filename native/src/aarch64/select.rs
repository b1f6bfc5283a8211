//! Which instructions do an operation: operands are in registers, and signs have instructions of their own.
//! Never knows bytes.

use crate::straight::allocate::{Allocation, Processor};
use crate::straight::bounds::Lengths;
use crate::straight::graph::{Function, Id, Operation, SIGN};
use crate::straight::place::{Address, Register, Shape};

use super::bounds;
use super::encode::Encoder;
use super::instruction::{Binary, Instruction, KEPT, Target, Unary};

impl Processor for Target {
    type Instruction = Instruction;
    type Memory = ();

    fn shape(self) -> Shape {
        let step = size_of::<f64>() * self.states;
        Shape { value: self.lanes.bytes(), step, registers: self.registers, columns: false }
    }

    fn widest(self) -> usize {
        1
    }

    /// Its own have other answers where numbers are equal or none.
    fn has_extremes(self) -> bool {
        false
    }

    /// What is loaded is as long as any value.
    fn copies(self, _: Option<Operation>) -> usize {
        self.lanes.count()
    }

    fn load(self, to: Register, from: Address, _: usize) -> Instruction {
        Instruction::Load { to, from }
    }

    fn store(self, from: Register, to: Address, _: usize) -> Instruction {
        Instruction::Store { from, to }
    }

    fn argument(self, number: u8, address: Address) -> Instruction {
        Instruction::Argument { number, address }
    }

    fn operation(allocation: &mut Allocation<'_, Self>, (): &mut (), id: Id) {
        let node = allocation.node(id);
        let is = |id: Id, bits: u64| allocation.node(id).operation == Operation::Constant(bits);
        match (node.operation, node.arguments()) {
            (Operation::SquareRoot, [of]) => unary(allocation, id, Unary::SquareRoot, *of),
            (Operation::Xor, [of, sign]) if is(*sign, SIGN) => unary(allocation, id, Unary::Negate, *of),
            (Operation::And, [of, rest]) if is(*rest, !SIGN) => unary(allocation, id, Unary::Absolute, *of),
            (Operation::Select, [mask, yes, no]) => select(allocation, id, *mask, *yes, *no),
            (Operation::Add, _) => binary(allocation, id, Binary::Add),
            (Operation::Subtract, _) => binary(allocation, id, Binary::Subtract),
            (Operation::Multiply, _) => binary(allocation, id, Binary::Multiply),
            (Operation::Divide, _) => binary(allocation, id, Binary::Divide),
            (Operation::And, _) => binary(allocation, id, Binary::And),
            (Operation::AndNot, _) => binary(allocation, id, Binary::AndNot),
            (Operation::Xor, _) => binary(allocation, id, Binary::Xor),
            (Operation::Less, _) => binary(allocation, id, Binary::Less),
            // No others are left.
            _ => {}
        }
    }

    fn call(allocation: &mut Allocation<'_, Self>, (): &mut (), function: Function) {
        allocation.push(Instruction::Call(function));
    }

    fn framed(self, body: Vec<Instruction>, calls: bool, registers: Register) -> Vec<Instruction> {
        let keeps = registers > KEPT;
        let mut all = Vec::with_capacity(body.len() + 5);
        all.extend(calls.then_some(Instruction::Enter));
        all.extend(keeps.then_some(Instruction::Keep));
        all.extend(body);
        all.extend(keeps.then_some(Instruction::GiveBack));
        all.extend(calls.then_some(Instruction::Leave));
        all.push(Instruction::Return);
        all
    }

    fn is_within(self, instruction: Instruction, lengths: Lengths) -> bool {
        bounds::is_within(instruction, self, lengths)
    }

    fn encode(self, instructions: &[Instruction], functions: &dyn Fn(Function) -> usize) -> Vec<u8> {
        let mut encoder = Encoder::new(self.lanes, functions);
        for instruction in instructions {
            encoder.instruction(*instruction);
        }
        encoder.finish()
    }
}

fn unary(allocation: &mut Allocation<'_, Target>, id: Id, operation: Unary, of: Id) {
    let node = allocation.node(id);
    let of = allocation.load(of, node.arguments());
    let to = allocation.result(&node);
    allocation.push(Instruction::Unary { operation, to, of });
    allocation.define(id, to);
}

fn binary(allocation: &mut Allocation<'_, Target>, id: Id, operation: Binary) {
    let node = allocation.node(id);
    if let [first, second] = *node.arguments() {
        let first = allocation.load(first, node.arguments());
        let second = allocation.load(second, node.arguments());
        let to = allocation.result(&node);
        allocation.push(Instruction::Binary { operation, to, first, second });
        allocation.define(id, to);
    }
}

fn select(allocation: &mut Allocation<'_, Target>, id: Id, mask: Id, yes: Id, no: Id) {
    let node = allocation.node(id);
    let [mask, yes, no] = [mask, yes, no].map(|argument| allocation.load(argument, node.arguments()));
    let to = allocation.result(&node);
    allocation.push(Instruction::Select { to, no, yes, mask });
    allocation.define(id, to);
}
