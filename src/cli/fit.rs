//! `fit`: a process of wear from a table of readings.

mod analysis;
mod lambda;
mod read;
mod report;

use std::io::Write as _;

use crate::csv_table::CsvTable;
use crate::files::write_whole;
#[cfg(feature = "page")]
use crate::page::fit_picture;
use crate::provenance::{Provenance, sealed};
use linkwear_gamma::data::{DataError, Gauge, Observations, Reading};
use linkwear_gamma::fit::{FitError, LikelihoodRatio, likelihood_ratio};
use serde_json::json;

use self::analysis::{Analysis, model, rounding};
use self::read::{Group, groups};
use super::answer::Answer;
use super::arguments::FitArguments;
use super::failure::Failure;
use super::input::check_output;
#[cfg(feature = "page")]
use super::picture;

pub fn run(arguments: &FitArguments) -> Result<Answer, Failure> {
    check_output(&arguments.file, arguments.out.as_deref())?;
    #[cfg(feature = "page")]
    picture::check_plot(&arguments.file, arguments.plot.as_deref())?;
    answer(arguments, &CsvTable::read(&arguments.file)?)
}

/// The fit of a table.
pub fn answer(arguments: &FitArguments, table: &CsvTable<'_>) -> Result<Answer, Failure> {
    let groups = groups(arguments, table)?;
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
    let provenance = provenance(arguments, table);
    if let Some(out) = &arguments.out {
        let text = sealed(pooled.file.to_json(), Some(&provenance));
        write_whole(out, |file| writeln!(file, "{text:#}"))?;
    }
    #[cfg(feature = "page")]
    picture::write_plot(arguments.plot.as_deref(), || fit_picture(&pooled.fit, &pooled.goodness, &data))?;
    Ok(report::answer(arguments, &pooled, &parts, test, &provenance))
}

/// What a fit is of.
fn provenance(arguments: &FitArguments, table: &CsvTable<'_>) -> Provenance {
    let options = json!({
        "unit": arguments.unit, "wear": arguments.wear, "exposure": arguments.exposure, "lambda": arguments.lambda,
        "process": arguments.process.name(), "power_law": arguments.power_law, "groups": arguments.groups,
        "from_zero": arguments.from_zero, "resolution": arguments.resolution, "gauge": arguments.gauge,
        "covariates": arguments.covariate, "one_unit": arguments.one_unit, "bootstrap": arguments.bootstrap,
    });
    Provenance::new(table.sha256().to_owned(), Some(arguments.seed), options)
}

/// Groups with parameters of their own against one process for all.
fn ratio(pooled: &Analysis, parts: &[Analysis]) -> Option<LikelihoodRatio> {
    let apart: f64 = parts.iter().map(|part| part.fit.log_likelihood).sum();
    let degrees = parts.len().checked_sub(1)? * pooled.fit.parameters().len();
    (degrees > 0).then(|| likelihood_ratio(apart, pooled.fit.log_likelihood, degrees))
}

/// Increments, enough of them.
fn observe(arguments: &FitArguments, readings: &[Reading]) -> Result<Observations, Failure> {
    let gauge = match rounding(arguments) {
        Some(rounding) => Gauge::Resolution(rounding),
        None if arguments.process.is_increasing() => Gauge::Exact,
        None => Gauge::Noisy,
    };
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
    Failure::data(&arguments.file, Some(first), message, help)
}

fn analyse(arguments: &FitArguments, name: &str, data: &Observations) -> Result<Analysis, Failure> {
    Analysis::new(arguments, name, data).map_err(|error| {
        let message =
            if arguments.groups.is_some() { format!("group {name}: {error}") } else { error.to_string() };
        Failure::data(&arguments.file, None, message, cure(error))
    })
}

/// In the words of the command line.
fn cure(error: FitError) -> &'static str {
    match error {
        FitError::NoScatter => {
            "no process is needed for wear that follows a line; if the gauge rounds, give its step by --resolution"
        }
        FitError::ScatterBelowGauge => {
            "read a finer gauge, or at longer intervals; no process is needed for wear that follows a line"
        }
        FitError::BadResolution => "correct --resolution and --gauge",
        FitError::LargeError => "give a --resolution of a tenth of --gauge: a finer one is lost in the error",
        FitError::TooManyWindows { .. } => "fit fewer units, or every tenth reading of each",
        FitError::NoResolution => "leave --process or --resolution out",
        _ => "look at the data; estimate fewer parameters",
    }
}

/// A fault of the data, in the words of the command line.
fn refused(arguments: &FitArguments, error: &DataError) -> Failure {
    let mut message = error.to_string();
    if let DataError::ConstantCovariate { index, value } = error {
        message = format!("covariate `{}` is the same in all rows ({value})", arguments.covariate[index - 1]);
    }
    Failure::data(&arguments.file, error.row(), message, error.cure())
}
