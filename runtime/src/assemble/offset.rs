//! How journals move in their bearings with the free speeds. In: a position. Out: columns and places of the offsets.

use super::held::frozen_speeds;
use super::state::State;
use crate::evaluate::Evaluator;
use crate::linear::Orthogonal;
use crate::system::CONTACT_MOTION;

/// A speed that moves an offset by less than this [m/rad, 1] does not move it.
const MOVES: f64 = 1e-9;
/// Directions in which offsets move by less than this part of the largest are none.
const NO_DIRECTION: f64 = 1e-9;

/// How the offset of every contact moves with every free speed: `[joint][axis][speed]`, exactly, because rates
/// are linear in the speeds.
pub fn offset_columns(evaluator: &mut Evaluator<'_>, t: f64, q: &[f64]) -> Vec<[Vec<f64>; 3]> {
    let (n, contacts) = (evaluator.sizes().speeds, evaluator.sizes().contacts);
    let mut v = vec![0.0; n];
    let still = evaluator.contact_motion(t, q, &v).to_vec();
    let mut columns = vec![[(); 3].map(|()| vec![0.0; n]); contacts];
    for speed in 0..n {
        v[speed] = 1.0;
        let moving = evaluator.contact_motion(t, q, &v);
        for (joint, column) in columns.iter_mut().enumerate() {
            for (axis, row) in column.iter_mut().enumerate() {
                let at = joint * CONTACT_MOTION + 3 + axis;
                row[speed] = moving[at] - still[at];
            }
        }
        v[speed] = 0.0;
    }
    columns
}

/// Joint and axis of every component of the offsets of the joints that count.
pub(super) fn offset_places(
    evaluator: &Evaluator<'_>,
    counts: impl Fn(usize) -> bool,
) -> Vec<(usize, usize)> {
    let joints = evaluator.clearances().joints().iter().enumerate().filter(|(joint, _)| counts(*joint));
    joints.flat_map(|(joint, law)| (0..law.freedoms()).map(move |axis| (joint, axis))).collect()
}

/// Contacts whose offset no demanded start value fixes.
pub(super) fn free_contacts(evaluator: &mut Evaluator<'_>, t: f64, q: &[f64]) -> Vec<bool> {
    let columns = offset_columns(evaluator, t, q);
    free_by(evaluator, &columns)
}

/// The same by how offsets move with the speeds. A start value fixes an offset that moves with it, unless what is free moves the offset
/// in all its directions without it: a link that is demanded to start unbent turns.
fn free_by(evaluator: &Evaluator<'_>, columns: &[[Vec<f64>; 3]]) -> Vec<bool> {
    let fixed = frozen_speeds(evaluator);
    let moved = |column: &[Vec<f64>; 3], speed: usize| column.iter().any(|row| row[speed].abs() > MOVES);
    let mut directions = Orthogonal::new(3, fixed.len());
    let mut moves_everywhere = |column: &[Vec<f64>; 3], freedoms: usize| {
        let free = |row: &Vec<f64>| -> Vec<f64> {
            row.iter().zip(&fixed).map(|(by, fixed)| if *fixed { 0.0 } else { *by }).collect()
        };
        let rows: Vec<f64> = column[..freedoms].iter().flat_map(free).collect();
        directions.factor(&rows, freedoms, fixed.len(), NO_DIRECTION);
        directions.rank() == freedoms
    };
    let freedoms = evaluator.clearances().joints().iter().map(|joint| joint.freedoms());
    let is_free = |(column, freedoms): (&[Vec<f64>; 3], usize)| {
        let is_fixed = (0..fixed.len()).any(|speed| fixed[speed] && moved(column, speed));
        !is_fixed || moves_everywhere(column, freedoms)
    };
    columns.iter().zip(freedoms).map(is_free).collect()
}

/// Joint and axis of every component of their offsets.
pub(super) fn free_offsets(evaluator: &mut Evaluator<'_>, t: f64, q: &[f64]) -> Vec<(usize, usize)> {
    if evaluator.clearances().is_empty() {
        return Vec::new();
    }
    let free = free_contacts(evaluator, t, q);
    offset_places(evaluator, |joint| free[joint])
}

/// How they move with every free speed, row by row.
pub fn rows_of_free_offsets(evaluator: &mut Evaluator<'_>, t: f64, q: &[f64]) -> Vec<f64> {
    if evaluator.clearances().is_empty() {
        return Vec::new();
    }
    let columns = offset_columns(evaluator, t, q);
    let free = free_by(evaluator, &columns);
    let places = offset_places(evaluator, |joint| free[joint]);
    places.iter().flat_map(|(joint, axis)| &columns[*joint][*axis]).copied().collect()
}

/// Where a component of an offset stands in the answer of [`crate::Entry::Contacts`].
pub(super) fn place_in_motion((joint, axis): (usize, usize)) -> usize {
    joint * CONTACT_MOTION + axis
}

/// Natural size of the motion along every free speed at a state: 1, unless it moves a journal in its bearing by more than its
/// clearance. Corrections are smallest relative to it.
pub fn motion_sizes(evaluator: &mut Evaluator<'_>, t: f64, state: &State) -> Vec<f64> {
    let mut sizes = vec![1.0_f64; state.v.len()];
    let columns = offset_columns(evaluator, t, &state.q);
    evaluator.evaluate_contacts(t, &state.q, &state.v);
    for (column, touch) in columns.iter().zip(evaluator.clearances().contacts()) {
        for row in column {
            for (size, moved) in sizes.iter_mut().zip(row) {
                *size = size.min(touch.clearance / moved.abs());
            }
        }
    }
    sizes
}
