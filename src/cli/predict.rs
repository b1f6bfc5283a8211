//! `predict`: remaining life from a fit, and from inspections of the one joint.

use std::fmt::Write as _;

use crate::checksum::sha256_of;
use crate::csv_table::CsvTable;
use crate::number::number;
use crate::provenance::Provenance;
use linkwear_gamma::inspection::{Effort, History, InspectionError, Prior, Reading};
use linkwear_gamma::life::{Band, Estimate, LifeError, Method, OperatingState, SeenUnit};
use linkwear_gamma::{FitFile, Prediction};

use serde_json::json;

use super::answer::Answer;
use super::answer::predict::PredictAnswer;
use super::arguments::PredictArguments;
use super::failure::Failure;
use super::input::{covariates, read_fit};
use super::table::table;

/// Every how many-th time is shown to people.
const STRIDE: usize = 5;

pub fn run(arguments: &PredictArguments) -> Result<Answer, Failure> {
    answer(arguments, &read_fit(&arguments.fit)?)
}

/// The prediction by a fit.
pub fn answer(arguments: &PredictArguments, fit: &FitFile) -> Result<Answer, Failure> {
    // Inspections update the fit's own law; without them, and where units differ, the answer asks for more.
    let estimate = match arguments.inspections {
        Some(_) if !fit.units_differ() => fit.estimate(&arguments.covariate),
        _ => fit.informed(&arguments.covariate),
    };
    let estimate = estimate.map_err(Failure::fit(&arguments.fit))?;
    let Asked { estimate, state, about, warning } = asked_for(arguments, fit, estimate)?;
    let inspections = arguments.inspections.as_deref().map(CsvTable::read).transpose()?;
    let inspections = inspections.as_ref();
    let mut answer = predict(arguments, estimate, &state, inspections)?;
    answer.from.push_str(&about);
    for (at, (name, value)) in arguments.covariate.iter().enumerate() {
        let join = if at == 0 { " at" } else { "," };
        let _ = write!(answer.from, "{join} {name} = {value}");
    }
    answer.warnings.splice(0..0, fit.warning().into_iter().chain(warning).map(str::to_owned));
    let mut options = json!({
        "threshold": arguments.threshold, "current": arguments.current, "at": arguments.at,
        "covariates": covariates(&arguments.covariate),
        "rate": arguments.rate, "gauge": arguments.gauge, "flat_prior": arguments.flat_prior,
        "particles": arguments.gauge.map(|_| arguments.particles), "draws": arguments.draws,
        "inspections_sha256": inspections.map(CsvTable::sha256),
    });
    if let Some(unit) = &arguments.unit {
        options["unit"] = unit.as_str().into();
    }
    let provenance = Provenance::new(sha256_of(fit.text().as_bytes()), Some(arguments.seed), options);
    Ok(Answer::new(to_text(&answer), PredictAnswer::from(&answer), Some(&provenance)))
}

/// Which unit is asked for, and where it stands.
struct Asked {
    estimate: Estimate,
    state: OperatingState,
    /// For people, after what the answer rests on.
    about: String,
    warning: Option<&'static str>,
}

fn asked_for(arguments: &PredictArguments, fit: &FitFile, estimate: Estimate) -> Result<Asked, Failure> {
    let differ = estimate.units_differ();
    if let Some(name) = &arguments.unit {
        let (seen, current, at) = now(arguments, fit, name)?;
        let estimate = if differ { estimate.of_unit(seen) } else { estimate };
        let state = state(arguments, &estimate, Some(current), Some(at))?;
        return Ok(Asked { estimate, state, about: format!(", unit {name} by its readings"), warning: None });
    }
    let state = state(arguments, &estimate, arguments.current, arguments.at)?;
    if !differ || arguments.inspections.is_some() {
        return Ok(Asked { estimate, state, about: String::new(), warning: None });
    }
    match (arguments.current.filter(|current| *current != 0.0), arguments.at.filter(|at| *at > 0.0)) {
        (Some(wear), Some(at)) => {
            let estimate = estimate.of_unit(SeenUnit { spans: vec![[0.0, at]], wear });
            let about = ", a unit that has worn so far until now".to_owned();
            Ok(Asked { estimate, state, about, warning: None })
        }
        (Some(_), None) => {
            let warning = "units differ, and by which exposure this one has worn so far is not said: it is taken as any unit; add --at";
            Ok(Asked { estimate, state, about: ", any unit".to_owned(), warning: Some(warning) })
        }
        _ => Ok(Asked { estimate, state, about: ", any unit".to_owned(), warning: None }),
    }
}

/// A unit of the fit: what has been read of it, its wear and its exposure now.
fn now(arguments: &PredictArguments, fit: &FitFile, name: &str) -> Result<(SeenUnit, f64, f64), Failure> {
    let (mut seen, wear, exposure) = fit.unit(name).map_err(Failure::fit(&arguments.fit))?;
    let refused = |message: String, help: &str| Err(Failure::data(&arguments.fit, None, message, help));
    let (current, at) = match (arguments.current, arguments.at) {
        (None, None) => return Ok((seen, wear, exposure)),
        (Some(current), Some(at)) => (current, at),
        _ => {
            let message =
                format!("of unit {name} either wear or exposure is given, and its last reading has both");
            return refused(message, "give --current and --at, or none");
        }
    };
    let falls = current <= wear && fit.process.is_increasing();
    if at <= exposure || falls || !current.is_finite() {
        let message = format!(
            "unit {name} was last read with wear {wear} at {exposure}: wear {current} at {at} does not go on from there"
        );
        return refused(message, "give a later --at with more --current, or none of them");
    }
    seen.spans.push([exposure, at]);
    seen.wear += current - wear;
    Ok((seen, current, at))
}

fn state(
    arguments: &PredictArguments,
    estimate: &Estimate,
    current: Option<f64>,
    at: Option<f64>,
) -> Result<OperatingState, Failure> {
    OperatingState::of(estimate, arguments.threshold, arguments.rate, (current, at))
        .map_err(|error| asked(arguments, &error))
}

fn predict(
    arguments: &PredictArguments,
    estimate: Estimate,
    state: &OperatingState,
    inspections: Option<&CsvTable<'_>>,
) -> Result<Prediction, Failure> {
    let (Some(file), Some(table)) = (&arguments.inspections, inspections) else {
        let draws = |count| Method::Draws { count: count as usize, seed: arguments.seed };
        let method = arguments.draws.map_or(Method::Delta, draws);
        return Prediction::by_fit(&estimate, state, method).map_err(|error| asked(arguments, &error));
    };
    // clap asks for both with --inspections.
    let (time, wear) = (arguments.time.as_deref(), arguments.wear.as_deref());
    let times = table.numbers(time.unwrap_or_default())?.into_iter();
    let readings =
        times.zip(table.numbers(wear.unwrap_or_default())?).map(|(time, wear)| Reading { time, wear });
    let readings: Vec<Reading> = readings.collect();
    let refused = |error: InspectionError| {
        Failure::data(file, error.row().and_then(|row| table.lines().nth(row - 1)), error, "")
    };
    if let Some(gauge) = arguments.gauge {
        let history = History::noisy(readings).map_err(refused)?;
        let effort = Effort { count: arguments.particles as usize, seed: arguments.seed };
        return Prediction::after_gauge(&history, &estimate, state, gauge, effort).map_err(refused);
    }
    let history = History::exact(estimate.process(), readings).map_err(refused)?;
    let prior = if arguments.flat_prior {
        Prior::Flat { process: estimate.process(), power_law: estimate.exponent().is_some() }
    } else {
        Prior::Fit(estimate)
    };
    Prediction::after(&history, &prior, state).map_err(refused)
}

/// A question that has no answer: the numbers on the command line are to blame.
fn asked(arguments: &PredictArguments, error: &LifeError) -> Failure {
    Failure::data(&arguments.fit, None, error, "see `linkwear predict --help` for what the options mean")
}

fn to_text(answer: &Prediction) -> String {
    let mut text = format!(
        "remaining life from wear {} to {}, by {}\n\n",
        number(answer.current),
        number(answer.threshold),
        answer.from
    );
    let mut rows = Vec::new();
    let bands = answer.quantiles.iter().chain(answer.moments.iter().map(|(_, band)| band));
    for (name, Band { value, lower, upper }) in ["B10", "B50", "B90", "mean"].into_iter().zip(bands) {
        let numbers = [value, lower, upper].map(|number| format!("{number:.6}"));
        rows.push([name.to_owned()].into_iter().chain(numbers).collect());
    }
    text.push_str(&table(&["", "time", "lower 95 %", "upper 95 %"], &rows));
    let (lower, upper) = answer.interval;
    let _ = writeln!(
        text,
        "\n95 % of lives end between {lower:.6} and {upper:.6} ({})",
        answer.interval_kind.words()
    );
    if let (Some((moments, _)), Some(whole)) = (&answer.moments, &answer.whole) {
        let _ = writeln!(
            text,
            "standard deviation {:.6}, coefficient of variation {:.5}; in whole units of time: mean {:.4}",
            moments.std,
            moments.cov(),
            whole.mean
        );
    }
    let course: Vec<Vec<String>> = answer
        .course
        .iter()
        .step_by(STRIDE)
        .map(|(t, band, hazard)| {
            let share = |value: f64| format!("{value:.5}");
            vec![number(*t), share(band.value), share(band.lower), share(band.upper), number(*hazard)]
        })
        .collect();
    text.push('\n');
    text.push_str(&table(&["time", "reliability", "lower 95 %", "upper 95 %", "hazard"], &course));
    if let Some(budget) = &answer.budget {
        let _ = writeln!(text, "\nerror budget of the mean, half-widths at 95 %\n{budget}");
    }
    for warning in &answer.warnings {
        let _ = writeln!(text, "\nwarning: {warning}");
    }
    text
}
