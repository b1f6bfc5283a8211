//! From an order to instructions: values in registers, the one that is read last in memory when they run out.
//! In: operations in an order, a [`Processor`]. Out: [`Straight`]. Never knows bytes.
//!
//! Inputs and constants lie in memory from the start, results once they are stored: only other values are ever spilled.

use std::fmt::Debug;

use super::bounds::Lengths;
use super::frame::Frame;
use super::graph::{Function, Graph, Id, Node, Operation};
use super::lower::Lowered;
use super::place::{Address, Base, MOST_REGISTERS, Register, Shape};
use super::pool;
use super::uses::Uses;

/// A value that lies in memory as well gives way to one that does not, if it is read at most so many times sooner.
const PREFER_CLEAN: u64 = 2;

/// What straight-line code wants to know of a processor.
pub(crate) trait Processor: Copy + Debug {
    type Instruction: Copy + Debug;
    /// What the choice of instructions remembers from operation to operation.
    type Memory: Default;

    fn shape(self) -> Shape;

    /// How many values an operation may be done with side by side in one register: 1, 2 or 4.
    fn widest(self) -> usize;

    /// Whether it has [`Operation::Larger`] and [`Operation::Smaller`].
    fn has_extremes(self) -> bool;

    /// How many copies of a constant, side by side, an operation on single values reads, or, if there is none, an output.
    fn copies(self, reader: Option<Operation>) -> usize;

    /// Loads so many values side by side.
    fn load(self, to: Register, from: Address, width: usize) -> Self::Instruction;

    /// Stores so many values side by side.
    fn store(self, from: Register, to: Address, width: usize) -> Self::Instruction;

    /// Puts the address of the result (0) or of an argument where a called function looks for it.
    fn argument(self, number: u8, address: Address) -> Self::Instruction;

    /// Writes an operation that is neither leaf nor call.
    fn operation(allocation: &mut Allocation<'_, Self>, memory: &mut Self::Memory, id: Id);

    /// Calls a function, whose arguments are in place. All values lie in memory meanwhile.
    fn call(allocation: &mut Allocation<'_, Self>, memory: &mut Self::Memory, function: Function);

    /// A function with this body; `registers` from the first one on are used in it.
    fn framed(self, body: Vec<Self::Instruction>, calls: bool, registers: Register)
    -> Vec<Self::Instruction>;

    /// Whether an instruction stays within its memory, and within what the processor has. Memory stays safe by this and
    /// by `encode`, whatever stages before did.
    fn is_within(self, instruction: Self::Instruction, lengths: Lengths) -> bool;

    /// The bytes of instructions; `functions` tells where the functions lie that they call.
    fn encode(self, instructions: &[Self::Instruction], functions: &dyn Fn(Function) -> usize) -> Vec<u8>;
}

/// A function without jumps.
#[derive(Clone, Debug)]
pub(super) struct Straight<I> {
    pub(super) instructions: Vec<I>,
    /// Bits of the constants.
    pub(super) pool: Vec<u64>,
    /// Length of the workspace, in values.
    pub(super) frame: usize,
}

/// Places every operation of `order`, which has all that the outputs need, each after its arguments.
pub(super) fn allocate<P: Processor>(
    lowered: &Lowered,
    order: &[Id],
    processor: P,
) -> Straight<P::Instruction> {
    let graph = &lowered.graph;
    let calls = order.iter().any(|id| matches!(graph.node(*id).operation, Operation::Call(_)));
    let (pool, constants) = pool::lay_out(graph, order, &lowered.outputs, |reader| processor.copies(reader));
    let mut home = vec![None; graph.len()];
    for (id, address) in constants {
        home[id as usize] = Some(address);
    }
    let shape = processor.shape();
    for id in 0..graph.len() as Id {
        if let Operation::Input(index) = graph.node(id).operation {
            home[id as usize] =
                Some(Address { base: Base::Input, offset: (index as usize * shape.step) as i32 });
        }
    }
    let mut outputs: Vec<(Id, u32)> = lowered.outputs.iter().copied().zip(0..).collect();
    outputs.sort_unstable();
    let mut allocation = Allocation {
        processor,
        graph,
        shape,
        uses: Uses::new(graph, order),
        outputs,
        held: [None; MOST_REGISTERS],
        used: 0,
        register: vec![None; graph.len()],
        home,
        frame: Frame::new(shape.value),
        now: 0,
        instructions: Vec::with_capacity(2 * order.len()),
    };
    let mut memory = P::Memory::default();
    allocation.store_leaves();
    for (position, id) in (0..).zip(order) {
        allocation.now = position;
        allocation.operation(&mut memory, *id);
    }
    let Allocation { instructions, used, frame, .. } = allocation;
    Straight { instructions: processor.framed(instructions, calls, used), pool, frame: frame.len() }
}

/// Where every value is, while instructions are written.
pub(crate) struct Allocation<'a, P: Processor> {
    pub(crate) processor: P,
    graph: &'a Graph,
    shape: Shape,
    pub(super) uses: Uses,
    /// Entries of the flat output by the node that they are, sorted.
    outputs: Vec<(Id, u32)>,
    /// What each register holds.
    held: [Option<Id>; MOST_REGISTERS],
    /// How many registers were ever taken.
    used: Register,
    /// The register of every node.
    pub(super) register: Vec<Option<Register>>,
    /// Where in memory every node lies.
    pub(super) home: Vec<Option<Address>>,
    frame: Frame,
    /// Position in the order.
    pub(super) now: u32,
    instructions: Vec<P::Instruction>,
}

impl<P: Processor> Allocation<'_, P> {
    pub(crate) fn node(&self, id: Id) -> Node {
        *self.graph.node(id)
    }

    pub(crate) fn push(&mut self, instruction: P::Instruction) {
        self.instructions.push(instruction);
    }

    fn operation(&mut self, memory: &mut P::Memory, id: Id) {
        let node = self.node(id);
        match node.operation {
            Operation::Call(function) => self.call(memory, id, function),
            // They lie where they lie.
            Operation::Input(_) | Operation::Constant(_) => {}
            _ => P::operation(self, memory, id),
        }
    }

    /// A function may use every vector register: all that is alive lies in memory meanwhile.
    fn call(&mut self, memory: &mut P::Memory, id: Id, function: Function) {
        let node = self.node(id);
        for register in 0..self.shape.registers {
            self.evict(register);
        }
        for (number, argument) in (1..).zip(node.arguments()) {
            let address = self.home_of(*argument);
            self.push(self.processor.argument(number, address));
        }
        let result = self.frame.take(node.width());
        self.push(self.processor.argument(0, result));
        P::call(self, memory, function);
        self.read(&node);
        self.frame.free_ended();
        self.home[id as usize] = Some(result);
        if self.outputs_of(id).next().is_some() {
            let register = self.load(id, &[]);
            self.define(id, register);
        }
        if self.uses.is_over(id) {
            self.frame.end(result, node.width());
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
    pub(crate) fn result(&mut self, node: &Node) -> Register {
        self.read(node);
        self.take(&[])
    }

    /// After an instruction whose result lies in no register and not in memory.
    pub(crate) fn has_read(&mut self, node: &Node) {
        self.read(node);
        self.frame.free_ended();
    }

    /// The result is in `to`: stores it where it is an output.
    pub(crate) fn define(&mut self, id: Id, to: Register) {
        self.frame.free_ended();
        self.held[usize::from(to)] = Some(id);
        self.register[id as usize] = Some(to);
        let stores: Vec<u32> = self.outputs_of(id).collect();
        for index in stores {
            let offset = (index as usize * self.shape.step) as i32;
            let address = Address { base: Base::Output, offset };
            self.push(self.processor.store(to, address, self.node(id).width()));
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
                    self.frame.end(address, self.graph.node(id).width());
                }
            }
        }
    }

    /// Where a value lies in memory; one that is in a register only is written to the frame.
    pub(crate) fn home_of(&mut self, id: Id) -> Address {
        if let Some(address) = self.home[id as usize] {
            return address;
        }
        let width = self.graph.node(id).width();
        let to = self.frame.take(width);
        if let Some(from) = self.register[id as usize] {
            self.push(self.processor.store(from, to, width));
        }
        self.home[id as usize] = Some(to);
        to
    }

    /// The register of a value, loaded if it has none; what `locked` names keeps its own.
    pub(crate) fn load(&mut self, id: Id, locked: &[Id]) -> Register {
        if let Some(register) = self.register[id as usize] {
            return register;
        }
        let address = self.home_of(id);
        let to = self.place(id, locked);
        self.push(self.processor.load(to, address, self.graph.node(id).width()));
        to
    }

    /// A register for a value that lies in none yet; what `locked` names keeps its own.
    pub(crate) fn place(&mut self, id: Id, locked: &[Id]) -> Register {
        let to = self.take(locked);
        self.held[usize::from(to)] = Some(id);
        self.register[id as usize] = Some(to);
        to
    }

    /// Whether a value is in a register or in memory.
    pub(crate) fn is_placed(&self, id: Id) -> bool {
        self.register[id as usize].is_some() || self.home[id as usize].is_some()
    }

    /// The position in the order at which a value is read next.
    pub(crate) fn next_read(&self, id: Id) -> Option<u32> {
        self.uses.after(id, self.now)
    }

    pub(super) fn free_register(&self) -> Option<Register> {
        (0..self.shape.registers).find(|register| self.held[usize::from(*register)].is_none())
    }

    /// A free register, if need be that of the value that is read last.
    fn take(&mut self, locked: &[Id]) -> Register {
        if let Some(register) = self.free_register() {
            self.used = self.used.max(register + 1);
            return register;
        }
        let distance = |register: Register| {
            let id = self.held[usize::from(register)].filter(|id| !locked.contains(id))?;
            let next = self.next_read(id).map_or(u64::from(u32::MAX), u64::from);
            let factor = if self.home[id as usize].is_some() { PREFER_CLEAN } else { 1 };
            Some((next - u64::from(self.now)) * factor)
        };
        let last = (0..self.shape.registers).max_by_key(|register| distance(*register)).unwrap_or_default();
        self.evict(last);
        last
    }

    /// Has what a register holds in memory, and in it no more.
    pub(crate) fn evict(&mut self, register: Register) {
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
