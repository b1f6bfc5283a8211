//! Whether the parts of joints with clearance can be put together at all. In: closed loops, journals anywhere. Out: the
//! position nearest to it with every journal as near to the middle of its bearing as the loops let it, or the joint
//! that cannot be assembled. Never knows forces.

use super::held::frozen_speeds;
use super::newton::Newton;
use super::offset::{offset_columns, offset_places};
use super::speeds;
use super::state::State;
use crate::error::AssemblyError;
use crate::evaluate::Evaluator;
use crate::linear::{Orthogonal, add_scaled, dot};

/// A start may press a journal into its bearing by this many radial clearances. Contacts at rest of loads that
/// bearings carry stay below one; parts that do not fit together miss by hundreds.
pub(super) const DEEPEST_START: f64 = 1.0;
/// Singular values below this part of the largest count as zero.
const TOLERANCE: f64 = 1e-10;
/// Gauss-Newton halves the distance from the guess in a few steps each; more is no convergence.
const MAX_ITERATIONS: usize = 60;
/// The sum of squares falls by less than this part: the offsets are as small as they get.
const NO_BETTER: f64 = 1e-6;
/// How well offsets are known then: a minimum is flat. Of joints that are as far outside but for this, the last is named,
/// so that rounding does not choose.
const ALIKE: f64 = 1e-3;
/// Parts of a step that are tried: 1, 1/2 and so on.
const HALVINGS: usize = 12;

/// Whether every journal in question is pressed in by at most `deepest` radial clearances.
///
/// # Errors
/// [`AssemblyError::OutsideClearance`] with the joint that is farthest outside, in clearances.
pub(super) fn check(
    evaluator: &mut Evaluator<'_>,
    t: f64,
    state: &State,
    (asked, deepest): (&[bool], f64),
) -> Result<(), AssemblyError> {
    evaluator.evaluate_contacts(t, &state.q, &state.v);
    let contacts = evaluator.clearances().contacts().iter().enumerate();
    let depths = contacts.filter(|(joint, _)| asked[*joint]).map(|(joint, touch)| {
        // What is not a number is not within.
        let depth = touch.penetration() / touch.clearance;
        (joint, if depth.is_nan() { f64::INFINITY } else { depth }, touch)
    });
    let worse =
        |worst: (_, f64, _), next: (_, f64, _)| if worst.1 > (1.0 + ALIKE) * next.1 { worst } else { next };
    match depths.reduce(worse) {
        Some((joint, depth, touch)) if depth > deepest => Err(AssemblyError::OutsideClearance {
            joint: evaluator.description().contacts[joint].joint.to_string(),
            distance: touch.clearance + touch.penetration(),
            clearance: touch.clearance,
        }),
        _ => Ok(()),
    }
}

/// Moves journals towards the middles of their bearings as far as loops and demanded start values let them, offsets
/// counted in clearances, and closes the loops and their speeds again.
///
/// # Errors
/// If no speeds fit the position reached.
pub(super) fn pull_in(evaluator: &mut Evaluator<'_>, t: f64, state: &mut State) -> Result<(), AssemblyError> {
    let (n, m) = (evaluator.sizes().speeds, evaluator.sizes().rows);
    let held: Vec<bool> = evaluator.description().coordinates.iter().map(|c| c.held).collect();
    let fixed = frozen_speeds(evaluator);
    let mut loops = Orthogonal::new(m, n);
    let mut now = scaled_offsets(evaluator, t, state);
    let mut journals = Orthogonal::new(now.len(), n);
    for _ in 0..MAX_ITERATIONS {
        let mut jacobian = evaluator.closure(t, &state.q, &state.v).jacobian.to_vec();
        clear(&mut jacobian, &fixed);
        loops.factor(&jacobian, m, n, TOLERANCE);
        let free: Vec<Vec<f64>> = (0..n - loops.rank())
            .map(|index| {
                let mut direction = vec![0.0; n];
                loops.null_direction(index, &mut direction);
                direction
            })
            .collect();
        let mut columns = scaled_columns(evaluator, t, state);
        columns.iter_mut().for_each(|row| clear(row, &fixed));
        let matrix: Vec<f64> =
            columns.iter().flat_map(|row| free.iter().map(|direction| dot(row, direction))).collect();
        journals.factor(&matrix, now.len(), free.len(), TOLERANCE);
        let inward: Vec<f64> = now.iter().map(|offset| -offset).collect();
        let mut amounts = vec![0.0; free.len()];
        journals.solve(&inward, &mut amounts);
        let mut step = vec![0.0; n];
        free.iter().zip(&amounts).for_each(|(direction, amount)| add_scaled(&mut step, *amount, direction));
        let before = dot(&now, &now);
        let mut part = 1.0;
        let nearer = (0..HALVINGS).find_map(|_| {
            let moved: Vec<f64> = step.iter().map(|x| part * x).collect();
            part *= 0.5;
            let mut q = state.q.clone();
            evaluator.layout().advance(&mut q, &moved);
            evaluator.layout().normalize(&mut q);
            let q = Newton::new(evaluator, t, &q, &state.v, &held).run().ok()?;
            let trial = State { q, v: state.v.clone() };
            let offsets = scaled_offsets(evaluator, t, &trial);
            (dot(&offsets, &offsets) <= (1.0 - NO_BETTER) * before).then_some((trial, offsets))
        });
        let Some(better) = nearer else { break };
        (*state, now) = better;
    }
    state.v = speeds::consistent(evaluator, t, &state.q, &state.v)?;
    Ok(())
}

fn clear(rows: &mut [f64], fixed: &[bool]) {
    for row in rows.chunks_exact_mut(fixed.len().max(1)) {
        row.iter_mut().zip(fixed).filter(|(_, fixed)| **fixed).for_each(|(x, _)| *x = 0.0);
    }
}

/// Offsets of all journals in radial clearances.
fn scaled_offsets(evaluator: &mut Evaluator<'_>, t: f64, state: &State) -> Vec<f64> {
    evaluator.evaluate_contacts(t, &state.q, &state.v);
    let contacts = evaluator.clearances().contacts();
    let scaled = |(joint, axis): (usize, usize)| contacts[joint].offset[axis] / contacts[joint].clearance;
    offset_places(evaluator, |_| true).into_iter().map(scaled).collect()
}

/// How they move with every free speed.
fn scaled_columns(evaluator: &mut Evaluator<'_>, t: f64, state: &State) -> Vec<Vec<f64>> {
    let columns = offset_columns(evaluator, t, &state.q);
    evaluator.evaluate_contacts(t, &state.q, &state.v);
    let contacts = evaluator.clearances().contacts();
    let scaled = |(joint, axis): (usize, usize)| {
        columns[joint][axis].iter().map(|x| x / contacts[joint].clearance).collect()
    };
    offset_places(evaluator, |_| true).into_iter().map(scaled).collect()
}
