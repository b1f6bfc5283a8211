//! Where in an order each value is read. In: a graph and an order. Out: [`Uses`].

use super::graph::{Graph, Id};

/// For every node the positions in the order at which it is read, and how many of them are past.
#[derive(Clone, Debug)]
pub(super) struct Uses {
    positions: Vec<u32>,
    /// First position that is not past, of every node.
    next: Vec<u32>,
    /// End of the positions, of every node.
    end: Vec<u32>,
}

impl Uses {
    pub(super) fn new(graph: &Graph, order: &[Id]) -> Self {
        let mut end = vec![0_u32; graph.len()];
        for id in order {
            for argument in graph.node(*id).distinct_arguments() {
                end[argument as usize] += 1;
            }
        }
        let mut sum = 0;
        let mut next = Vec::with_capacity(graph.len());
        for count in &mut end {
            next.push(sum);
            sum += *count;
            *count = sum;
        }
        let mut positions = vec![0; sum as usize];
        let mut fill = next.clone();
        for (position, id) in (0..).zip(order) {
            for argument in graph.node(*id).distinct_arguments() {
                let place = &mut fill[argument as usize];
                positions[*place as usize] = position;
                *place += 1;
            }
        }
        Self { positions, next, end }
    }

    /// The first position after `now` at which a value is read.
    pub(super) fn after(&self, id: Id, now: u32) -> Option<u32> {
        let (from, to) = (self.next[id as usize] as usize, self.end[id as usize] as usize);
        self.positions[from..to].iter().copied().find(|position| *position > now)
    }

    /// One of its reads is past.
    pub(super) fn read(&mut self, id: Id) {
        self.next[id as usize] += 1;
    }

    pub(super) fn is_over(&self, id: Id) -> bool {
        self.next[id as usize] >= self.end[id as usize]
    }
}
