//! The whole of it: starts, searches, noise, errors. In: free parameters, readings, a model. Out: [`Identified`]. Never knows what the
//! model is.

use std::cell::Cell;
use std::f64::consts::PI;

use linkwear_runtime::Watch;
use sobol_burley::sample;

use super::differences::{Steps, steps};
use super::errors::{IdentifyError, ModelFault};
use super::free::Free;
use super::inference::{Inference, infer};
use super::problem::{Model, Problem};
use super::readings::Readings;
use super::residuals::{Whiteness, probability};
use super::result::{GroupFit, Identified, Minimum, State};
use super::search::{Found, minimise};

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
/// Minima nearer than this part of the bounds are one.
const SAME: f64 = 0.01;

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

/// Minima that differ in parameters that are not identified alone, and fit alike, are one valley.
fn one_valley(problem: &Problem<'_>, minima: Vec<Minimum>, inference: &Inference) -> Vec<Minimum> {
    /// A hundredth of the noise's variance.
    const ALIKE: f64 = 0.01;
    let degrees = problem.readings.len().saturating_sub(problem.free.len()).max(1) as f64;
    let mut all: Vec<Minimum> = Vec::new();
    for one in minima {
        let is_same = |known: &Minimum| {
            let known_alike = (one.over_best - known.over_best).abs() * degrees <= ALIKE;
            let identified = inference.parameters.iter().enumerate();
            let mut identified = identified.filter(|(_, found)| found.state == State::Estimated);
            let same = |(at, found): (usize, &super::result::Estimated)| {
                let place = |values: &[f64]| found.free.place(values[at]);
                (place(&one.values) - place(&known.values)).abs() <= SAME
            };
            known_alike && identified.all(same)
        };
        match all.iter_mut().find(|known| is_same(known)) {
            Some(known) => known.searches += one.searches,
            None => all.push(one),
        }
    }
    all
}

fn told(
    problem: &Problem<'_>,
    best: Found,
    (inference, white, minima): (Inference, Vec<Whiteness>, Vec<Minimum>),
) -> Identified {
    let Inference { parameters, correlations, directions, combinations, misfit } = inference;
    let mut groups = Vec::new();
    let mut log_likelihood = 0.0;
    let parts = problem.readings.groups().iter().zip(problem.readings.ranges());
    for (((group, range), noise), whiteness) in parts.zip(&problem.noise).zip(white) {
        let residuals = &best.residuals.as_slice()[range];
        let count = residuals.len() as f64;
        let squares: f64 = residuals.iter().map(|r| r * r).sum::<f64>() * noise * noise;
        // Noise that is estimated enters by the value that makes the likelihood largest.
        let likely = if group.noise.is_some() { *noise } else { libm::sqrt(squares / count) };
        log_likelihood -=
            count * libm::log(likely * libm::sqrt(2.0 * PI)) + 0.5 * squares / (likely * likely);
        groups.push(GroupFit {
            name: group.name.clone(),
            unit: group.unit.clone(),
            clock: group.clock.clone(),
            at: group.at.clone(),
            measured: group.values.clone(),
            predicted: group.values.iter().zip(residuals).map(|(value, r)| value + r * noise).collect(),
            noise: *noise,
            noise_is_given: group.noise.is_some(),
            rms: libm::sqrt(squares / count),
            whiteness,
        });
    }
    let sought = problem.free.len() + groups.iter().filter(|group| !group.noise_is_given).count();
    let mut identified = Identified {
        parameters,
        correlations,
        directions,
        combinations,
        groups,
        misfit,
        minima,
        degrees: problem.degrees(),
        log_likelihood,
        aic: 2.0 * (sought as f64 - log_likelihood),
        converged: best.converged,
        runs: problem.runs.get(),
        warnings: Vec::new(),
    };
    identified.warnings = warnings(&identified);
    identified
}

/// What is doubtful.
fn warnings(found: &Identified) -> Vec<String> {
    /// Sensitivities that are known worse than this make errors wrong that people would see.
    const ROUGH: f64 = 0.1;
    let mut all = Vec::new();
    for one in &found.parameters {
        let name = &one.free.name;
        let bound = match one.state {
            State::AtLower => Some(("lower", one.free.lower)),
            State::AtUpper => Some(("upper", one.free.upper)),
            _ => None,
        };
        if let Some((which, value)) = bound {
            let value = one.free.written(value);
            all.push(format!(
                "{name} lies at its {which} bound, {value}, which is no estimate: widen the bounds; errors of the others take it as given"
            ));
        }
        if one.state == State::NotIdentified {
            all.push(format!("{name} is not identified: the readings say no more than its bounds do"));
        }
        if one.state == State::Estimated && one.doubt > ROUGH {
            all.push(format!(
                "the readings change roughly with {name} (sensitivities of two steps differ by {:.0} %): its error is as uncertain",
                100.0 * one.doubt
            ));
        }
    }
    for group in &found.groups {
        let Some(p) = group.whiteness.p.filter(|_| group.whiteness.is_doubtful()) else { continue };
        all.push(format!(
            "residuals of {} hang together (Ljung-Box p {}): the model lacks something; errors count {:.1} readings as one, \
             and cover no error of the model",
            group.name,
            probability(p),
            group.whiteness.per_independent
        ));
    }
    if let Some(misfit) = found.misfit.filter(|misfit| misfit.is_doubtful()) {
        all.push(format!(
            "the noise that is given does not explain the residuals (chi-squared {:.1} of {} degrees of freedom, p {}): errors are \
             enlarged by {:.2}",
            misfit.chi_squared,
            misfit.degrees,
            probability(misfit.p),
            (misfit.chi_squared / misfit.degrees as f64).sqrt()
        ));
    }
    if !found.converged {
        all.push("the best search did not come to rest: errors are of a place beside the minimum".to_owned());
    }
    let readings: usize = found.groups.iter().map(|group| group.at.len()).sum();
    let degrees = (readings - found.parameters.len()).max(1) as f64;
    // As far apart as the ends of a 95 % interval are from its middle, or less.
    let rivals = found.minima.iter().skip(1).filter(|one| (one.over_best - 1.0) * degrees < 3.84).count();
    if rivals > 0 {
        all.push(format!(
            "{} nearly as well: the data cannot choose; narrow the bounds by what you know",
            if rivals == 1 {
                "another minimum fits".to_owned()
            } else {
                format!("{rivals} other minima fit")
            }
        ));
    }
    all
}
