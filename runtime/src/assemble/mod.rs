//! A consistent start: coordinates that close every loop, speeds that keep them closed.
//! In: a mechanism, parameters, a time. Out: [`State`], or an [`AssemblyError`] that names what is in the
//! way. Never integrates. May allocate: it runs once.
//!
//! Positions by Gauss-Newton with minimum-norm steps from the guess, so that the position reached is near
//! it and the branch is the guess's; speeds by one minimum-norm solve from the wish.

mod newton;
mod resting;
mod speeds;

pub use resting::{assemble_resting, check_clearances, offset_columns, place};

use crate::{AssemblyError, Description, Evaluator, Motion, System, VariableInfo};
use newton::Newton;

/// Coordinates and speeds of the free motions.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct State {
    /// Free coordinates.
    pub q: Vec<f64>,
    /// Free speeds.
    pub v: Vec<f64>,
}

/// A loop open by more than this [m, rad] after assembly is an error.
pub const ASSEMBLED: f64 = 1e-10;

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

fn close(
    evaluator: &mut Evaluator<'_>,
    t: f64,
    guess: &[f64],
    wish: &[f64],
) -> Result<Vec<f64>, AssemblyError> {
    let held: Vec<bool> = evaluator.description().coordinates.iter().map(|c| c.held).collect();
    let failure = match Newton::new(evaluator, t, guess, wish, &held).run() {
        Ok(q) => return Ok(q),
        Err(failure) => failure,
    };
    if held.contains(&true)
        && let Ok(free) = Newton::new(evaluator, t, guess, wish, &vec![false; held.len()]).run()
    {
        let names = conflicts(evaluator, &held, guess, &free);
        let AssemblyError::NoConvergence { residual_m, residual_rad, .. } = failure else {
            return Err(failure);
        };
        if !names.is_empty() {
            return Err(AssemblyError::HeldPositions { names, residual_m, residual_rad });
        }
    }
    Err(failure)
}

/// Held coordinates that moved when nothing was held, with where they went.
fn conflicts(evaluator: &Evaluator<'_>, held: &[bool], wanted: &[f64], reached: &[f64]) -> Vec<String> {
    evaluator
        .description()
        .coordinates
        .iter()
        .enumerate()
        // Far above the accuracy of assembly, far below what a user would call different.
        .filter(|(i, _)| held[*i] && (wanted[*i] - reached[*i]).abs() > 1e-8)
        .map(|(i, c)| wanted_and_reached(c, wanted[i], reached[i]))
        .collect()
}

/// A variable with both of its values, for a message: rounded to a millionth.
fn wanted_and_reached(variable: &VariableInfo, wanted: f64, reached: f64) -> String {
    // Adding 0 turns -0 into 0.
    let rounded = |value: f64| (value * 1e6).round() / 1e6 + 0.0;
    format!("`{}` ({} {}, reachable {})", variable.name, rounded(wanted), variable.unit, rounded(reached))
}

/// Columns of the Jacobian that held coordinates freeze, and for held positions of poses (in W) the rows
/// that do so: (index of the coordinate, first speed of the group, component).
fn frozen(evaluator: &Evaluator<'_>, held: &[bool]) -> (Vec<bool>, Vec<(usize, usize, usize)>) {
    let mut columns = vec![false; evaluator.layout().speeds];
    let mut rows = Vec::new();
    for group in evaluator.layout().free() {
        let at = group.coordinate;
        match group.motion {
            Motion::Scalar { .. } => columns[group.speed] = held[at],
            Motion::Rotation | Motion::Pose => {
                if held[at..at + 4].contains(&true) {
                    columns[group.speed..group.speed + 3].fill(true);
                }
            }
        }
        if group.motion == Motion::Pose {
            rows.extend((0..3).filter(|i| held[at + 4 + i]).map(|i| (at, group.speed, i)));
        }
    }
    (columns, rows)
}
