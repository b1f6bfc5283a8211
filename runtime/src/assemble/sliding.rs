//! Where journals rest that slide in their bearings. In: a state whose journals rest as without friction. Out: the same with friction.
//! Never knows laws.
//!
//! Friction pulls a journal up the side of its bearing until force and load are in line again: by the angle of friction, atan mu. Started
//! below that place it would swing about it, and nothing damps that: friction of a journal that slides fast takes no energy from a swing.

use super::placing::{carried, place_moving, pressed_along};
use super::reactions::ideal_reactions;
use super::state::State;
use crate::evaluate::Evaluator;
use crate::scalar::{cross, dot};

/// Rounds at most. Each leaves what the moments of friction change of the loads: parts of a thousandth.
const ROUNDS: usize = 12;
/// Forces and loads that are this much in line [rad] are left so.
const IN_LINE: f64 = 1e-9;

/// Moves journals that rest by their normal forces to where they rest with friction too. `ideal`: the state with journals in the middle
/// of their bearings; `turns`: how fast their loads turn [rad/s]. Where that comes no nearer it leaves them.
pub(super) fn settle(
    evaluator: &mut Evaluator<'_>,
    t: f64,
    state: &mut State,
    (placeable, ideal, turns): (&[bool], &State, &[[f64; 3]]),
) {
    let (mut offsets, mut left) = next(evaluator, t, (state, ideal), placeable);
    for _ in 0..ROUNDS {
        if left <= IN_LINE {
            return;
        }
        let mut moved = state.clone();
        if !place_moving(evaluator, t, &mut moved, (&offsets, &carried(turns, &offsets))) {
            return;
        }
        let before = left;
        (offsets, left) = next(evaluator, t, (&moved, ideal), placeable);
        // What is not a number is no nearer either.
        if left.is_nan() || left >= before {
            return;
        }
        *state = moved;
    }
}

/// Offsets [m] at which forces would be in line with loads, were they turned with the journals; and the largest angle between them now
/// [rad], of contacts with friction.
fn next(
    evaluator: &mut Evaluator<'_>,
    t: f64,
    (state, ideal): (&State, &State),
    placeable: &[bool],
) -> (Vec<Option<[f64; 3]>>, f64) {
    evaluator.evaluate_contacts(t, &state.q, &state.v);
    let contacts = evaluator.clearances().contacts().to_vec();
    let forces: Vec<_> = (0..contacts.len()).map(|index| force(evaluator, index)).collect();
    // Without friction a force is along the normal, to its last places.
    let rubs = |index: usize| {
        let (normal, pressed) = (contacts[index].normal(), contacts[index].normal_force);
        let beside: [f64; 3] = core::array::from_fn(|i| forces[index][i] + pressed * normal[i]);
        size(beside) > IN_LINE * pressed
    };
    let mut offsets: Vec<_> =
        contacts.iter().zip(placeable).map(|(touch, free)| free.then_some(touch.offset)).collect();
    if !(0..contacts.len()).any(|index| placeable[index] && rubs(index)) {
        return (offsets, 0.0);
    }
    let moments: Vec<_> =
        contacts.iter().map(|touch| [touch.wrench[3], touch.wrench[4], touch.wrench[5]]).collect();
    let loads = ideal_reactions(evaluator, t, ideal, (placeable, &moments));
    let mut left = 0.0_f64;
    for (index, touch) in contacts.iter().enumerate().filter(|(index, _)| placeable[*index]) {
        let [of_force, of_load] = [size(forces[index]), size(loads[index])];
        if of_force == 0.0 || of_load == 0.0 {
            continue;
        }
        let [force, load] = [forces[index].map(|x| x / of_force), loads[index].map(|x| x / of_load)];
        let normal = touch.normal();
        if rubs(index) {
            left = left.max(angle(force, load));
        }
        let direction = turned(normal, force, load);
        let pressed = -dot(normal, force) * of_load;
        offsets[index] = Some(pressed_along(evaluator, index, direction, pressed));
    }
    (offsets, left)
}

/// Force on a journal [N] in the directions in which it is free.
fn force(evaluator: &Evaluator<'_>, index: usize) -> [f64; 3] {
    let clearances = evaluator.clearances();
    let (wrench, freedoms) = (&clearances.contacts()[index].wrench, clearances.joints()[index].freedoms());
    core::array::from_fn(|axis| if axis < freedoms { wrench[axis] } else { 0.0 })
}

fn size(vector: [f64; 3]) -> f64 {
    dot(vector, vector).sqrt()
}

/// Angle between two unit vectors [rad].
fn angle(a: [f64; 3], b: [f64; 3]) -> f64 {
    size(cross(a, b)).atan2(dot(a, b))
}

/// A vector turned as the shortest turn takes one unit vector to another.
fn turned(vector: [f64; 3], from: [f64; 3], to: [f64; 3]) -> [f64; 3] {
    let (axis, cosine) = (cross(from, to), dot(from, to));
    // Straight against each other no turn is the shortest.
    if cosine <= -1.0 {
        return vector.map(|x| -x);
    }
    let (once, along) = (cross(axis, vector), dot(axis, vector) / (1.0 + cosine));
    core::array::from_fn(|i| vector[i] * cosine + once[i] + axis[i] * along)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shortest_turn_keeps_what_is_along_its_axis() {
        let (from, to) = ([0.0, 0.6, 0.8], [0.0, -0.8, 0.6]);
        let near =
            |a: [f64; 3], b: [f64; 3]| assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-15), "{a:?}");
        near(turned(from, from, to), to);
        near(turned([2.0, 0.0, 0.0], from, to), [2.0, 0.0, 0.0]);
        near(turned([1.0, 0.6, 0.8], from, from), [1.0, 0.6, 0.8]);
        assert!((angle(from, to) - core::f64::consts::FRAC_PI_2).abs() < 1e-15);
    }
}
