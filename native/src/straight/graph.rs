//! Machine operations of one function as a graph: equal operations are one node.
//! In: operations, each after its arguments. Out: [`Graph`]. Never knows registers or addresses.

use rustc_hash::FxHashMap;

/// Place of a node in its graph; arguments have smaller ones than what is computed from them.
pub(crate) type Id = u32;

/// The sign of a floating point number.
pub(crate) const SIGN: u64 = 1 << 63;

/// What has no instruction of its own and is called.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Function {
    Exp,
    Ln,
    Atan2,
    /// First times second plus third, rounded once.
    MulAdd,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Operation {
    /// Entry of the flat input.
    Input(u32),
    /// A number or a mask, by its bits.
    Constant(u64),
    Add,
    Subtract,
    Multiply,
    Divide,
    SquareRoot,
    /// Of all 64 bits, as the next two.
    And,
    /// Not the first, and the second.
    AndNot,
    Xor,
    /// All bits set where the first is less than the second, else none.
    Less,
    /// The second where the first, a result of `Less`, is set, else the third.
    Select,
    /// The first where it is the larger, else the second; the next one, where it is the smaller. Written for processors that have them.
    Larger,
    Smaller,
    Call(Function),
    /// Of an angle; stands for its operations until they are written out.
    Sine,
    /// As `Sine`.
    Cosine,
    /// Two values side by side in one register, twice as wide.
    Pair,
    /// The first of a pair.
    Low,
    /// The second of a pair.
    High,
}

impl Operation {
    /// Whether it lies in memory before anything is computed.
    pub(crate) const fn is_leaf(self) -> bool {
        matches!(self, Self::Input(_) | Self::Constant(_))
    }
}

/// An operation and what it is computed from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Node {
    pub(crate) operation: Operation,
    /// Those past `count` are zero, so that equal nodes are equal.
    arguments: [Id; 3],
    count: u8,
    /// How many values stand side by side in its register: 1, 2 or 4.
    width: u8,
}

impl Node {
    pub(crate) const fn width(&self) -> usize {
        self.width as usize
    }

    pub(crate) fn arguments(&self) -> &[Id] {
        &self.arguments[..usize::from(self.count)]
    }

    /// Each argument once.
    pub(crate) fn distinct_arguments(&self) -> impl Iterator<Item = Id> {
        let arguments = self.arguments();
        arguments.iter().enumerate().filter(|(at, id)| !arguments[..*at].contains(id)).map(|(_, id)| *id)
    }
}

#[derive(Clone, Debug, Default)]
pub(crate) struct Graph {
    nodes: Vec<Node>,
    known: FxHashMap<Node, Id>,
}

impl Graph {
    /// The node of an operation on at most three arguments, done with each value of a register by itself: arguments are of one width,
    /// and constants of that of what they meet.
    pub(crate) fn node_of<const N: usize>(&mut self, operation: Operation, arguments: [Id; N]) -> Id {
        let width = arguments.iter().map(|id| self.node(*id).width).max().unwrap_or(1);
        let arguments = arguments.map(|id| match self.node(id).operation {
            constant @ Operation::Constant(_) if self.node(id).width < width => {
                self.of_width(constant, [], width)
            }
            _ => id,
        });
        self.of_width(operation, arguments, width)
    }

    /// Two nodes of one width side by side.
    pub(crate) fn pair(&mut self, [low, high]: [Id; 2]) -> Id {
        self.of_width(Operation::Pair, [low, high], 2 * self.node(low).width)
    }

    /// Both halves of a pair.
    pub(crate) fn halves(&mut self, of: Id) -> [Id; 2] {
        let width = self.node(of).width / 2;
        [Operation::Low, Operation::High].map(|half| self.of_width(half, [of], width))
    }

    fn of_width<const N: usize>(&mut self, operation: Operation, arguments: [Id; N], width: u8) -> Id {
        const { assert!(N <= 3) };
        let mut all = [0; 3];
        all[..N].copy_from_slice(&arguments);
        let node = Node { operation, arguments: all, count: N as u8, width };
        *self.known.entry(node).or_insert_with(|| {
            self.nodes.push(node);
            self.nodes.len() as Id - 1
        })
    }

    pub(crate) fn constant(&mut self, bits: u64) -> Id {
        self.node_of(Operation::Constant(bits), [])
    }

    /// Has a node be another operation on two values that it could reach before; the last change of a graph.
    pub(super) fn replace(&mut self, id: Id, operation: Operation, [first, second]: [Id; 2]) {
        let node = &mut self.nodes[id as usize];
        *node = Node { operation, arguments: [first, second, 0], count: 2, ..*node };
    }

    pub(crate) fn node(&self, id: Id) -> &Node {
        &self.nodes[id as usize]
    }

    pub(crate) fn len(&self) -> usize {
        self.nodes.len()
    }
}
