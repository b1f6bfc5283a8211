//! A start for joints with clearance: each journal touches where the reaction of an ideal joint would press it.
//! In: a mechanism, a time. Out: a consistent [`State`], and memories of contacts that rest.
//!
//! The journals are first put into the middle of their bearings without moving there. The contact forces that leave
//! them no acceleration are the ideal reactions: accelerations are linear in the wrenches, so unit forces tell. Each
//! journal then goes against its force, by the clearance and the penetration of a resting contact. A joint whose
//! offset is demanded in the file stays where the file puts it.
//!
//! That is where a machine begins that was put together. One under way for long has journals that move with their loads,
//! held by friction where they slide (`sliding.rs`). Lives begin so: a journal that begins beside that place swings about
//! it, and nothing damps that.

use super::consistent::assemble_with;
use super::offset::free_contacts;
use super::placing::{carried, place, place_moving, pressed_along};
use super::reactions::{ideal_reactions, turning};
use super::sliding;
use super::state::State;
use super::within_clearance::{self, DEEPEST_START};
use crate::error::{AssemblyError, SetupError};
use crate::evaluate::Evaluator;

/// What journals do that rest in their bearings.
#[derive(Clone, Copy, PartialEq)]
enum Journals {
    /// Begin from standstill, without friction.
    Begin,
    /// Move with their loads, where friction holds them.
    MoveOn,
}

/// As [`assemble_with`]; where the mechanism has joints with clearance they touch as the file says, or rest on
/// the side to which the ideal reaction presses them. Where it does not close with centred journals they stay as
/// assembled, or as near to the middle as the loops let them. What contacts remember begins here.
///
/// # Errors
/// As [`assemble_with`]; [`SetupError::Clearance`] if a clearance is no clearance,
/// [`AssemblyError::OutsideClearance`] if the parts of a joint cannot be put together.
pub fn assemble_static_contact(evaluator: &mut Evaluator<'_>, t: f64) -> Result<State, AssemblyError> {
    assemble_resting(evaluator, t, Journals::Begin)
}

/// As [`assemble_static_contact`], of a machine that has been under way: journals that rest move with the loads that press them, and
/// where they slide friction holds them.
///
/// # Errors
/// As [`assemble_static_contact`].
pub(crate) fn assemble_under_way(evaluator: &mut Evaluator<'_>, t: f64) -> Result<State, AssemblyError> {
    assemble_resting(evaluator, t, Journals::MoveOn)
}

/// The state near one under way in which journals move with the loads that press them; nothing where they cannot. What contacts remember
/// begins there.
pub(crate) fn rest_under_way(evaluator: &mut Evaluator<'_>, t: f64, near: &State) -> Option<State> {
    let state = rest(evaluator, t, near, Journals::MoveOn).0?;
    evaluator.evaluate_contacts(t, &state.q, &state.v);
    evaluator.clearances_mut().begin();
    Some(state)
}

fn assemble_resting(
    evaluator: &mut Evaluator<'_>,
    t: f64,
    journals: Journals,
) -> Result<State, AssemblyError> {
    let mut state = assemble_with(evaluator, t)?;
    if evaluator.clearances().is_empty() {
        return Ok(state);
    }
    check_clearances(evaluator, t, &state)?;
    let (resting, placeable) = rest(evaluator, t, &state, journals);
    let rests = resting.is_some();
    state = resting.unwrap_or(state);
    if !rests && within_clearance::check(evaluator, t, &state, (&placeable, 0.0)).is_err() {
        // It may close thanks to its clearances alone.
        within_clearance::pull_in(evaluator, t, &mut state)?;
    }
    // Journals at rest are as deep as their load presses them.
    let asked: Vec<bool> = placeable.iter().map(|free| !(rests && *free)).collect();
    within_clearance::check(evaluator, t, &state, (&asked, DEEPEST_START))?;
    evaluator.evaluate_contacts(t, &state.q, &state.v);
    evaluator.clearances_mut().begin();
    Ok(state)
}

/// The state near a guess of coordinates and speeds at time `t` [s] in which the loops are closed and every journal rests
/// where the reaction of an ideal joint presses it; nothing, if the mechanism does not close with centred journals.
pub fn resting_contacts(evaluator: &mut Evaluator<'_>, t: f64, guess: &State) -> Option<State> {
    rest(evaluator, t, guess, Journals::Begin).0
}

/// The same, with the contacts whose journals are free to rest.
fn rest(
    evaluator: &mut Evaluator<'_>,
    t: f64,
    guess: &State,
    journals: Journals,
) -> (Option<State>, Vec<bool>) {
    let placeable = free_contacts(evaluator, t, &guess.q);
    let centred: Vec<Option<[f64; 3]>> = placeable.iter().map(|free| free.then_some([0.0; 3])).collect();
    let mut state = guess.clone();
    if !place(evaluator, t, &mut state, &centred) {
        return (None, placeable);
    }
    let ideal = state.clone();
    let forces = ideal_reactions(evaluator, t, &ideal, (&placeable, &vec![[0.0; 3]; placeable.len()]));
    let targets: Vec<_> = (0..placeable.len())
        .map(|index| placeable[index].then(|| resting_offset(evaluator, index, forces[index])))
        .collect();
    if journals == Journals::Begin {
        let rests = place(evaluator, t, &mut state, &targets);
        return (rests.then_some(state), placeable);
    }
    let turns = turning(evaluator, t, &ideal, (&placeable, &forces));
    let rests = place_moving(evaluator, t, &mut state, (&targets, &carried(&turns, &targets)));
    if rests {
        sliding::settle(evaluator, t, &mut state, (&placeable, &ideal, &turns));
    }
    (rests.then_some(state), placeable)
}

/// Whether every clearance is above zero and below the radius of its journal.
///
/// # Errors
/// [`SetupError::Clearance`] for the first that is not.
pub fn check_clearances(evaluator: &mut Evaluator<'_>, t: f64, state: &State) -> Result<(), SetupError> {
    evaluator.evaluate_contacts(t, &state.q, &state.v);
    let description = evaluator.description();
    let clearances = evaluator.clearances();
    for (index, touch) in clearances.contacts().iter().enumerate() {
        let journal_radius = clearances.joints()[index].journal_radius();
        let fits = touch.clearance > 0.0 && touch.clearance < journal_radius;
        if !fits {
            let joint = description.contacts[index].joint.to_string();
            return Err(SetupError::Clearance { joint, clearance: touch.clearance, journal_radius });
        }
    }
    Ok(())
}

/// Where a journal rests under an ideal reaction [N] on it.
fn resting_offset(evaluator: &Evaluator<'_>, index: usize, force: [f64; 3]) -> [f64; 3] {
    let [x, y, z] = force;
    let size = (x * x + y * y + z * z).sqrt();
    if size.is_nan() || size <= 0.0 {
        return [0.0; 3];
    }
    pressed_along(evaluator, index, force.map(|component| -component / size), size)
}
