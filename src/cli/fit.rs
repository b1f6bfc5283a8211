//! `fit`: a Gamma process of wear from a table of readings.

mod lambda;
mod read;
mod report;

use std::io::Write as _;

use linkwear_gamma::data::{DataError, Gauge, Observations, Reading};
use linkwear_gamma::fit::{
    Bootstrap, Estimate, Fit, FitError, Goodness, Interval, LikelihoodRatio, Model, Rival, bootstrap,
    estimate, goodness, inverse_gaussian, likelihood_ratio, profile_interval, wiener,
};

use self::read::{Group, fault, groups};
use super::arguments::{FitArguments, Format};
use super::failure::Failure;
use super::file::{print, refuse_same, write_whole};

/// Level of the intervals printed.
const LEVEL: f64 = 0.95;

/// One fit and what is known about it.
struct Analysis {
    name: String,
    fit: Fit,
    /// Names of the parameters, in the order of the covariance.
    parameters: Vec<String>,
    values: Vec<f64>,
    /// None where the likelihood does not fall far enough.
    intervals: Vec<Option<Interval>>,
    goodness: Goodness,
    bootstrap: Option<Bootstrap>,
    rivals: Vec<(&'static str, Result<Rival, FitError>)>,
    /// Bias of alpha and beta to first order in 1/n, where theory has it.
    bias: Option<[f64; 2]>,
}

/// Answers `fit`.
pub fn run(arguments: &FitArguments, format: Format) -> Result<(), Failure> {
    if let Some(out) = &arguments.out {
        refuse_same(&arguments.file, out)?;
    }
    let groups = groups(arguments)?;
    let all: Vec<Reading> = groups.iter().flat_map(|group| group.readings.clone()).collect();
    // All faults of growth at once, not group by group.
    let data = observe(arguments, &all)?;
    if data.units.len() == 1 && !arguments.one_unit {
        return Err(one_unit(arguments, &all));
    }
    let pooled = analyse(arguments, "all", &data)?;
    let mut parts = Vec::new();
    if arguments.groups.is_some() {
        for Group { name, readings } in &groups {
            parts.push(analyse(arguments, name, &observe(arguments, readings)?)?);
        }
    }
    let test = ratio(&pooled, &parts);
    if let Some(out) = &arguments.out {
        let text = report::fitted(arguments, &pooled.fit);
        write_whole(out, |file| writeln!(file, "{text:#}"))?;
    }
    match format {
        Format::Json => print(&report::machine(arguments, &pooled, &parts, test)),
        Format::Text => print(&report::human(arguments, &pooled, &parts, test)),
    }
}

/// Groups with parameters of their own against one process for all.
fn ratio(pooled: &Analysis, parts: &[Analysis]) -> Option<LikelihoodRatio> {
    let apart: f64 = parts.iter().map(|part| part.fit.log_likelihood).sum();
    let degrees = parts.len().checked_sub(1)? * pooled.parameters.len();
    (degrees > 0).then(|| likelihood_ratio(apart, pooled.fit.log_likelihood, degrees))
}

fn model(arguments: &FitArguments) -> Model {
    Model {
        power_law: arguments.power_law,
        covariates: arguments.covariate.len(),
        resolution: arguments.resolution,
    }
}

/// Increments, enough of them.
fn observe(arguments: &FitArguments, readings: &[Reading]) -> Result<Observations, Failure> {
    let gauge = arguments.resolution.map_or(Gauge::Exact, Gauge::Resolution);
    let data = Observations::new(readings, arguments.from_zero, gauge);
    let data = data.map_err(|error| refused(arguments, &error))?;
    let (increments, parameters) = (data.increments.len(), model(arguments).parameters());
    if increments <= parameters {
        let row = readings.last().map_or(0, |reading| reading.row);
        return Err(refused(arguments, &DataError::TooFew { row, increments, parameters }));
    }
    Ok(data)
}

/// One unit shows how its own wear scatters; the process is asked about others.
fn one_unit(arguments: &FitArguments, readings: &[Reading]) -> Failure {
    let row = |reading: Option<&Reading>| reading.map_or(0, |reading| reading.row);
    let (first, last) = (row(readings.first()), row(readings.last()));
    let unit = readings.first().map_or("", |reading| &reading.unit);
    let message = format!(
        "rows {first} to {last}: all readings are of one unit, {unit}: how units differ cannot be seen"
    );
    let help = "add readings of other units, or accept it with --one-unit";
    fault(&arguments.file, Some(first), message, help)
}

fn analyse(arguments: &FitArguments, name: &str, data: &Observations) -> Result<Analysis, Failure> {
    let found = estimate(data, &model(arguments)).map_err(|error| {
        let message =
            if arguments.groups.is_some() { format!("group {name}: {error}") } else { error.to_string() };
        fault(&arguments.file, None, message, "look at the data; estimate fewer parameters")
    })?;
    Ok(complete(arguments, name, data, &found))
}

fn complete(arguments: &FitArguments, name: &str, data: &Observations, found: &Estimate) -> Analysis {
    let clock = match (&arguments.lambda, &arguments.exposure) {
        (Some(lambda), Some(_)) => format!("Lambda of {lambda}"),
        (Some(clock), None) | (None, Some(clock)) => clock.clone(),
        (None, None) => String::new(),
    };
    let fit = found.fit(data, &arguments.covariate, &arguments.wear, &clock);
    let mut parameters = vec!["alpha".to_owned(), "beta".to_owned()];
    parameters.extend(arguments.power_law.then(|| "exponent".to_owned()));
    parameters.extend(arguments.covariate.iter().map(|covariate| format!("power of {covariate}")));
    let increments = &data.increments;
    let rivals = if arguments.compare {
        vec![
            ("Wiener", wiener(increments, &found.model)),
            ("inverse Gaussian", inverse_gaussian(increments, &found.model)),
        ]
    } else {
        Vec::new()
    };
    let replicates = arguments.bootstrap;
    Analysis {
        name: name.to_owned(),
        intervals: (0..parameters.len()).map(|at| profile_interval(found, data, at, LEVEL).ok()).collect(),
        parameters,
        values: found.parameters(),
        fit,
        goodness: goodness(found, increments, arguments.seed),
        bootstrap: (replicates > 0).then(|| bootstrap(found, data, replicates, arguments.seed)),
        rivals,
        bias: found.first_order_bias(data),
    }
}

/// A fault of the data, in the words of the command line.
fn refused(arguments: &FitArguments, error: &DataError) -> Failure {
    let mut message = error.to_string();
    if let DataError::ConstantCovariate { index, value } = error {
        message = format!("covariate `{}` is the same in all rows ({value})", arguments.covariate[index - 1]);
    }
    fault(&arguments.file, error.row(), message, error.cure())
}
