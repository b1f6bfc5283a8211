//! What a search found, put together: minima, groups beside their predictions, warnings. In: a problem at its minimum, errors. Out:
//! [`Identified`]. Never runs the model.

use std::f64::consts::PI;

use super::inference::Inference;
use super::problem::Problem;
use super::residuals::{Whiteness, probability};
use super::result::{Estimated, GroupFit, Identified, Minimum, State};
use super::search::Found;

/// Minima nearer than this part of the bounds are one.
pub(super) const SAME: f64 = 0.01;

/// Minima that differ in parameters that are not identified alone, and fit alike, are one valley.
pub(super) fn one_valley(problem: &Problem<'_>, minima: Vec<Minimum>, inference: &Inference) -> Vec<Minimum> {
    /// A hundredth of the noise's variance.
    const ALIKE: f64 = 0.01;
    let degrees = problem.readings.len().saturating_sub(problem.free.len()).max(1) as f64;
    let mut all: Vec<Minimum> = Vec::new();
    for one in minima {
        let is_same = |known: &Minimum| {
            let known_alike = (one.over_best - known.over_best).abs() * degrees <= ALIKE;
            let identified = inference.parameters.iter().enumerate();
            let mut identified = identified.filter(|(_, found)| found.state == State::Estimated);
            let same = |(at, found): (usize, &Estimated)| {
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

/// All of it, with what is doubtful.
pub(super) fn told(
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
    if let Some((misfit, times)) = found.misfit.and_then(|misfit| Some((misfit, misfit.too_large()?))) {
        let times = if times.is_finite() {
            format!("{times:.1} times as large as")
        } else {
            "larger than".to_owned()
        };
        all.push(format!(
            "the noise that is given is {times} residuals show (chi-squared {:.3} of {} degrees of freedom): errors and intervals are as much \
             too wide; look at its unit, or leave it out",
            misfit.chi_squared, misfit.degrees
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
