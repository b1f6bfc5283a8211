//! From an order to instructions: values in registers, the one that is read last in memory when they run out, operands
//! read from memory where nothing is gained by loading them. In: operations in an order. Out: [`Straight`].
//! Never knows bytes.
//!
//! Inputs and constants lie in memory from the start, results once they are stored: only other values are ever spilled.

use super::frame::Frame;
use super::graph::{Function, Graph, Id, Node, Operation};
use super::instruction::{Address, Base, Binary, Instruction, Lanes, Operand, Register, Target};
use super::lower::Lowered;
use super::pool;
use super::uses::Uses;

/// An operand in memory is loaded if it is read again within so many operations and a register is free.
const SOON: u32 = 8;
/// A value that lies in memory as well gives way to one that does not, if it is read at most so many times sooner.
const PREFER_CLEAN: u64 = 2;

/// A function without jumps.
#[derive(Clone, Debug)]
pub(super) struct Straight {
    pub(super) instructions: Vec<Instruction>,
    /// Bits of the constants.
    pub(super) pool: Vec<u64>,
    /// Length of the workspace, in values.
    pub(super) frame: usize,
}

/// Places every operation of `order`, which has all that the outputs need, each after its arguments.
pub(super) fn allocate(lowered: &Lowered, order: &[Id], target: Target) -> Straight {
    let graph = &lowered.graph;
    let calls = order.iter().any(|id| matches!(graph.node(*id).operation, Operation::Call(_)));
    let (pool, constants) = pool::lay_out(graph, order, &lowered.outputs, target.lanes);
    let mut home = vec![None; graph.len()];
    for (id, address) in constants {
        home[id as usize] = Some(address);
    }
    let size = target.lanes.bytes();
    for id in 0..graph.len() as Id {
        if let Operation::Input(index) = graph.node(id).operation {
            home[id as usize] = Some(Address { base: Base::Input, offset: (index as usize * size) as i32 });
        }
    }
    let mut outputs: Vec<(Id, u32)> = lowered.outputs.iter().copied().zip(0..).collect();
    outputs.sort_unstable();
    let mut allocation = Allocation {
        graph,
        target,
        uses: Uses::new(graph, order),
        outputs,
        held: [None; 32],
        register: vec![None; graph.len()],
        home,
        frame: Frame::new(target.lanes),
        mask: None,
        now: 0,
        instructions: Vec::with_capacity(2 * order.len()),
    };
    if calls {
        allocation.instructions.push(Instruction::Enter);
    }
    allocation.store_leaves();
    for (position, id) in (0..).zip(order) {
        allocation.now = position;
        allocation.operation(*id);
    }
    if target.lanes != Lanes::One {
        allocation.instructions.push(Instruction::ClearUpper);
    }
    if calls {
        allocation.instructions.push(Instruction::Leave);
    }
    allocation.instructions.push(Instruction::Return);
    Straight { instructions: allocation.instructions, pool, frame: allocation.frame.len() }
}

struct Allocation<'a> {
    graph: &'a Graph,
    target: Target,
    uses: Uses,
    /// Entries of the flat output by the node that they are, sorted.
    outputs: Vec<(Id, u32)>,
    /// What each register holds.
    held: [Option<Id>; 32],
    /// The register of every node.
    register: Vec<Option<Register>>,
    /// Where in memory every node lies.
    home: Vec<Option<Address>>,
    frame: Frame,
    /// The node that the mask register holds.
    mask: Option<Id>,
    /// Position in the order.
    now: u32,
    instructions: Vec<Instruction>,
}

impl Allocation<'_> {
    fn operation(&mut self, id: Id) {
        let node = *self.graph.node(id);
        match (node.operation, node.arguments()) {
            (Operation::Call(function), arguments) => self.call(id, function, arguments),
            (Operation::SquareRoot, [of]) => {
                let of = if self.target.lanes == Lanes::One {
                    Operand::Register(self.load(*of, &[]))
                } else {
                    self.operand(*of, &node)
                };
                let to = self.result(&node);
                self.instructions.push(Instruction::SquareRoot { to, of });
                self.define(id, to);
            }
            (Operation::Select, [mask, yes, no]) => self.select(id, *mask, *yes, *no),
            (operation, [first, second]) => self.binary(id, operation, *first, *second),
            // Leaves: they lie where they lie.
            _ => {}
        }
    }

    fn binary(&mut self, id: Id, operation: Operation, first: Id, second: Id) {
        let node = *self.graph.node(id);
        let (mut first, mut second) = (first, second);
        let is_held = |id: Id| self.register[id as usize].is_some();
        let far = |id: Id| self.uses.after(id, self.now).unwrap_or(u32::MAX);
        let exchange = !is_held(first) && (is_held(second) || far(second) < far(first));
        if operation.commutes() && exchange {
            std::mem::swap(&mut first, &mut second);
        }
        let a = self.load(first, node.arguments());
        let b = self.operand(second, &node);
        let to = self.result(&node);
        let operation = match operation {
            Operation::Add => Binary::Add,
            Operation::Subtract => Binary::Subtract,
            Operation::Multiply => Binary::Multiply,
            Operation::Divide => Binary::Divide,
            Operation::And => Binary::And,
            Operation::AndNot => Binary::AndNot,
            Operation::Xor => Binary::Xor,
            _ => return self.less(id, to, a, b),
        };
        self.instructions.push(Instruction::Binary { operation, to, first: a, second: b });
        self.define(id, to);
    }

    /// Only registers below 16 and no eight lanes can be compared into a register; others go by the mask register.
    fn less(&mut self, id: Id, to: Register, first: Register, second: Operand) {
        let high = matches!(second, Operand::Register(register) if register > 15) || first > 15 || to > 15;
        if high || self.target.lanes == Lanes::Eight {
            self.instructions.push(Instruction::LessToMask { first, second });
            self.instructions.push(Instruction::MaskToRegister { to });
            self.mask = Some(id);
        } else {
            self.instructions.push(Instruction::Binary { operation: Binary::Less, to, first, second });
        }
        self.define(id, to);
    }

    fn select(&mut self, id: Id, mask: Id, yes: Id, no: Id) {
        let node = *self.graph.node(id);
        let locked = node.arguments();
        let by_mask = self.target.registers > 16;
        let known = by_mask && self.mask == Some(mask);
        let held = if known { None } else { Some(self.load(mask, locked)) };
        let no = self.load(no, locked);
        let yes = self.operand(yes, &node);
        if let (Some(of), true) = (held, by_mask) {
            self.instructions.push(Instruction::SignToMask { of });
            self.mask = Some(mask);
        }
        let to = self.result(&node);
        self.instructions.push(match held {
            Some(mask) if !by_mask => Instruction::Select { to, no, yes, mask },
            _ => Instruction::SelectByMask { to, no, yes },
        });
        self.define(id, to);
    }

    /// A function may use every vector register: all that is alive lies in memory meanwhile.
    fn call(&mut self, id: Id, function: Function, arguments: &[Id]) {
        for register in 0..self.target.registers {
            self.evict(register);
        }
        self.mask = None;
        for (number, argument) in (1..).zip(arguments) {
            let address = self.home_of(*argument);
            self.instructions.push(Instruction::Argument { number, address });
        }
        let result = self.frame.take();
        self.instructions.push(Instruction::Argument { number: 0, address: result });
        if self.target.lanes != Lanes::One {
            self.instructions.push(Instruction::ClearUpper);
        }
        self.instructions.push(Instruction::Call(function));
        self.read(&self.graph.node(id).clone());
        self.frame.free_ended();
        self.home[id as usize] = Some(result);
        if self.outputs_of(id).next().is_some() {
            let register = self.load(id, &[]);
            self.define(id, register);
        }
        if self.uses.is_over(id) {
            self.frame.end(result);
            self.frame.free_ended();
        }
    }

    /// Outputs that are inputs or constants.
    fn store_leaves(&mut self) {
        let leaves = self.outputs.iter().map(|(id, _)| *id);
        let mut leaves: Vec<Id> = leaves.filter(|id| self.graph.node(*id).operation.is_leaf()).collect();
        leaves.dedup();
        for id in leaves {
            let register = self.load(id, &[]);
            self.define(id, register);
        }
    }

    /// A register for the result of an operation whose operands are in place; those that nothing else reads give theirs.
    fn result(&mut self, node: &Node) -> Register {
        self.read(node);
        self.take(&[])
    }

    /// The result is in `to`: stores it where it is an output.
    fn define(&mut self, id: Id, to: Register) {
        self.frame.free_ended();
        self.held[usize::from(to)] = Some(id);
        self.register[id as usize] = Some(to);
        let stores: Vec<u32> = self.outputs_of(id).collect();
        for index in stores {
            let offset = (index as usize * self.target.lanes.bytes()) as i32;
            let address = Address { base: Base::Output, offset };
            self.instructions.push(Instruction::Store { from: to, to: address });
            self.home[id as usize].get_or_insert(address);
        }
        if self.uses.is_over(id) {
            self.forget(to);
        }
    }

    fn outputs_of(&self, id: Id) -> impl Iterator<Item = u32> {
        let first = self.outputs.partition_point(|(other, _)| *other < id);
        self.outputs[first..].iter().take_while(move |(other, _)| *other == id).map(|(_, index)| *index)
    }

    /// The operands have been read by what comes next: what nothing else reads gives up its places. Those in the
    /// frame are free only after it, for a value may be spilled before.
    fn read(&mut self, node: &Node) {
        for id in node.distinct_arguments() {
            self.uses.read(id);
            if self.uses.is_over(id) {
                if let Some(register) = self.register[id as usize] {
                    self.forget(register);
                }
                if let Some(address) = self.home[id as usize] {
                    self.frame.end(address);
                }
            }
        }
    }

    fn operand(&mut self, id: Id, reader: &Node) -> Operand {
        if let Some(register) = self.register[id as usize] {
            return Operand::Register(register);
        }
        let address = self.home_of(id);
        let lanes = self.target.lanes;
        // Bitwise operations read 16 bytes, which only constants have.
        let too_short = lanes == Lanes::One && reader.operation.is_bitwise() && address.base != Base::Pool;
        let again = self.uses.after(id, self.now).is_some_and(|next| next - self.now <= SOON);
        if too_short || again && self.free_register().is_some() {
            return Operand::Register(self.load(id, reader.arguments()));
        }
        self.in_memory(address)
    }

    fn in_memory(&self, address: Address) -> Operand {
        if self.target.lanes == Lanes::Eight && address.base == Base::Pool {
            Operand::Broadcast(address)
        } else {
            Operand::Memory(address)
        }
    }

    /// Where a value lies in memory; one that is in a register only is written to the frame.
    fn home_of(&mut self, id: Id) -> Address {
        if let Some(address) = self.home[id as usize] {
            return address;
        }
        let to = self.frame.take();
        if let Some(from) = self.register[id as usize] {
            self.instructions.push(Instruction::Store { from, to });
        }
        self.home[id as usize] = Some(to);
        to
    }

    /// The register of a value, loaded if it has none; what `locked` names keeps its own.
    fn load(&mut self, id: Id, locked: &[Id]) -> Register {
        if let Some(register) = self.register[id as usize] {
            return register;
        }
        let address = self.home_of(id);
        let to = self.take(locked);
        self.instructions.push(Instruction::Load { to, from: self.in_memory(address) });
        self.held[usize::from(to)] = Some(id);
        self.register[id as usize] = Some(to);
        to
    }

    fn free_register(&self) -> Option<Register> {
        (0..self.target.registers).find(|register| self.held[usize::from(*register)].is_none())
    }

    /// A free register, if need be that of the value that is read last.
    fn take(&mut self, locked: &[Id]) -> Register {
        if let Some(register) = self.free_register() {
            return register;
        }
        let distance = |register: Register| {
            let id = self.held[usize::from(register)].filter(|id| !locked.contains(id))?;
            let next = self.uses.after(id, self.now).map_or(u64::from(u32::MAX), u64::from);
            let factor = if self.home[id as usize].is_some() { PREFER_CLEAN } else { 1 };
            Some((next - u64::from(self.now)) * factor)
        };
        let last = (0..self.target.registers).max_by_key(|register| distance(*register)).unwrap_or_default();
        self.evict(last);
        last
    }

    fn evict(&mut self, register: Register) {
        if let Some(id) = self.held[usize::from(register)] {
            self.home_of(id);
            self.forget(register);
        }
    }

    fn forget(&mut self, register: Register) {
        if let Some(id) = self.held[usize::from(register)].take() {
            self.register[id as usize] = None;
        }
    }
}
