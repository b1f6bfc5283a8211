//! Readings from a CSV file. In: path, names of columns. Out: typed readings with their lines, by group. Never knows
//! how they are fitted.

use std::fs;
use std::path::Path;

use csv::{ReaderBuilder, StringRecord, Trim};
use linkwear_codegen::diagnostic::nearest;
use linkwear_gamma::data::Reading;

use super::super::arguments::FitArguments;
use super::super::failure::Failure;
use super::lambda::{LambdaTable, lambda_table};

/// Readings of one group; of all data when there are no groups.
pub struct Group {
    /// Value of the column of groups.
    pub name: String,
    /// Its readings, in the order of the file.
    pub readings: Vec<Reading>,
}

/// A fault of the data file.
pub fn fault(file: &Path, line: Option<usize>, message: String, help: &str) -> Failure {
    Failure::Data { file: file.to_path_buf(), line, message, help: help.to_owned() }
}

/// A CSV file in memory.
pub struct Table<'a> {
    file: &'a Path,
    header: Vec<String>,
    /// Line and cells.
    rows: Vec<(usize, StringRecord)>,
}

impl<'a> Table<'a> {
    /// Reads the file; its first line without # is the header.
    pub fn read(file: &'a Path) -> Result<Self, Failure> {
        let text = fs::read_to_string(file).map_err(|error| Failure::Read(file.to_path_buf(), error))?;
        let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
        let mut reader =
            ReaderBuilder::new().comment(Some(b'#')).trim(Trim::All).from_reader(text.as_bytes());
        let broken = |error: csv::Error| {
            let line = error.position().and_then(|position| usize::try_from(position.line()).ok());
            fault(
                file,
                line,
                format!("this is no CSV table: {error}"),
                "each line needs as many cells as the header",
            )
        };
        let header = reader.headers().map_err(broken)?.iter().map(str::to_owned).collect();
        let mut rows = Vec::new();
        for record in reader.records() {
            let record = record.map_err(broken)?;
            let line = record.position().map_or(0, |position| usize::try_from(position.line()).unwrap_or(0));
            rows.push((line, record));
        }
        Ok(Self { file, header, rows })
    }

    /// Whether there is a column of this name.
    pub fn has(&self, name: &str) -> bool {
        self.header.iter().any(|column| column == name)
    }

    /// Index of a column.
    pub fn column(&self, name: &str) -> Result<usize, Failure> {
        let mut found = self.header.iter().enumerate().filter(|(_, column)| *column == name);
        match (found.next(), found.next()) {
            (Some((at, _)), None) => Ok(at),
            (Some(_), Some(_)) => Err(fault(
                self.file,
                Some(1),
                format!("column `{name}` is there twice"),
                "rename one of them",
            )),
            _ => {
                let near = nearest(name, self.header.iter().map(String::as_str));
                let help = near.map_or_else(
                    || format!("the columns are: {}", self.header.join(", ")),
                    |column| format!("did you mean `{column}`?"),
                );
                Err(fault(self.file, Some(1), format!("there is no column `{name}`"), &help))
            }
        }
    }

    /// The numbers of a column, by row.
    pub fn numbers(&self, column: usize) -> Result<Vec<f64>, Failure> {
        let number = |(line, record): &(usize, StringRecord)| {
            let cell = &record[column];
            let value = cell.parse::<f64>().ok().filter(|value| value.is_finite());
            value.ok_or_else(|| self.no_number(*line, column, cell))
        };
        self.rows.iter().map(number).collect()
    }

    fn no_number(&self, line: usize, column: usize, cell: &str) -> Failure {
        let name = &self.header[column];
        let unit = cell.trim_start_matches(|c: char| c.is_ascii_digit() || "+-.eE ".contains(c));
        if !unit.is_empty() && unit.len() < cell.len() {
            let message = format!("line {line}: `{name}` is `{cell}`, a number with a unit");
            let help =
                format!("one unit per column: convert all rows, and put it into the header, `{name}_{unit}`");
            return fault(self.file, Some(line), message, &help);
        }
        let message = match cell {
            "" => format!("line {line}: `{name}` is empty"),
            _ => format!("line {line}: `{name}` is `{cell}`, not a finite number"),
        };
        fault(self.file, Some(line), message, "write a number, or delete the line")
    }

    /// The cells of a column.
    fn texts(&self, column: usize) -> Vec<String> {
        self.rows.iter().map(|(_, record)| record[column].to_owned()).collect()
    }
}

/// All readings, by group in order of first appearance.
pub fn groups(arguments: &FitArguments) -> Result<Vec<Group>, Failure> {
    let table = Table::read(&arguments.file)?;
    let units = table.texts(table.column(&arguments.unit)?);
    let wears = table.numbers(table.column(&arguments.wear)?)?;
    let exposures = clock(arguments, &table)?;
    let covariates = arguments.covariate.iter().map(|name| table.numbers(table.column(name)?));
    let covariates = covariates.collect::<Result<Vec<_>, _>>()?;
    let names = match &arguments.groups {
        Some(name) => table.texts(table.column(name)?),
        None => vec!["all".to_owned(); units.len()],
    };
    let mut groups: Vec<Group> = Vec::new();
    for (at, (line, _)) in table.rows.iter().enumerate() {
        let reading = Reading {
            unit: units[at].clone(),
            exposure: exposures[at],
            wear: wears[at],
            covariates: covariates.iter().map(|values| values[at]).collect(),
            row: *line,
        };
        match groups.iter_mut().find(|group| group.name == names[at]) {
            Some(group) => group.readings.push(reading),
            None => groups.push(Group { name: names[at].clone(), readings: vec![reading] }),
        }
    }
    if groups.is_empty() {
        return Err(fault(
            &arguments.file,
            None,
            "there are no readings".to_owned(),
            "the file has only a header",
        ));
    }
    Ok(groups)
}

/// Exposure, or Lambda where it is given.
fn clock(arguments: &FitArguments, table: &Table<'_>) -> Result<Vec<f64>, Failure> {
    let exposures = match &arguments.exposure {
        Some(name) => Some(table.numbers(table.column(name)?)?),
        None => None,
    };
    let Some(lambda) = &arguments.lambda else {
        return Ok(exposures.expect("clap asks for one of the two"));
    };
    if table.has(lambda) {
        return table.numbers(table.column(lambda)?);
    }
    let path = Path::new(lambda);
    if !path.exists() {
        // As a column it is missing: says what there is.
        table.column(lambda)?;
    }
    let Some(exposures) = exposures else {
        return Err(Failure::Usage {
            message: format!("`{lambda}` gives Lambda by exposure, but no column of exposure is named"),
            help: "add --exposure COL, in what the file counts in (cycles of `life`)".to_owned(),
        });
    };
    let by_exposure: LambdaTable = lambda_table(path)?;
    let read = exposures.iter().zip(&table.rows).map(|(exposure, (line, _))| {
        by_exposure.at(*exposure).ok_or_else(|| {
            let message = format!(
                "line {line}: exposure {exposure} is outside of `{lambda}`, 0 to {}",
                by_exposure.end()
            );
            fault(&arguments.file, Some(*line), message, "run `life` further, or drop the line")
        })
    });
    read.collect()
}
