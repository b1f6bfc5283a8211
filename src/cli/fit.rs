//! `fit`: a process of wear from a table of readings.

mod across_groups;
mod analysis;
mod field;
mod lambda;
mod read;
mod report;

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::Write as _;
use std::ops::Range;
use std::path::Path;

use crate::csv_table::CsvTable;
use crate::files::write_whole;
use crate::number::number;
#[cfg(feature = "page")]
use crate::page::fit_picture;
use crate::provenance::{Provenance, sealed};
use linkwear_gamma::data::{DataError, Gauge, Observations, Reading};
use linkwear_gamma::fit::{
    Bootstrap, Fit, FitError, LikelihoodRatio, bootstrap, estimate, hidden_scatter, likelihood_ratio,
};
use serde_json::json;

use self::across_groups::{GoesOn, Pooled, goes_on, pooled};
use self::analysis::{Analysis, LEVEL, model, rounding};
use self::read::{Group, groups};
use super::answer::Answer;
use super::arguments::FitArguments;
use super::failure::Failure;
use super::input::check_output;
#[cfg(feature = "page")]
use super::picture;

pub fn run(arguments: &FitArguments) -> Result<Answer, Failure> {
    let lambda = arguments.lambda.as_deref().filter(|_| arguments.exposure.is_some());
    let read: Vec<&Path> =
        [&*arguments.file].into_iter().chain(lambda.map(|text| lambda::named(text).1)).collect();
    check_output(&read, arguments.out.as_deref(), arguments.replace)?;
    #[cfg(feature = "page")]
    picture::check_plot_beside(
        arguments.out.as_deref(),
        &read,
        arguments.plot.as_deref(),
        arguments.replace,
    )?;
    let Fitted { answer, file } = fitted(arguments, &CsvTable::read(&arguments.file)?, None)?;
    if let Some(out) = &arguments.out {
        write_whole(out, |out| out.write_all(file.as_bytes()))?;
    }
    Ok(answer)
}

/// A fit, and the file that `predict` goes by.
pub struct Fitted {
    pub answer: Answer,
    pub file: String,
}

/// Replicates of the bootstrap, of all readings (`all`) and of each group.
pub type Replicates = BTreeMap<String, Bootstrap>;

/// Fewest replicates: of fewer not one lies beyond each end of an interval of 95 %.
const FEWEST_REPLICATES: usize = 40;

/// The name of the fit of all readings.
const ALL: &str = "all";

/// The fit of a table, with replicates that were drawn elsewhere or are drawn here; its picture, if one is asked for, is written.
pub fn fitted(
    arguments: &FitArguments,
    table: &CsvTable<'_>,
    drawn: Option<&Replicates>,
) -> Result<Fitted, Failure> {
    let (pooled, groups) = observed(arguments, table)?;
    let analysis = |Observed { name, data, last, .. }: &Observed| {
        let here = |fit: &Fit| bootstrap(fit, data, 0..arguments.bootstrap as u64, arguments.seed);
        let replicates = |fit: &Fit| match drawn {
            _ if arguments.bootstrap == 0 => None,
            Some(drawn) => drawn.get(name.as_str()).cloned(),
            None => Some(here(fit)),
        };
        Analysis::new(arguments, name, (data, last), replicates)
            .map_err(|error| no_fit(arguments, (name, data), error))
    };
    let parts = groups.iter().map(analysis).collect::<Result<Vec<_>, _>>()?;
    let all = Analysis {
        comments_like_rows: table.comments_like_rows(),
        shared: pooled.shared.clone(),
        ..analysis(&pooled)?
    };
    let test = ratio(&all, &parts);
    #[cfg(feature = "page")]
    picture::write_plot(arguments.plot.as_deref(), || fit_picture(&all.fit, &all.goodness, &pooled.data))?;
    let provenance = provenance(arguments, table);
    let file = format!("{:#}\n", sealed(all.file.to_json(), Some(&provenance)));
    Ok(Fitted { answer: report::answer(arguments, &all, &parts, test, &provenance), file })
}

/// Some of the replicates, by their numbers.
pub fn replicates(
    arguments: &FitArguments,
    table: &CsvTable<'_>,
    numbers: Range<u64>,
) -> Result<Replicates, Failure> {
    let (pooled, groups) = observed(arguments, table)?;
    let drawn = std::iter::once(pooled).chain(groups).map(|Observed { name, data, .. }| {
        let fit =
            estimate(&data, &model(arguments)).map_err(|error| no_fit(arguments, (&name, &data), error))?;
        Ok((name, bootstrap(&fit, &data, numbers.clone(), arguments.seed)))
    });
    drawn.collect()
}

/// Readings of a group, or of all.
struct Observed {
    name: String,
    data: Observations,
    /// Wear of each unit now; NaN where it is not known.
    last: Vec<f64>,
    /// Names of units in several groups.
    shared: Vec<String>,
}

impl Observed {
    fn new(arguments: &FitArguments, name: &str, readings: &[Reading]) -> Result<Self, Failure> {
        let (data, last) = observe(arguments, readings)?;
        Ok(Self { name: name.to_owned(), data, last, shared: Vec::new() })
    }
}

/// What is observed: of all units, and of each group that is asked for.
fn observed(arguments: &FitArguments, table: &CsvTable<'_>) -> Result<(Observed, Vec<Observed>), Failure> {
    if (1..FEWEST_REPLICATES).contains(&arguments.bootstrap) {
        return Err(few_replicates(arguments.bootstrap));
    }
    let groups = groups(arguments, table)?;
    // (0, 0) before its readings in the second group would count its wear in the first once more.
    if arguments.from_zero
        && let Some(unit) = goes_on(&groups)
    {
        return Err(not_from_zero(arguments, &unit));
    }
    let Pooled { readings: all, shared } = pooled(&groups);
    // All faults of growth at once, not group by group.
    let pooled = Observed { shared, ..Observed::new(arguments, ALL, &all)? };
    if pooled.data.units.len() == 1 && !arguments.one_unit {
        return Err(one_unit(arguments, &all));
    }
    let mut parts = Vec::new();
    if arguments.groups.is_some() {
        for Group { name, readings } in &groups {
            parts.push(Observed::new(arguments, name, readings)?);
        }
    }
    Ok((pooled, parts))
}

/// What a fit is of.
fn provenance(arguments: &FitArguments, table: &CsvTable<'_>) -> Provenance {
    let mut options = json!({
        "unit": arguments.unit, "wear": arguments.wear, "exposure": arguments.exposure, "lambda": arguments.lambda,
        "process": arguments.process.name(), "power_law": arguments.power_law, "groups": arguments.groups,
        "from_zero": arguments.from_zero, "resolution": arguments.resolution, "gauge": arguments.gauge,
        "covariates": arguments.covariate, "one_unit": arguments.one_unit, "bootstrap": arguments.bootstrap,
    });
    // Keys of options that are not given are left out: files of fits without them stay as they are.
    let given = [
        ("random_effects", arguments.random_effects.then(|| true.into())),
        (
            "covariates_of_size",
            (!arguments.covariate_of_size.is_empty()).then(|| json!(arguments.covariate_of_size)),
        ),
        ("reset", arguments.reset.as_ref().map(|column| json!(column))),
        ("entered_below", arguments.entered_below.as_ref().map(|limit| json!(limit))),
    ];
    for (key, value) in given {
        if let Some(value) = value {
            options[key] = value;
        }
    }
    Provenance::new(table.sha256().to_owned(), Some(arguments.seed), options)
}

/// Groups with parameters of their own against one process for all.
fn ratio(pooled: &Analysis, parts: &[Analysis]) -> Option<LikelihoodRatio> {
    let apart: f64 = parts.iter().map(|part| part.fit.log_likelihood).sum();
    let degrees = parts.len().checked_sub(1)? * pooled.fit.model.parameters();
    (degrees > 0).then(|| likelihood_ratio(apart, pooled.fit.log_likelihood, degrees))
}

/// Increments, enough of them.
fn observe(arguments: &FitArguments, readings: &[Reading]) -> Result<(Observations, Vec<f64>), Failure> {
    let gauge = match rounding(arguments) {
        Some(rounding) => Gauge::Resolution(rounding),
        None if arguments.process.is_increasing() => Gauge::Exact,
        None => Gauge::Noisy,
    };
    let data = Observations::with_wear(readings, arguments.from_zero, gauge);
    let (data, last) = data.map_err(|error| refused(arguments, &error))?;
    let increments = data.increments.iter().filter(|one| one.is_growth()).count();
    let parameters = model(arguments).parameters();
    if increments <= parameters {
        let row = readings.last().map_or(0, |reading| reading.row);
        return Err(refused(arguments, &DataError::TooFew { row, increments, parameters }));
    }
    if arguments.bootstrap > 0 && data.has_bounds() {
        let message =
            "readings with bounds of wear cannot be drawn again: which of them would be bounds is not known";
        return Err(Failure::data(&arguments.file, None, message, "leave --bootstrap out"));
    }
    Ok((data, last))
}

fn few_replicates(asked: usize) -> Failure {
    let message =
        format!("--bootstrap: of {asked} replicate(s) none lies beyond each end of an interval of 95 %");
    Failure::usage(message, format!("give {FEWEST_REPLICATES} or more, or leave --bootstrap out"))
}

/// Wear of a unit in the group before is no wear from (0, 0) on.
fn not_from_zero(arguments: &FitArguments, GoesOn { unit, group, row }: &GoesOn) -> Failure {
    let message = format!(
        "row {row}: unit {unit} goes on in group {group}, where --from-zero would count all that it wore before once more"
    );
    let help = "leave --from-zero out and give (0, 0) as a row of the first group; if it is another unit, give it another name";
    Failure::data(&arguments.file, Some(*row), message, help)
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

fn no_fit(arguments: &FitArguments, (name, data): (&str, &Observations), error: FitError) -> Failure {
    // Options that do not go together, whatever the data are.
    if matches!(error, FitError::LargeError | FitError::NoResolution) {
        return Failure::usage(error, cure(error, 2));
    }
    let mut message =
        if arguments.groups.is_some() { format!("group {name}: {error}") } else { error.to_string() };
    // What such readings say all the same.
    let model = model(arguments);
    let least = (error == FitError::ScatterBelowGauge).then(|| hidden_scatter(data, &model, LEVEL)).flatten();
    if let Some([first, second]) = least {
        let [one, other] = model.process.parameters();
        let _ = write!(
            message,
            "; they say, at 95 %, that {one} is above {} and {other} above {}",
            number(first.low),
            number(second.low)
        );
    }
    let may_run_off = may_run_off(arguments);
    if error == FitError::NotConverged && !may_run_off.is_empty() {
        let _ = write!(message, ", perhaps {}", may_run_off.join(" or "));
    }
    Failure::data(&arguments.file, None, message, cure(error, model.parameters()))
}

/// Parameters beside the process's own, by the options that ask for them.
fn may_run_off(arguments: &FitArguments) -> Vec<&'static str> {
    let all = [
        (arguments.power_law, "the exponent (--power-law)"),
        (arguments.random_effects, "the variation between units (--random-effects)"),
        (arguments.covariates().next().is_some(), "the power of a covariate"),
    ];
    all.into_iter().filter(|(is_sought, _)| *is_sought).map(|(_, what)| what).collect()
}

/// In the words of the command line; by how many parameters are sought, a process has two.
fn cure(error: FitError, parameters: usize) -> &'static str {
    match error {
        FitError::OutOfRange => {
            "convert wear and exposure to units in which their numbers are neither huge nor tiny"
        }
        FitError::NotConverged if parameters <= 2 => "look at the data; try another --process",
        FitError::NotTold => {
            "leave --power-law out where all readings lie in a narrow span of exposure, and all but one of the covariates that go together"
        }
        FitError::NoScatter => {
            "no process is needed for wear that follows a line; if the gauge rounds, give its step by --resolution"
        }
        FitError::NoGrowth => {
            "check the column and the sign of wear: the Wiener process lets it fall at times, but fits growth on average alone"
        }
        FitError::ScatterBelowGauge => {
            "read a finer gauge, or at longer intervals; no process is needed for wear that follows a line"
        }
        FitError::BadResolution => "correct --resolution and --gauge",
        FitError::LargeError => "give a --resolution of a tenth of --gauge: a finer one is lost in the error",
        FitError::TooManyWindows { .. } => "fit fewer units, or every tenth reading of each",
        FitError::RoundedBounds => "leave --resolution out, or the bounds and --entered-below",
        FitError::NoBridge => "fit the Gamma or the Wiener process, or leave those readings out",
        FitError::ManyBounds => "leave --random-effects out, or fit another process",
        FitError::SizesWithinUnit => "leave --random-effects out, or fit the Gamma process",
        FitError::TooFewExact { .. } => "add readings that are no bounds",
        FitError::OneUnit => "add readings of other units, or leave --random-effects out",
        FitError::NoRandomEffect => "leave --random-effects out",
        FitError::NoResolution => "leave --process or --resolution out",
        _ => "look at the data; estimate fewer parameters",
    }
}

/// A fault of the data, in the words of the command line.
fn refused(arguments: &FitArguments, error: &DataError) -> Failure {
    let mut message = error.to_string();
    if let DataError::ConstantCovariate { index, value } = error {
        message = format!(
            "covariate `{}` is the same in all rows ({value})",
            arguments.covariates().nth(index - 1).map_or("", String::as_str)
        );
    }
    Failure::data(&arguments.file, error.row(), message, error.cure())
}
