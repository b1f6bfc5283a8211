//! Sines and cosines as machine operations, those of several angles side by side in one register: one number at a time leaves most of it
//! empty. In: operations with sines as one each. Out: the same without any. Every number has the bits that it would have alone.

use std::collections::BTreeMap;

use super::graph::{Id, Node, Operation};
use super::lower::Lowered;
use super::number::Recorder;

/// Writes sines and cosines out, for at most so many angles side by side.
pub(super) fn written_out(lowered: Lowered, widest: usize) -> Lowered {
    let needed = lowered.needed();
    let steps = steps(&lowered, &needed);
    if steps.iter().all(|step| step.angles.is_empty()) {
        return lowered;
    }
    let recorder = Recorder::default();
    let mut places: Vec<Id> = vec![0; lowered.graph.len()];
    for Step { others, angles } in steps {
        for id in others {
            places[id as usize] = copied(&recorder, lowered.graph.node(id), &places);
        }
        let angles: Vec<(Id, [Option<Id>; 2])> = angles.into_iter().collect();
        for group in angles.chunks(widest) {
            let of: Vec<Id> = group.iter().map(|(angle, _)| places[*angle as usize]).collect();
            for ((_, asked), found) in group.iter().zip(sines(&recorder, &of)) {
                for (asked, found) in asked.iter().zip(found) {
                    if let Some(asked) = asked {
                        places[*asked as usize] = found;
                    }
                }
            }
        }
    }
    let placed = |ids: &[Id]| ids.iter().map(|id| places[*id as usize]).collect();
    let first: Vec<Id> = lowered.first.iter().copied().filter(|id| needed[*id as usize]).collect();
    let (first, outputs) = (placed(&first), placed(&lowered.outputs));
    Lowered { graph: recorder.into_graph(), inputs: lowered.inputs, first, outputs }
}

/// What is computed without further sines, then the angles that are known by it, with the nodes of their sine and cosine. Angles of one
/// step never wait for each other.
#[derive(Default)]
struct Step {
    others: Vec<Id>,
    angles: BTreeMap<Id, [Option<Id>; 2]>,
}

/// The steps of all that outputs need.
fn steps(lowered: &Lowered, needed: &[bool]) -> Vec<Step> {
    let graph = &lowered.graph;
    let mut steps: Vec<Step> = Vec::new();
    let mut step_of: Vec<usize> = vec![0; graph.len()];
    for id in (0..graph.len() as Id).filter(|id| needed[*id as usize]) {
        let node = graph.node(id);
        let at = node.arguments().iter().map(|argument| step_of[*argument as usize]).max().unwrap_or(0);
        if steps.len() <= at {
            steps.resize_with(at + 1, Step::default);
        }
        let half = match node.operation {
            Operation::Sine => 0,
            Operation::Cosine => 1,
            _ => {
                step_of[id as usize] = at;
                steps[at].others.push(id);
                continue;
            }
        };
        step_of[id as usize] = at + 1;
        if let [angle] = node.arguments() {
            steps[at].angles.entry(*angle).or_default()[half] = Some(id);
        }
    }
    steps
}

/// The same operation in another graph.
fn copied(recorder: &Recorder, node: &Node, places: &[Id]) -> Id {
    let place = |id: &Id| places[*id as usize];
    let mut graph = recorder.graph();
    match node.arguments() {
        [] => graph.node_of(node.operation, []),
        [a] => graph.node_of(node.operation, [a].map(place)),
        [a, b] => graph.node_of(node.operation, [a, b].map(place)),
        [a, b, c, ..] => graph.node_of(node.operation, [a, b, c].map(place)),
    }
}

/// Sine and cosine of each angle.
fn sines(recorder: &Recorder, angles: &[Id]) -> Vec<[Id; 2]> {
    let mut side_by_side = angles.to_vec();
    let last = side_by_side.last().copied().unwrap_or_default();
    side_by_side.resize(angles.len().next_power_of_two(), last);
    while side_by_side.len() > 1 {
        let pairs = side_by_side.chunks_exact(2).map(|pair| recorder.graph().pair([pair[0], pair[1]]));
        side_by_side = pairs.collect();
    }
    let (sine, cosine) = linkwear_runtime::sin_cos(recorder.of_node(side_by_side[0]));
    let apart = |number| {
        let mut values = vec![recorder.id(number)];
        while values.len() < angles.len() {
            values = values.iter().flat_map(|value| recorder.graph().halves(*value)).collect();
        }
        values
    };
    apart(sine)
        .into_iter()
        .zip(apart(cosine))
        .take(angles.len())
        .map(|(sine, cosine)| [sine, cosine])
        .collect()
}
