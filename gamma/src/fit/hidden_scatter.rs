//! Intervals of a process's parameters where a gauge nearly hides the scatter. In: rounded readings, a model. Out: the values that a
//! likelihood-ratio test does not reject. Never knows how they are printed.
//!
//! No scatter is the edge of the model. Where it lies within some six standard errors, twice the fall of the log-likelihood is far
//! from chi-square: in part of the samples the likelihood rises up to the edge, in others a few readings beside a line decide. Its
//! critical value is then simulated at the very parameters that are tested, the others at their best (the hybrid resampling of
//! C.-S. Chuang, T. L. Lai, Statistica Sinica 10 (2000) 1). Samples without a maximum have intervals like all others, without an
//! upper end: what the likelihood tends to at the edge stands for the maximum.

use super::drawn_falls::{DrawnFalls, EDGE};
use super::error::FitError;
use super::estimate::{Fit, follows};
use super::few_increments::bartlett;
use super::interval::{ACCURACY, Interval, profile_within};
use super::maximise::{maximise, start};
use super::model::Model;
use crate::data::{Increment, Observations};
use crate::special::{normal_quantile, rising_root_within};

/// Standard errors between the scatter and none, above which the edge is too far to count: at 7 of them chi-square holds the truth in 93 %
/// or more, at 5.5 in 92.6 to 93.8 (docs/remaining-life.md).
const FAR: f64 = 6.0;
/// Increments up to which critical values are simulated: of more, each takes seconds.
const MOST: usize = 100;
/// Data drawn for a critical value: at 95 % the tenth of them, so that the test has its level exactly.
const DRAWN: u64 = 199;

/// Turns of end and critical value, and where they end, in the logarithm of the parameter: 199 data tell an end to some percent.
const TURNS: usize = 4;
const CLOSE: f64 = 0.03;
/// Falls nearer than this are the same: equal readings in another order.
const TIE: f64 = 1e-6;

/// What the likelihood rises to.
struct Top {
    value: f64,
    phi: Vec<f64>,
    /// Whether it is a maximum.
    is_inside: bool,
}

/// An interval at `level` for parameter `index` of [`Fit::parameters`]: that of [`super::profile_interval`]; of few increments with
/// chi-square corrected, for the two parameters of the process with a critical value of its own where a gauge nearly hides the scatter.
///
/// # Errors
/// As [`super::profile_interval`].
pub fn interval(
    fit: &Fit,
    observations: &Observations,
    index: usize,
    level: f64,
) -> Result<Interval, FitError> {
    let near = |phi: &[f64]| index < 2 && is_near(&fit.model, phi, &observations.increments);
    if !near(&fit.phi) {
        let reach = libm::sqrt(chi_square(level) * bartlett(fit, observations, index));
        let found = profile_within(fit, observations, index, reach)?;
        // What is told of the edge: where the upper end of the shape lies.
        let mut least = fit.phi.clone();
        let by = libm::log(found.high.min(f64::MAX)) - least[index.min(1)];
        least.iter_mut().take(2).for_each(|log| *log += by);
        if index > 1 || !near(&least) {
            return Ok(found);
        }
    }
    let top = Top { value: fit.log_likelihood, phi: fit.phi.clone(), is_inside: true };
    ends(&fit.model, observations, &top, (index, level))
}

/// Intervals of the process's two parameters where the readings have no maximum because the gauge hides the scatter: without upper
/// ends. None where something else keeps them from one.
pub fn hidden_scatter(observations: &Observations, model: &Model, level: f64) -> Option<[Interval; 2]> {
    let increments = &observations.increments;
    let from = start(model, increments).ok().or_else(|| along_a_line(model, increments))?;
    if !is_near(model, &edge_of(model, increments, &from, EDGE[0]), increments) {
        return None;
    }
    follows(model, increments, &from).ok()?;
    let top = at_the_edge(model, increments, &from)?;
    let [first, second] = [0, 1].map(|index| ends(model, observations, &top, (index, level)).ok());
    Some([first?, second?])
}

/// Parameters by which all wear lies on a line from the start, for a model without more of them.
fn along_a_line(model: &Model, increments: &[Increment]) -> Option<Vec<f64>> {
    let growth = || increments.iter().filter(|one| one.is_growth());
    let wear: f64 = growth().map(|one| one.wear).sum();
    let phi = vec![0.0; 2];
    let lambda: f64 = growth().map(|one| model.lambda(&phi, one)).sum();
    (model.parameters() == 2 && wear > 0.0).then(|| vec![0.0, libm::log(lambda / wear)])
}

/// Whether the edge is near some parameters, and the data are few enough for critical values of their own. By a normal law with the
/// variance of an increment, s, and that of its reading beside it, v: ln(s + v) is known to sqrt(2 / n), and is ln v at the edge.
fn is_near(model: &Model, phi: &[f64], increments: &[Increment]) -> bool {
    let count = increments.iter().filter(|one| one.is_growth()).count();
    let Some(hidden) = model.hidden(phi, increments).filter(|_| !model.units_differ && count <= MOST) else {
        return false;
    };
    libm::sqrt(0.5 * count as f64) * libm::log1p(1.0 / hidden) < FAR
}

/// The same mean, with the logarithm of the variance over the least that is told from none at `scatter`.
fn edge_of(model: &Model, increments: &[Increment], phi: &[f64], scatter: f64) -> Vec<f64> {
    let mut phi = phi.to_vec();
    let by = model.ln_scatter(&phi, increments) - scatter;
    phi.iter_mut().take(2).for_each(|log| *log += by);
    phi
}

/// The largest likelihood near the edge.
fn at_the_edge(model: &Model, increments: &[Increment], from: &[f64]) -> Option<Top> {
    let tried = EDGE.iter().filter_map(|scatter| {
        let start = edge_of(model, increments, from, *scatter);
        maximise(model, increments, &start, Some(0)).ok()
    });
    let best = tried.max_by(|a, b| a.1.value.total_cmp(&b.1.value))?;
    Some(Top { value: best.1.value, phi: best.0, is_inside: false })
}

/// The maximum, or what the likelihood tends to at the edge.
#[cfg(test)]
fn top(model: &Model, increments: &[Increment], near: &[f64]) -> Option<Top> {
    match super::estimate::estimate_increments(increments, model, Some(near)) {
        Ok(Fit { log_likelihood, phi, .. }) => Some(Top { value: log_likelihood, phi, is_inside: true }),
        Err(FitError::ScatterBelowGauge | FitError::NotConverged) => at_the_edge(model, increments, near),
        Err(_) => None,
    }
}

/// Twice the fall of the log-likelihood at a value of a parameter, and the best of the others there.
fn fall(
    model: &Model,
    increments: &[Increment],
    top: &Top,
    (index, value): (usize, f64),
) -> Option<(f64, Vec<f64>)> {
    // Along the same mean, so that few steps are left.
    let mut from = top.phi.clone();
    let by = value - from[index];
    from.iter_mut().take(2).for_each(|log| *log += by);
    from[index] = value;
    let (phi, point) = maximise(model, increments, &from, Some(index)).ok()?;
    Some(((2.0 * (top.value - point.value)).max(0.0), phi))
}

/// Whether the interval at `level` of each of the process's two parameters holds that of `near`, and whether the readings have a maximum.
#[cfg(test)]
pub fn both_hold(
    model: &Model,
    observations: &Observations,
    near: &[f64],
    level: f64,
) -> Option<([bool; 2], bool)> {
    let top = top(model, &observations.increments, near)?;
    let [first, second] = [0, 1].map(|index| is_held(model, observations, &top, (index, near[index]), level));
    Some(([first?, second?], top.is_inside))
}

/// Whether the interval at `level` holds the parameter of `near`.
#[cfg(test)]
pub fn holds(
    model: &Model,
    observations: &Observations,
    near: &[f64],
    (index, level): (usize, f64),
) -> Option<bool> {
    let top = top(model, &observations.increments, near)?;
    is_held(model, observations, &top, (index, near[index]), level)
}

/// Whether a value is within the interval at `level`: whether enough of the data drawn there fall as far.
#[cfg(test)]
fn is_held(
    model: &Model,
    observations: &Observations,
    top: &Top,
    (index, value): (usize, f64),
    level: f64,
) -> Option<bool> {
    let increments = &observations.increments;
    let (own, phi) = fall(model, increments, top, (index, value))?;
    if !is_near(model, &phi, increments) {
        return Some(own <= chi_square(level));
    }
    let mut falls = DrawnFalls::new(model, phi, increments)?;
    let own = falls.fall(index, increments)?;
    let (mut drawn, mut beyond) = (0, 0.0);
    for number in 0..DRAWN {
        if let Some(fall) = falls.drawn(index, number) {
            drawn += 1;
            beyond += if (fall - own).abs() < TIE { 0.5 } else { f64::from(u8::from(fall > own)) };
        }
        if beyond > enough(level, DRAWN as usize) {
            return Some(true);
        }
    }
    Some(beyond > enough(level, drawn))
}

/// Of so many drawn data, how many must fall farther than the data at hand so that these are not odd at `level`; the data count among
/// them, and those that fall as far by half (H. O. Lancaster, J. Am. Stat. Assoc. 56 (1961) 223): a coarse gauge gives few different
/// data, and a tenth of them may be alike.
fn enough(level: f64, drawn: usize) -> f64 {
    (1.0 - level) * (drawn + 1) as f64 - 0.5 + 1e-9
}

fn chi_square(level: f64) -> f64 {
    let reach = normal_quantile(0.5 + 0.5 * level);
    reach * reach
}

/// The critical fall at parameters where one is held.
fn critical(
    model: &Model,
    observations: &Observations,
    phi: Vec<f64>,
    (index, level): (usize, f64),
) -> Result<f64, FitError> {
    if !is_near(model, &phi, &observations.increments) {
        return Ok(chi_square(level));
    }
    let mut drawn = DrawnFalls::new(model, phi, &observations.increments).ok_or(FitError::NoResolution)?;
    let mut falls: Vec<f64> = (0..DRAWN).filter_map(|number| drawn.drawn(index, number)).collect();
    falls.sort_by(|a, b| b.total_cmp(a));
    let enough = enough(level, falls.len());
    let mut beyond = 0.0;
    for alike in falls.chunk_by(|a, b| a - b < TIE) {
        let count = alike.len() as f64;
        if beyond + 0.5 * count > enough {
            return Ok(alike[0] + TIE);
        }
        beyond += count;
        if beyond > enough {
            return Ok(alike[0] - TIE);
        }
    }
    Err(FitError::NotConverged)
}

/// Both ends: each by the critical value that holds at it, found in turns.
fn ends(
    model: &Model,
    observations: &Observations,
    top: &Top,
    (index, level): (usize, f64),
) -> Result<Interval, FitError> {
    let increments = &observations.increments;
    let last = edge_of(model, increments, &top.phi, EDGE[0])[index];
    let at = |value: f64| fall(model, increments, top, (index, value));
    let from = top.phi[index];
    let end = |sign: f64| -> Result<f64, FitError> {
        let mut least = chi_square(level);
        let mut found = f64::NAN;
        for _ in 0..TURNS {
            // Beyond the edge nothing changes any more.
            let value = |by: f64| if sign > 0.0 { (from + by).min(last) } else { from - by };
            let below = |by: f64| at(value(by)).map_or(f64::INFINITY, |(fall, _)| fall) - least;
            let is_open = sign > 0.0 && (!top.is_inside || from >= last || below(last - from) <= 0.0);
            let (tested, end) = if is_open {
                (at(last.max(from)), f64::INFINITY)
            } else {
                let by = rising_root_within(&below, 0.5, ACCURACY);
                (at(value(by)), value(by))
            };
            let is_settled = end == found || (end - found).abs() < CLOSE;
            found = end;
            if is_settled {
                break;
            }
            let (_, phi) = tested.ok_or(FitError::NotConverged)?;
            let own = critical(model, observations, phi, (index, level))?;
            if own == least {
                break;
            }
            least = own;
        }
        Ok(found)
    };
    let [low, high] = [end(-1.0)?, end(1.0)?].map(|log| model.natural(index, log));
    Ok(Interval { low, high })
}
