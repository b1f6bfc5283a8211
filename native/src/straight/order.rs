//! The order in which operations run: all orders give the same bits. In: a graph. Out: the operations that its outputs
//! need, each after its arguments.
//!
//! Depth first, the argument that needs more registers before the others, keeps few values alive but makes each
//! operation wait for the one before. So operations are then taken from a window of that order as their arguments
//! come to be ready, as long as not too many values are alive.

use super::graph::{Graph, Id, Operation};
use super::lower::Lowered;

// Of windows of 32 to 2048, 1 to 32 values a register and 1 to 4 operations a cycle these were fastest with 32 registers, on an Intel Xeon
// with AVX-512: a step in eight lanes takes 141 and 82 ns of code (`rssr`, `four_bar_wear`), 158 and 99 by a window of 64; most single
// states take a twentieth less. With 16 registers, on an AMD EPYC with AVX2, fewer values alive are: a step in four lanes takes 252 and
// 125 ns, 275 and 131 by the numbers for 32.

/// How many operations ahead may be taken.
const WINDOW: usize = 512;

/// How freely operations are taken out of their first order.
#[derive(Clone, Copy)]
struct Freedom {
    /// Values alive from which on the order is kept.
    crowded: usize,
    /// Operations that begin in one cycle.
    per_cycle: u32,
}

impl Freedom {
    /// With so many registers.
    fn new(registers: u8) -> Self {
        let (values, per_cycle) = if registers > 16 { (8, 3) } else { (4, 2) };
        Self { crowded: values * usize::from(registers), per_cycle }
    }
}

/// The order for so many registers.
pub(super) fn order(lowered: &Lowered, registers: u8) -> Vec<Id> {
    let first = depth_first(lowered);
    interleaved(&lowered.graph, &first, Freedom::new(registers))
}

/// Registers that each node would need if nothing were shared (Sethi and Ullman, Journal of the ACM 17, 1970).
fn needs(graph: &Graph) -> Vec<u32> {
    let mut needs: Vec<u32> = Vec::with_capacity(graph.len());
    for id in 0..graph.len() as Id {
        let node = graph.node(id);
        let mut below = [0; 3];
        for (need, argument) in below.iter_mut().zip(node.arguments()) {
            *need = needs[*argument as usize];
        }
        below.sort_unstable_by(|a, b| b.cmp(a));
        let most = (0..).zip(below).filter(|(_, need)| *need > 0).map(|(held, need)| held + need).max();
        needs.push(if node.operation.is_leaf() { 0 } else { most.unwrap_or(0).max(1) });
    }
    needs
}

/// Operations from output to output, each argument as soon as it is wanted.
fn depth_first(lowered: &Lowered) -> Vec<Id> {
    let graph = &lowered.graph;
    let needs = needs(graph);
    let mut placed = vec![false; graph.len()];
    let mut order = Vec::new();
    let mut open: Vec<(Id, bool)> = Vec::new();
    let needed = lowered.needed();
    for output in lowered.first.iter().filter(|id| needed[**id as usize]).chain(&lowered.outputs) {
        open.push((*output, false));
        while let Some((id, arguments_are_placed)) = open.pop() {
            if placed[id as usize] || graph.node(id).operation.is_leaf() {
                continue;
            }
            if arguments_are_placed {
                placed[id as usize] = true;
                order.push(id);
                continue;
            }
            open.push((id, true));
            let mut arguments: Vec<Id> = graph.node(id).distinct_arguments().collect();
            // The last one pushed is the first one placed.
            arguments.reverse();
            arguments.sort_by_key(|argument| needs[*argument as usize]);
            open.extend(arguments.into_iter().map(|argument| (argument, false)));
        }
    }
    order
}

/// Takes from the next operations of an order the one whose arguments are ready first; with too many values alive the next one, or one
/// that ends a life.
fn interleaved(graph: &Graph, first: &[Id], freedom: Freedom) -> Vec<Id> {
    let mut state = State::new(graph, first, freedom);
    let mut order = Vec::with_capacity(first.len());
    while let Some(chosen) = state.choose() {
        state.take(graph, first, chosen);
        order.push(first[chosen.place as usize]);
    }
    order
}

/// The arguments of a node that are computed.
fn computed(graph: &Graph, id: Id) -> impl Iterator<Item = Id> {
    graph.node(id).distinct_arguments().filter(|argument| !graph.node(*argument).operation.is_leaf())
}

/// An operation of the window whose arguments are all ordered. It is looked at many times: what is asked of it lies close together.
#[derive(Clone, Copy)]
struct Ready {
    /// Its place in the first order.
    place: u32,
    /// The cycle at which its arguments are all there.
    at: u32,
    /// Its computed arguments, by their places.
    arguments: [u32; 3],
    count: u32,
}

/// What is known of the operations that are ordered already, and of those that may be next. Operations go by their places.
struct State {
    /// The computed arguments of each, and how many these are; of these, how many are not ordered yet; the cycle at which the others are
    /// all there.
    arguments: Vec<([u32; 3], u32)>,
    missing: Vec<u32>,
    at: Vec<u32>,
    /// Who reads each value, one behind the other, and where those of each begin.
    readers: Vec<u32>,
    readers_of: Vec<u32>,
    /// Operations that still read each value.
    left: Vec<u32>,
    /// Where the window ends, and those in it that can be next, by their places.
    window_end: u32,
    ready: Vec<Ready>,
    /// Values that are still read.
    alive: usize,
    /// Operations that could have begun so far, in all cycles.
    begun: u32,
    freedom: Freedom,
}

impl State {
    fn new(graph: &Graph, first: &[Id], freedom: Freedom) -> Self {
        let mut places = vec![0_u32; graph.len()];
        (0..).zip(first).for_each(|(place, id)| places[*id as usize] = place);
        let mut arguments = vec![([0; 3], 0_u32); first.len()];
        let mut left = vec![0_u32; first.len()];
        for ((list, count), id) in arguments.iter_mut().zip(first) {
            for (slot, argument) in list.iter_mut().zip(computed(graph, *id)) {
                *slot = places[argument as usize];
                left[*slot as usize] += 1;
                *count += 1;
            }
        }
        let mut readers_of = vec![0];
        readers_of.extend(left.iter().scan(0, |sum, count| {
            *sum += count;
            Some(*sum)
        }));
        let mut next = readers_of.clone();
        let mut readers = vec![0; readers_of.last().map_or(0, |all| *all as usize)];
        for (place, (list, count)) in (0..).zip(&arguments) {
            for argument in &list[..*count as usize] {
                let slot = &mut next[*argument as usize];
                readers[*slot as usize] = place;
                *slot += 1;
            }
        }
        let missing = arguments.iter().map(|(_, count)| *count).collect();
        let at = vec![0; first.len()];
        let (window_end, ready) = (0, Vec::with_capacity(WINDOW));
        let (alive, begun) = (0, 0);
        let mut state = Self {
            arguments,
            missing,
            at,
            readers,
            readers_of,
            left,
            window_end,
            ready,
            alive,
            begun,
            freedom,
        };
        (0..WINDOW).for_each(|_| state.widen());
        state
    }

    /// Takes one more operation into the window, if there is one.
    fn widen(&mut self) {
        let place = self.window_end;
        if (place as usize) < self.arguments.len() {
            self.window_end += 1;
            if self.missing[place as usize] == 0 {
                self.ready.push(self.ready_at(place));
            }
        }
    }

    fn ready_at(&self, place: u32) -> Ready {
        let (arguments, count) = self.arguments[place as usize];
        Ready { place, at: self.at[place as usize], arguments, count }
    }

    /// What runs next; none if the window is empty.
    fn choose(&mut self) -> Option<Ready> {
        let now = self.begun / self.freedom.per_cycle;
        let is_crowded = self.alive >= self.freedom.crowded;
        let mut best: Option<(usize, u32)> = None;
        // The first of the window comes before all that could need it.
        for (index, ready) in self.ready.iter().enumerate() {
            let ends_a_life = |argument: &u32| self.left[*argument as usize] == 1;
            let arguments = &ready.arguments[..ready.count as usize];
            if is_crowded && index > 0 && !arguments.iter().any(ends_a_life) {
                continue;
            }
            let start = ready.at.max(now);
            if best.is_none_or(|(_, earliest)| start < earliest) {
                best = Some((index, start));
            }
            if start == now {
                break;
            }
        }
        best.map(|(index, start)| Ready { at: start, ..self.ready.remove(index) })
    }

    fn take(&mut self, graph: &Graph, first: &[Id], chosen: Ready) {
        self.begun = (self.begun + 1).max(chosen.at * self.freedom.per_cycle);
        for argument in &chosen.arguments[..chosen.count as usize] {
            let left = &mut self.left[*argument as usize];
            *left -= 1;
            self.alive -= usize::from(*left == 0);
        }
        let place = chosen.place as usize;
        self.alive += usize::from(self.left[place] > 0);
        self.widen();
        let done = chosen.at + latency(graph.node(first[place]).operation);
        for reader in self.readers_of[place]..self.readers_of[place + 1] {
            let reader = self.readers[reader as usize];
            let at = &mut self.at[reader as usize];
            *at = done.max(*at);
            self.missing[reader as usize] -= 1;
            if self.missing[reader as usize] == 0 && reader < self.window_end {
                let ready = self.ready_at(reader);
                let index = self.ready.partition_point(|known| known.place < reader);
                self.ready.insert(index, ready);
            }
        }
    }
}

/// About how many cycles pass until a result is there.
const fn latency(operation: Operation) -> u32 {
    match operation {
        Operation::Input(_) | Operation::Constant(_) => 0,
        Operation::And | Operation::AndNot | Operation::Xor | Operation::Select => 1,
        Operation::Pair | Operation::Low | Operation::High => 2,
        Operation::Add | Operation::Subtract | Operation::Multiply | Operation::Less => 3,
        Operation::Larger | Operation::Smaller => 3,
        Operation::Divide => 13,
        Operation::SquareRoot => 20,
        Operation::Call(_) | Operation::Sine | Operation::Cosine => 60,
    }
}
