//! Readings from a CSV file. In: path, names of columns. Out: typed readings with their lines, by group. Never knows
//! how they are fitted.

use std::collections::HashMap;
use std::path::Path;

use crate::csv_table::CsvTable;
use linkwear_gamma::data::Reading;

use super::super::arguments::FitArguments;
use super::super::failure::Failure;
use super::field::{limits, resets, wears};
use super::lambda::{LambdaTable, named};

/// Readings of one group; of all data when there are no groups.
pub struct Group {
    /// Value of the column of groups.
    pub name: String,
    /// Its readings, in the order of the file.
    pub readings: Vec<Reading>,
}

/// All readings, by group in order of first appearance.
pub fn groups(arguments: &FitArguments, table: &CsvTable<'_>) -> Result<Vec<Group>, Failure> {
    // Every column is looked at: a file's faults come together.
    let mut covariates = Ok(Vec::new());
    for name in arguments.covariates() {
        let both = Failure::both(covariates, table.numbers(name).map_err(Failure::from));
        covariates = both.map(|(mut all, one)| {
            all.push(one);
            all
        });
    }
    let names = arguments.groups.as_ref().map(|name| table.names(name)).transpose();
    let units =
        Failure::both(table.names(&arguments.unit).map_err(Failure::from), names.map_err(Failure::from));
    let marks = Failure::both(resets(arguments, table), limits(arguments, table));
    let numbers = Failure::both(wears(arguments, table), clock(arguments, table));
    let columns = Failure::both(Failure::both(units, numbers), Failure::both(covariates, marks));
    let (((units, names), (wears, exposures)), (covariates, (resets, limits))) = columns?;
    let names = names.unwrap_or_else(|| vec!["all".to_owned(); units.len()]);
    let mut groups: Vec<Group> = Vec::new();
    let mut places: HashMap<&str, usize> = HashMap::new();
    for (at, line) in table.lines().enumerate() {
        let (seen, wear) = wears[at];
        let reading = Reading {
            unit: units[at].clone(),
            exposure: exposures[at],
            wear,
            covariates: covariates.iter().map(|values| values[at]).collect(),
            row: line,
            seen,
            reset: resets[at],
            entered_below: limits[at],
        };
        let place = *places.entry(&names[at]).or_insert(groups.len());
        if place == groups.len() {
            groups.push(Group { name: names[at].clone(), readings: Vec::new() });
        }
        groups[place].readings.push(reading);
    }
    if groups.is_empty() {
        return Err(no_readings(&arguments.file, table));
    }
    Ok(groups)
}

fn no_readings(file: &Path, table: &CsvTable<'_>) -> Failure {
    let message = "there are no readings";
    let rows = table.comments_like_rows();
    if rows == 0 {
        return Failure::data(file, None, message, "the file has only a header");
    }
    let message = format!("{message}: {rows} line(s) that look like some begin with #, so they are comments");
    Failure::data(file, None, message, "put names that begin with # in quotes, or call the units otherwise")
}

/// Exposure, or Lambda where it is given.
fn clock(arguments: &FitArguments, table: &CsvTable<'_>) -> Result<Vec<f64>, Failure> {
    let exposures = arguments.exposure.as_ref().map(|name| table.numbers(name)).transpose()?;
    let Some(lambda) = &arguments.lambda else {
        return exposures.ok_or_else(|| Failure::usage("no clock", "give --exposure or --lambda"));
    };
    if table.has(lambda) {
        return Ok(table.numbers(lambda)?);
    }
    let (joint, path) = named(lambda);
    if !path.exists() {
        // As a column it is missing: says what there is.
        table.numbers(lambda)?;
    }
    let Some(exposures) = exposures else {
        let message = format!("`{lambda}` gives Lambda by exposure, but no column of exposure is named");
        let help = "add --exposure COL, in what the file counts in (cycles of `life`)";
        return Err(Failure::usage(message, help));
    };
    let by_exposure = LambdaTable::read(path, joint)?;
    let [begin, end] = by_exposure.range;
    if !by_exposure.begins_at_zero() && (arguments.from_zero || arguments.entered_below.is_some()) {
        let option = if arguments.from_zero { "--from-zero" } else { "--entered-below" };
        let message =
            format!("`{lambda}` begins at exposure {begin}, but {option} asks for Lambda of new parts");
        return Err(Failure::data(path, None, message, "begin the table with a row of exposure 0"));
    }
    let read = exposures.iter().zip(table.lines()).map(|(exposure, line)| {
        by_exposure.at(*exposure).ok_or_else(|| {
            let message =
                format!("line {line}: exposure {exposure} is outside of `{lambda}`, {begin} to {end}");
            let help = match *exposure < begin {
                true => "give the table a row at or before it, 0,0 if that is true, or drop the line",
                false => "run `life` further, give the table more rows, or drop the line",
            };
            Failure::data(&arguments.file, Some(line), message, help)
        })
    });
    read.collect()
}
