//! Sensitivities of residuals to places of parameters, by differences of runs. In: a problem, a place. Out: columns, and how well they
//! are known. Never knows what they are for.
//!
//! A run is known up to the errors of its integrator, and one with contacts that chatter is rough: steps must be long beside that and
//! short beside the curvature. Differences over two steps tell both, by how much they differ.

use nalgebra::{DMatrix, DVector};

use super::errors::ModelFault;
use super::problem::Problem;

/// Steps, as parts of the bounds: the first two where they agree, else the pair that agrees best.
const STEPS: [f64; 4] = [1e-3, 1e-4, 1e-2, 3e-2];
/// Two differences that agree to this part of themselves need no others.
const AGREE: f64 = 1e-3;

/// How each parameter is varied.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Steps {
    /// Its step, as a part of its bounds.
    pub length: Vec<f64>,
    /// How far differences over two steps were apart, as a part of them; 1 and more: they are noise.
    pub doubt: Vec<f64>,
    /// Whether a step changed anything at all.
    pub moves: Vec<bool>,
}

/// Steps that suit the problem near some places with these residuals.
pub(super) fn steps(problem: &Problem<'_>, places: &[f64], base: &DVector<f64>) -> Result<Steps, ModelFault> {
    let mut steps = Steps { length: Vec::new(), doubt: Vec::new(), moves: Vec::new() };
    for at in 0..places.len() {
        let (length, doubt, moves) = step(problem, places, base, at)?;
        steps.length.push(length);
        steps.doubt.push(doubt);
        steps.moves.push(moves);
    }
    Ok(steps)
}

fn step(
    problem: &Problem<'_>,
    places: &[f64],
    base: &DVector<f64>,
    at: usize,
) -> Result<(f64, f64, bool), ModelFault> {
    let difference = |length| column(problem, places, base, (at, length));
    let apart = |a: &DVector<f64>, b: &DVector<f64>| {
        let size = a.norm().max(b.norm());
        if size > 0.0 { (a - b).norm() / size } else { 0.0 }
    };
    let (long, short) = (difference(STEPS[0])?, difference(STEPS[1])?);
    let doubt = apart(&long, &short);
    if doubt <= AGREE && long.norm() > 0.0 {
        return Ok((STEPS[0], doubt, true));
    }
    // Towards longer steps noise falls and curvature grows: the longer one of the pair that agrees best.
    let mut best = (STEPS[0], doubt);
    let mut moves = long.norm() > 0.0 || short.norm() > 0.0;
    let mut last = long;
    for length in &STEPS[2..] {
        let longer = difference(*length)?;
        moves |= longer.norm() > 0.0;
        let doubt = apart(&longer, &last);
        if doubt < best.1 {
            best = (*length, doubt);
        }
        last = longer;
    }
    Ok((best.0, best.1, moves))
}

/// Change of the residuals with the place of one parameter: central, one-sided at a bound and where the model runs on one side alone.
fn column(
    problem: &Problem<'_>,
    places: &[f64],
    base: &DVector<f64>,
    (at, length): (usize, f64),
) -> Result<DVector<f64>, ModelFault> {
    let moved = |length: f64| {
        let mut places = places.to_vec();
        places[at] += length;
        if !(0.0..=1.0).contains(&places[at]) {
            return Ok(None);
        }
        match problem.residuals(&places) {
            Ok(residuals) => Ok(Some((residuals, places[at]))),
            Err(ModelFault::Failed(_)) => Ok(None),
            Err(ModelFault::Interrupted) => Err(ModelFault::Interrupted),
        }
    };
    match (moved(length)?, moved(-length)?) {
        (Some((up, to)), Some((down, from))) => Ok((up - down) / (to - from)),
        (Some((one, to)), None) | (None, Some((one, to))) => Ok((one - base) / (to - places[at])),
        (None, None) => Ok(DVector::zeros(base.len())),
    }
}

/// All columns.
pub(super) fn jacobian(
    problem: &Problem<'_>,
    places: &[f64],
    base: &DVector<f64>,
    (lengths, fixed): (&[f64], Option<usize>),
) -> Result<DMatrix<f64>, ModelFault> {
    let mut jacobian = DMatrix::zeros(base.len(), places.len());
    for (at, length) in lengths.iter().enumerate().filter(|(at, _)| fixed != Some(*at)) {
        jacobian.set_column(at, &column(problem, places, base, (at, *length))?);
    }
    Ok(jacobian)
}
