//! Closed loops first, then speeds that keep them closed. In: a mechanism's start values. Out: a [`State`].

use super::half_turns::as_drawn;
use super::held::conflicts;
use super::newton::Newton;
use super::offset::free_offsets;
use super::speeds;
use super::state::State;
use crate::description::Description;
use crate::error::AssemblyError;
use crate::evaluate::Evaluator;
use crate::system::System;

/// Finds a consistent state at time `t` [s] near the mechanism's own start values.
///
/// # Errors
/// If the loops cannot be closed, demanded start values contradict them, or numbers are not finite.
pub fn assemble(
    system: &dyn System<f64>,
    description: &Description,
    parameters: &[f64],
    t: f64,
) -> Result<State, AssemblyError> {
    assemble_with(&mut Evaluator::new(system, description, parameters)?, t)
}

/// As [`assemble`], with an evaluator at hand.
///
/// # Errors
/// As [`assemble`].
pub fn assemble_with(evaluator: &mut Evaluator<'_>, t: f64) -> Result<State, AssemblyError> {
    let (guess, wish) = evaluator.start(t);
    let (mut guess, wish) = (guess.to_vec(), wish.to_vec());
    let description = evaluator.description();
    for (values, names) in [(&guess, &description.coordinates), (&wish, &description.speeds)] {
        if let Some(i) = values.iter().position(|x| !x.is_finite()) {
            return Err(AssemblyError::NonFinite { what: format!("start value of {}", names[i].name) });
        }
    }
    evaluator.layout().normalize(&mut guess);
    let q = close(evaluator, t, &guess, &wish)?;
    let v = speeds::consistent(evaluator, t, &q, &wish)?;
    Ok(State { q, v })
}

/// The closed position that Newton finds at time `t` [s] from a guess of the free coordinates, with journals in the middle of their
/// bearings; `held` ones stay.
///
/// # Errors
/// If the loops cannot be closed from there.
pub fn close_loops(
    evaluator: &mut Evaluator<'_>,
    t: f64,
    guess: &[f64],
    held: &[bool],
) -> Result<Vec<f64>, AssemblyError> {
    let still = vec![0.0; evaluator.sizes().speeds];
    let offsets = free_offsets(evaluator, t, guess);
    as_drawn(Newton::new(evaluator, t, guess, &still, held).centred(offsets))
}

fn close(
    evaluator: &mut Evaluator<'_>,
    t: f64,
    guess: &[f64],
    wish: &[f64],
) -> Result<Vec<f64>, AssemblyError> {
    let held: Vec<bool> = evaluator.description().coordinates.iter().map(|c| c.held).collect();
    let offsets = free_offsets(evaluator, t, guess);
    // As if there were no clearances: journals that may be anywhere on the way leave the loops to close themselves wherever it is
    // nearest, on another branch or turns away.
    if !offsets.is_empty()
        && let Ok(q) = as_drawn(Newton::new(evaluator, t, guess, wish, &held).centred(offsets))
    {
        return Ok(q);
    }
    let failure = match as_drawn(Newton::new(evaluator, t, guess, wish, &held)) {
        Ok(q) => return Ok(q),
        Err(failure) => failure,
    };
    if held.contains(&true)
        && let Ok(free) = as_drawn(Newton::new(evaluator, t, guess, wish, &vec![false; held.len()]))
    {
        // Far above the accuracy of assembly, far below what a user would call different.
        let names = conflicts(&evaluator.description().coordinates, guess, &free, |_| 1e-8);
        let AssemblyError::NoConvergence { residual_m, residual_rad, .. } = failure else {
            return Err(failure);
        };
        if !names.is_empty() {
            return Err(AssemblyError::HeldPositions { names, residual_m, residual_rad });
        }
    }
    Err(failure)
}
