//! The order in which operations run: all orders give the same bits. In: a graph. Out: the operations that its outputs
//! need, each after its arguments.
//!
//! Depth first, the argument that needs more registers before the others, keeps few values alive but makes each
//! operation wait for the one before. So operations are then taken from a window of that order as their arguments
//! come to be ready, as long as not too many values are alive.

use super::graph::{Graph, Id, Operation};
use super::lower::Lowered;

// Of windows of 32 to 2048, 1 to 32 values a register and 1 to 4 operations a cycle these were fastest, on an Intel Xeon with AVX-512: a step
// in eight lanes takes 141 and 82 ns of code (`rssr`, `four_bar_wear`), 158 and 99 by a window of 64; most single states take a twentieth less.

/// How many operations ahead may be taken.
const WINDOW: usize = 512;
/// Values alive, per register, from which on the order is kept.
const CROWDED: usize = 8;
/// Operations that begin in one cycle.
const PER_CYCLE: u32 = 3;

/// The order for so many registers.
pub(super) fn order(lowered: &Lowered, registers: u8) -> Vec<Id> {
    let first = depth_first(lowered);
    interleaved(&lowered.graph, &first, CROWDED * usize::from(registers))
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

/// Takes from the next operations of an order the one whose arguments are ready first; with `crowded` values alive or
/// more, the next one, or one that ends a life.
fn interleaved(graph: &Graph, first: &[Id], crowded: usize) -> Vec<Id> {
    let mut readers = vec![0_u32; graph.len()];
    for id in first {
        for argument in computed(graph, *id) {
            readers[argument as usize] += 1;
        }
    }
    let mut state = State { ready: vec![None; graph.len()], readers, alive: 0, begun: 0 };
    let mut all: Vec<Waiting> = first.iter().map(|id| Waiting::new(graph, *id)).collect();
    let mut rest = 0..all.len() as u32;
    // By their places: short, for they move up as others are taken.
    let mut window: Vec<u32> = rest.by_ref().take(WINDOW).collect();
    let mut order = Vec::with_capacity(first.len());
    while let Some((place, start)) = state.choose(&mut all, &window, crowded) {
        let chosen = &all[window.remove(place) as usize];
        state.take(graph, chosen, start);
        order.push(chosen.id);
        window.extend(rest.next());
    }
    order
}

/// The arguments of a node that are computed.
fn computed(graph: &Graph, id: Id) -> impl Iterator<Item = Id> {
    graph.node(id).distinct_arguments().filter(|argument| !graph.node(*argument).operation.is_leaf())
}

/// An operation in the window. It is looked at many times: what is asked of it lies close together.
struct Waiting {
    id: Id,
    /// Its computed arguments.
    arguments: [Id; 3],
    count: usize,
    /// The cycle at which they are all there; none while one is not ordered.
    ready: Option<u32>,
}

impl Waiting {
    fn new(graph: &Graph, id: Id) -> Self {
        let (mut arguments, mut count) = ([0; 3], 0);
        for (place, argument) in arguments.iter_mut().zip(computed(graph, id)) {
            *place = argument;
            count += 1;
        }
        Self { id, arguments, count, ready: None }
    }

    fn arguments(&self) -> &[Id] {
        &self.arguments[..self.count]
    }
}

/// What is known of the operations that are ordered already.
struct State {
    /// The cycle at which each result is there; none before it is ordered.
    ready: Vec<Option<u32>>,
    /// Operations that still read each value.
    readers: Vec<u32>,
    /// Values that are still read.
    alive: usize,
    /// Operations that could have begun so far, in all cycles.
    begun: u32,
}

impl State {
    /// The place in the window of what runs next, and the cycle at which it can; none if the window is empty.
    fn choose(&self, all: &mut [Waiting], window: &[u32], crowded: usize) -> Option<(usize, u32)> {
        let now = self.begun / PER_CYCLE;
        let is_crowded = self.alive >= crowded;
        let mut best: Option<(usize, u32)> = None;
        for (place, at) in window.iter().enumerate() {
            let waiting = &mut all[*at as usize];
            let ends_a_life = |argument: &Id| self.readers[*argument as usize] == 1;
            if is_crowded && place > 0 && !waiting.arguments().iter().any(ends_a_life) {
                continue;
            }
            if waiting.ready.is_none() {
                let ready = |argument: &Id| self.ready[*argument as usize];
                waiting.ready = waiting.arguments().iter().try_fold(0, |last, id| Some(ready(id)?.max(last)));
            }
            let Some(start) = waiting.ready.map(|ready| ready.max(now)) else { continue };
            if best.is_none_or(|(_, earliest)| start < earliest) {
                best = Some((place, start));
            }
            if start == now {
                break;
            }
        }
        best
    }

    fn take(&mut self, graph: &Graph, chosen: &Waiting, start: u32) {
        self.begun = (self.begun + 1).max(start * PER_CYCLE);
        self.ready[chosen.id as usize] = Some(start + latency(graph.node(chosen.id).operation));
        for argument in chosen.arguments() {
            let readers = &mut self.readers[*argument as usize];
            *readers -= 1;
            self.alive -= usize::from(*readers == 0);
        }
        self.alive += usize::from(self.readers[chosen.id as usize] > 0);
    }
}

/// About how many cycles pass until a result is there.
const fn latency(operation: Operation) -> u32 {
    match operation {
        Operation::Input(_) | Operation::Constant(_) => 0,
        Operation::And | Operation::AndNot | Operation::Xor | Operation::Select => 1,
        Operation::Pair | Operation::Low | Operation::High => 2,
        Operation::Add | Operation::Subtract | Operation::Multiply | Operation::Less => 3,
        Operation::Divide => 13,
        Operation::SquareRoot => 20,
        Operation::Call(_) | Operation::Sine | Operation::Cosine => 60,
    }
}
