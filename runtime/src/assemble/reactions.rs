//! What ideal joints would bear in the place of joints with clearance. In: a state with journals in the middle of their bearings, or
//! at rest. Out: forces on journals, and how fast they turn. Never moves anything.

use super::offset::{offset_columns, offset_places};
use super::placing::TOLERANCE;
use super::state::State;
use crate::evaluate::Evaluator;
use crate::linear::Orthogonal;
use crate::scalar::{cross, dot};
use crate::system::{CONTACT_MOTION, CONTACT_WRENCH};

/// Half width in time of the differences that give accelerations of offsets, and how forces turn [s].
const DIFFERENCE: f64 = 1e-6;
/// Turns of a force in that time [rad] that are its last places, ...
const NO_TURN: f64 = 1e-9;
/// ... and those that are none, but a force which steps or is nearly none.
const STEPS: f64 = 1e-2;

/// Forces [N] on the journals that leave their offsets without acceleration, beside these moments about their centres [N m].
pub(super) fn ideal_reactions(
    evaluator: &mut Evaluator<'_>,
    t: f64,
    state: &State,
    (placeable, moments): (&[bool], &[[f64; 3]]),
) -> Vec<[f64; 3]> {
    let (q, v) = (&state.q[..], &state.v[..]);
    let columns = offset_columns(evaluator, t, q);
    let places = offset_places(evaluator, |joint| placeable[joint]);
    evaluator.evaluate_contacts(t, q, v);
    let mut wrenches = wrenches_with(evaluator, placeable, (&vec![[0.0; 3]; placeable.len()], moments));
    let own = own_accelerations(evaluator, t, state, &places);
    let project = |accelerations: &[f64]| -> Vec<f64> {
        let along =
            |(joint, axis): &(usize, usize)| crate::linear::dot(&columns[*joint][*axis], accelerations);
        places.iter().map(along).collect()
    };
    let unloaded = project(evaluator.accelerations_under(t, q, v, &wrenches).values);
    let n = places.len();
    let mut matrix = vec![0.0; n * n];
    for (column, (joint, axis)) in places.iter().enumerate() {
        wrenches[joint * CONTACT_WRENCH + axis] += 1.0;
        let loaded = project(evaluator.accelerations_under(t, q, v, &wrenches).values);
        wrenches[joint * CONTACT_WRENCH + axis] -= 1.0;
        for row in 0..n {
            matrix[row * n + column] = loaded[row] - unloaded[row];
        }
    }
    let right: Vec<f64> = unloaded.iter().zip(&own).map(|(a, b)| -(a + b)).collect();
    let mut amounts = vec![0.0; n];
    let mut solver = Orthogonal::new(n, n);
    solver.factor(&matrix, n, n, TOLERANCE);
    solver.solve(&right, &mut amounts);
    let mut forces = vec![[0.0; 3]; placeable.len()];
    for ((joint, axis), amount) in places.iter().zip(&amounts) {
        forces[*joint][*axis] = *amount;
    }
    forces
}

/// Accelerations of the offsets without accelerations of the speeds, by a central difference along the motion.
fn own_accelerations(
    evaluator: &mut Evaluator<'_>,
    t: f64,
    state: &State,
    places: &[(usize, usize)],
) -> Vec<f64> {
    let mut rates = |step: f64| -> Vec<f64> {
        let mut q = state.q.clone();
        let moved: Vec<f64> = state.v.iter().map(|v| step * v).collect();
        evaluator.layout().advance(&mut q, &moved);
        let motion = evaluator.contact_motion(t + step, &q, &state.v);
        places.iter().map(|(joint, axis)| motion[joint * CONTACT_MOTION + 3 + axis]).collect()
    };
    let (after, before) = (rates(DIFFERENCE), rates(-DIFFERENCE));
    after.iter().zip(&before).map(|(a, b)| (a - b) / (2.0 * DIFFERENCE)).collect()
}

/// How fast forces on journals turn in their bearings [rad/s], by a central difference along the motion that they leave.
pub(super) fn turning(
    evaluator: &mut Evaluator<'_>,
    t: f64,
    state: &State,
    (placeable, forces): (&[bool], &[[f64; 3]]),
) -> Vec<[f64; 3]> {
    let moments = vec![[0.0; 3]; placeable.len()];
    let wrenches = wrenches_with(evaluator, placeable, (forces, &moments));
    let accelerations = evaluator.accelerations_under(t, &state.q, &state.v, &wrenches).values.to_vec();
    let mut at = |step: f64| {
        let mut moved = state.clone();
        let way: Vec<f64> =
            state.v.iter().zip(&accelerations).map(|(v, a)| step * (v + 0.5 * step * a)).collect();
        evaluator.layout().advance(&mut moved.q, &way);
        moved.v.iter_mut().zip(&accelerations).for_each(|(v, a)| *v += step * a);
        ideal_reactions(evaluator, t + step, &moved, (placeable, &moments))
    };
    let (after, before) = (at(DIFFERENCE), at(-DIFFERENCE));
    let turn = |((force, after), before): ((&[f64; 3], &[f64; 3]), &[f64; 3])| {
        let change = core::array::from_fn(|axis| 0.5 * (after[axis] - before[axis]));
        let turn = cross(*force, change).map(|x| x / dot(*force, *force));
        let size = dot(turn, turn).sqrt();
        // What is not a number turns nothing either.
        if size > NO_TURN && size < STEPS { turn.map(|x| x / DIFFERENCE) } else { [0.0; 3] }
    };
    forces.iter().zip(&after).zip(&before).map(turn).collect()
}

/// Wrenches of all contacts at the last evaluation, with these forces [N] and moments [N m] in the place of those of contacts that can
/// be placed.
fn wrenches_with(
    evaluator: &Evaluator<'_>,
    placeable: &[bool],
    (forces, moments): (&[[f64; 3]], &[[f64; 3]]),
) -> Vec<f64> {
    let mut wrenches = evaluator.clearances().wrenches().to_vec();
    for (joint, wrench) in wrenches.chunks_exact_mut(CONTACT_WRENCH).enumerate() {
        if placeable[joint] {
            wrench[..3].copy_from_slice(&forces[joint]);
            wrench[3..].copy_from_slice(&moments[joint]);
        }
    }
    wrenches
}
