//! `predict`: remaining life from a fit, and from inspections of the one joint.

mod machine;
mod refused;
mod text;

use std::fmt::Write as _;

use crate::checksum::sha256_of;
use crate::csv_table::CsvTable;
#[cfg(feature = "page")]
use crate::page::prediction_picture;
use crate::provenance::Provenance;
use linkwear_gamma::inspection::{Effort, History, InspectionError, Prior, Reading};
use linkwear_gamma::life::{Estimate, Method, OperatingState, SeenUnit};
use linkwear_gamma::{FitFile, Member, Prediction, Questions};

use serde_json::{Value, json};

use super::answer::Answer;
use super::answer::predict::PredictAnswer;
use super::arguments::PredictArguments;
use super::failure::Failure;
use super::input::{covariates, read_fit};
#[cfg(feature = "page")]
use super::picture;
use refused::asked;
use text::to_text;

pub fn run(arguments: &PredictArguments) -> Result<Answer, Failure> {
    #[cfg(feature = "page")]
    picture::check_plot(&[&arguments.fit], arguments.plot.as_deref(), arguments.replace)?;
    answer(arguments, &read_fit(&arguments.fit)?)
}

/// The prediction by a fit.
pub fn answer(arguments: &PredictArguments, fit: &FitFile) -> Result<Answer, Failure> {
    let others = machine::others(arguments)?;
    let values = machine::known(arguments, fit, &others);
    // Inspections update the fit's own law; without them, and where units differ, the answer asks for more.
    let estimate = match arguments.inspections {
        Some(_) if !fit.units_differ() => fit.estimate(&values),
        _ => fit.informed(&values),
    };
    let estimate = estimate.map_err(Failure::fit(&arguments.fit))?;
    let Asked { estimate, state, about, warning } = asked_for(arguments, fit, estimate)?;
    let inspections = arguments.inspections.as_deref().map(CsvTable::read).transpose()?;
    let inspections = inspections.as_ref();
    let questions = questions(arguments);
    let joint = Member { estimate: estimate.clone(), state: state.clone() };
    let mut answer = predict(arguments, estimate, &state, (inspections, &questions))?;
    let machine = machine::machine(arguments, (joint, fit), &others, &questions)?;
    #[cfg(feature = "page")]
    picture::write_plot(arguments.plot.as_deref(), || prediction_picture(&answer))?;
    answer.from.push_str(&about);
    for (at, (name, value)) in arguments.covariate.iter().enumerate() {
        let join = if at == 0 { " at" } else { "," };
        let _ = write!(answer.from, "{join} {name} = {value}");
    }
    let of_fit = fit.warning().into_iter().chain(warning).map(str::to_owned);
    let far = match others.is_empty() {
        true => fit.far_covariates(&values),
        false => machine::far(&arguments.fit, fit, &values),
    };
    answer.warnings.splice(0..0, of_fit.chain(far));
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
    asked_options(arguments, machine.as_ref(), &mut options);
    let provenance = Provenance::new(sha256_of(fit.text().as_bytes()), Some(arguments.seed), options);
    let text = to_text(&answer, arguments.survived, machine.as_ref(), &arguments.calendar);
    let of_machine = machine.as_ref().map(|joints| (&joints.names[..], &joints.life));
    let told = PredictAnswer::new(&answer, of_machine, &arguments.calendar);
    Ok(Answer::new(text, told, Some(&provenance)))
}

/// What is asked beyond the usual.
fn questions(arguments: &PredictArguments) -> Questions {
    Questions {
        survived: arguments.survived,
        quantiles: arguments.quantile.clone(),
        times: arguments.reliability_at.clone(),
        missions: arguments.mission.clone(),
    }
}

/// Adds to what provenance tells what is asked beyond the usual, if it is.
fn asked_options(arguments: &PredictArguments, machine: Option<&machine::Joints>, options: &mut Value) {
    let mut add = |name: &str, is_asked: bool, value: Value| {
        if is_asked {
            options[name] = value;
        }
    };
    add("survived", arguments.survived > 0.0, json!(arguments.survived));
    add("quantiles", !arguments.quantile.is_empty(), json!(arguments.quantile));
    add("reliability_at", !arguments.reliability_at.is_empty(), json!(arguments.reliability_at));
    add("missions", !arguments.mission.is_empty(), json!(arguments.mission));
    add("catalogue", arguments.catalogue.is_some(), json!(arguments.catalogue));
    add("calendar", arguments.calendar.is_given(), arguments.calendar.options());
    if let Some(machine) = machine {
        add("also", true, machine.options());
    }
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
    if arguments.current.is_some() != arguments.at.is_some() {
        let message =
            format!("of unit {name} either wear or exposure is given, and its last reading has both");
        return Err(Failure::usage(message, "give --current and --at, or none"));
    }
    let (mut seen, wear, exposure) = fit.unit(name).map_err(Failure::fit(&arguments.fit))?;
    let Some((current, at)) = arguments.current.zip(arguments.at) else { return Ok((seen, wear, exposure)) };
    let falls = current <= wear && fit.process.is_increasing();
    if at <= exposure || falls {
        let message = format!(
            "unit {name} was last read with wear {wear} at {exposure}: wear {current} at {at} does not go on from there"
        );
        let help = "give a later --at with more --current, or none of them";
        return Err(Failure::data(&arguments.fit, None, message, help));
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
    (inspections, questions): (Option<&CsvTable<'_>>, &Questions),
) -> Result<Prediction, Failure> {
    let (Some(file), Some(table)) = (&arguments.inspections, inspections) else {
        let draws = |count| Method::Draws { count: count as usize, seed: arguments.seed };
        let method = arguments.draws.map_or(Method::Delta, draws);
        return Prediction::by_fit(&estimate, state, method, questions)
            .map_err(|error| asked(arguments, &error));
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
        return Prediction::after_gauge(&history, &estimate, state, gauge, effort, questions)
            .map_err(refused);
    }
    let history = History::exact(estimate.process(), readings).map_err(refused)?;
    let (process, power_law) = (estimate.process(), estimate.exponent().is_some());
    let prior = match arguments.catalogue {
        Some(_) if power_law => {
            let help = "give a fit without --power-law; a catalogue's wear per unit of exposure is for wear that grows with it";
            return Err(Failure::usage("--catalogue: exposure counts by a power in this fit", help));
        }
        Some(range) => Prior::catalogue(process, range).map_err(|error| asked(arguments, &error))?,
        None if arguments.flat_prior => Prior::Flat { process, power_law },
        None => Prior::Fit(estimate),
    };
    Prediction::after(&history, &prior, state, questions).map_err(refused)
}
