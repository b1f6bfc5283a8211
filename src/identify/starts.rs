//! The whole of it: starts, searches, noise, errors. In: free parameters, readings, a model. Out: [`Identified`]. Never knows what the
//! model is.

use std::cell::Cell;

use linkwear_runtime::Watch;
use sobol_burley::sample;

use super::differences::{Steps, steps};
use super::errors::{IdentifyError, ModelFault};
use super::free::Free;
use super::inference::infer;
use super::problem::{Model, Problem};
use super::readings::Readings;
use super::residuals::Whiteness;
use super::result::{Identified, Minimum};
use super::search::{Found, minimise};
use super::told::{SAME, one_valley, told};

/// How it is sought.
#[derive(Clone, Debug, PartialEq)]
pub struct IdentifySettings {
    /// Searches, each from another place: the best of four times as many places that are looked at.
    pub starts: u32,
    /// Seed of the places.
    pub seed: u32,
    /// Whether intervals are those of the likelihood where it is no parabola.
    pub profiles: bool,
    /// Values that one search begins from, if they lie within the bounds.
    pub begin: Option<Vec<f64>>,
}

impl Default for IdentifySettings {
    /// Four searches, seed 1, profiles.
    fn default() -> Self {
        Self { starts: 4, seed: 1, profiles: true, begin: None }
    }
}

/// Places looked at for each search.
const LOOKS: u32 = 4;
/// Rounds in which noise and parameters follow each other.
const ROUNDS: usize = 20;
/// Noise that changes by less has come to rest: it makes errors of errors ten times smaller than their own.
const STEADY: f64 = 1e-3;

/// Seeks the values that come nearest to the readings.
///
/// # Errors
/// [`IdentifyError`].
pub fn identify(
    free: &[Free],
    readings: &Readings,
    model: &dyn Model,
    settings: &IdentifySettings,
    watch: Watch<'_>,
) -> Result<Identified, IdentifyError> {
    check(free, readings)?;
    let runs = Cell::new(0);
    let mut problem = Problem { free, readings, model, noise: Vec::new(), watch, runs };
    problem.noise = problem.first_noise();
    watch.begin("search");
    let mut first_fault = None;
    let mut places = looks(&problem, settings, &mut first_fault).map_err(|_| stopped(&problem))?;
    if places.is_empty() {
        let starts = (LOOKS * settings.starts.max(1)) as usize;
        return Err(match first_fault {
            Some(first) => IdentifyError::NothingRuns { starts, first },
            None => stopped(&problem),
        });
    }
    places.truncate(settings.starts.max(1) as usize);
    let best = &places[0];
    let interrupted = |problem: &Problem<'_>| {
        let runs = problem.runs.get();
        move |_: ModelFault| IdentifyError::Interrupted(runs)
    };
    let mut how = steps(&problem, best, &problem.residuals(best).map_err(interrupted(&problem))?)
        .map_err(interrupted(&problem))?;
    if let Some(at) = how.moves.iter().position(|moves| !moves) {
        return Err(IdentifyError::NoInfluence(free[at].name.clone()));
    }
    let mut ends: Vec<Found> = Vec::new();
    for start in places {
        match minimise(&problem, start, (&how.length, None)) {
            Ok(found) => ends.push(found),
            Err(ModelFault::Failed(_)) => {}
            Err(ModelFault::Interrupted) => return Err(stopped(&problem)),
        }
    }
    ends.sort_by(|a, b| a.squares().total_cmp(&b.squares()));
    let minima = minima(&problem, &ends).map_err(interrupted(&problem))?;
    let Some(best) = ends.into_iter().next() else { return Err(stopped(&problem)) };
    let best = settle(&mut problem, best, &mut how).map_err(interrupted(&problem))?;
    watch.begin("errors");
    let white: Vec<Whiteness> = problem
        .readings
        .ranges()
        .into_iter()
        .map(|range| Whiteness::of(&best.residuals.as_slice()[range]))
        .collect();
    let inference =
        infer(&problem, &best, (&how, &white, settings.profiles)).map_err(interrupted(&problem))?;
    let minima = one_valley(&problem, minima, &inference);
    Ok(told(&problem, best, (inference, white, minima)))
}

fn stopped(problem: &Problem<'_>) -> IdentifyError {
    IdentifyError::Interrupted(problem.runs.get())
}

fn check(free: &[Free], readings: &Readings) -> Result<(), IdentifyError> {
    if free.is_empty() {
        return Err(IdentifyError::NothingFree);
    }
    let twice = free.iter().enumerate().find(|(at, one)| free[..*at].iter().any(|two| two.name == one.name));
    if let Some((_, one)) = twice {
        return Err(IdentifyError::Twice(one.name.clone()));
    }
    // With given noise as many readings as parameters would do, but nothing would be left to judge them by.
    if readings.len() <= free.len() {
        return Err(IdentifyError::TooFew { readings: readings.len(), parameters: free.len() });
    }
    Ok(())
}

/// Places at which the model runs, the nearest to the readings first.
fn looks(
    problem: &Problem<'_>,
    settings: &IdentifySettings,
    first_fault: &mut Option<crate::study::PointError>,
) -> Result<Vec<Vec<f64>>, ModelFault> {
    let width = problem.free.len();
    let begin = settings.begin.iter().map(|values| {
        problem.free.iter().zip(values).map(|(free, value)| free.place(*value)).collect::<Vec<_>>()
    });
    let begin = begin.filter(|places| places.iter().all(|place| (0.0..=1.0).contains(place)));
    let middle = std::iter::once(vec![0.5; width]);
    let place = |index: u32| -> Vec<f64> {
        (0..width as u32).map(|dimension| f64::from(sample(index, dimension, settings.seed))).collect()
    };
    let spread = (0..LOOKS * settings.starts.max(1)).map(place);
    let mut found: Vec<(f64, Vec<f64>)> = Vec::new();
    for places in begin.chain(middle).chain(spread) {
        match problem.residuals(&places) {
            Ok(residuals) => found.push((residuals.norm_squared(), places)),
            Err(ModelFault::Interrupted) => return Err(ModelFault::Interrupted),
            Err(ModelFault::Failed(fault)) => {
                first_fault.get_or_insert(fault);
            }
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    Ok(found.into_iter().map(|(_, places)| places).collect())
}

/// Noise by the residuals, then parameters by the noise, until both stay.
fn settle(problem: &mut Problem<'_>, mut best: Found, how: &mut Steps) -> Result<Found, ModelFault> {
    for _ in 0..ROUNDS {
        let noise = problem.shown_noise(&best);
        let is_steady = noise.iter().zip(&problem.noise).all(|(a, b)| (a / b - 1.0).abs() <= STEADY);
        problem.noise = noise;
        best.residuals = problem.residuals(&best.places)?;
        if is_steady {
            break;
        }
        // One group has one minimum, however large its noise.
        if problem.noise.len() > 1 {
            best = minimise(problem, best.places, (&how.length, None))?;
        }
    }
    *how = steps(problem, &best.places, &best.residuals)?;
    // From there once more, by the steps that suit the place.
    minimise(problem, best.places, (&how.length, None))
}

/// What searches came to, each minimum once: those between which the way leads up.
fn minima(problem: &Problem<'_>, ends: &[Found]) -> Result<Vec<Minimum>, ModelFault> {
    let mut all: Vec<(&Found, usize)> = Vec::new();
    'ends: for found in ends {
        for (known, count) in &mut all {
            let apart = known.places.iter().zip(&found.places).map(|(a, b)| (a - b).abs());
            let higher = known.squares().max(found.squares());
            if apart.fold(0.0, f64::max) > SAME {
                let middle: Vec<f64> =
                    known.places.iter().zip(&found.places).map(|(a, b)| 0.5 * (a + b)).collect();
                match problem.residuals(&middle) {
                    Err(ModelFault::Interrupted) => return Err(ModelFault::Interrupted),
                    Ok(residuals) if residuals.norm_squared() <= higher => {}
                    _ => continue,
                }
            }
            *count += 1;
            continue 'ends;
        }
        all.push((found, 1));
    }
    let least = all.first().map_or(0.0, |(best, _)| best.squares());
    let minimum = |(found, searches): &(&Found, usize)| Minimum {
        values: problem.values(&found.places),
        over_best: if least > 0.0 { found.squares() / least } else { 1.0 },
        searches: *searches,
    };
    Ok(all.iter().map(minimum).collect())
}
