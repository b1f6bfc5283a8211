//! Ends of an interval by the profile of the likelihood: where the best fit with one parameter held is worse by so much. In: a
//! problem, its minimum. Out: places. Never knows errors by sensitivities but for where to begin.

use super::errors::ModelFault;
use super::problem::Problem;
use super::search::{Found, minimise};

/// Two roots that agree to this part of the way to the end are one.
const AGREE: f64 = 0.01;
/// A rise that is right up to this part of it is that of a parabola: an end is then right up to half of it.
const PARABOLIC: f64 = 0.1;
/// Tries for an end.
const MOST: usize = 12;

/// An end of an interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct End {
    /// Its place; none beyond the bounds.
    pub place: Option<f64>,
    /// Whether it is where a parabola has it.
    pub is_parabolic: bool,
}

/// Where the squares with the parameter `at` held have risen by `rise`, on the side of `by`, which is where a parabola has it.
pub(super) fn end(
    problem: &Problem<'_>,
    best: &Found,
    lengths: &[f64],
    (at, by, rise): (usize, f64, f64),
) -> Result<End, ModelFault> {
    let from = best.places[at];
    let open = End { place: None, is_parabolic: false };
    let bound = if by > from { 1.0 } else { 0.0 };
    let farthest = (bound - from).abs();
    let mut held = best.places.clone();
    let mut root_of_rise = |distance: f64| -> Result<Option<f64>, ModelFault> {
        let mut start = held.clone();
        start[at] = if distance >= farthest { bound } else { from + distance * (bound - from).signum() };
        match minimise(problem, start, (lengths, Some(at))) {
            Ok(found) => {
                let root = libm::sqrt((found.squares() - best.squares()).max(0.0));
                held = found.places;
                Ok(Some(root))
            }
            Err(ModelFault::Interrupted) => Err(ModelFault::Interrupted),
            Err(ModelFault::Failed(_)) => Ok(None),
        }
    };
    if farthest <= 0.0 {
        return Ok(open);
    }
    let wanted = libm::sqrt(rise);
    // The root of the rise is nearly a straight line through the minimum.
    let (mut inside, mut outside) = ((0.0, 0.0), None::<(f64, f64)>);
    let parabola = (by - from).abs();
    let mut distance = parabola.min(farthest);
    for attempt in 0..MOST {
        let Some(root) = root_of_rise(distance)? else {
            // It cannot be run there: nearer.
            outside = Some((distance, f64::INFINITY));
            distance = 0.5 * (inside.0 + distance);
            continue;
        };
        if attempt == 0
            && distance == parabola
            && (root / wanted).powi(2) <= 1.0 + PARABOLIC
            && (root / wanted).powi(2) >= 1.0 - PARABOLIC
        {
            return Ok(End { place: Some(by), is_parabolic: true });
        }
        if (root - wanted).abs() <= AGREE * wanted {
            break;
        }
        if root < wanted {
            if distance >= farthest {
                return Ok(open);
            }
            inside = (distance, root);
        } else {
            outside = Some((distance, root));
        }
        distance = match outside {
            None if inside.1 <= 0.0 => 2.0 * distance,
            None => inside.0 * (wanted / inside.1).min(3.0),
            Some((far, root)) if root.is_finite() => {
                let part = (wanted - inside.1) / (root - inside.1);
                inside.0 + part.clamp(0.05, 0.95) * (far - inside.0)
            }
            Some((far, _)) => 0.5 * (inside.0 + far),
        }
        .min(farthest);
    }
    Ok(End { place: Some(from + distance * (bound - from).signum()), is_parabolic: false })
}
