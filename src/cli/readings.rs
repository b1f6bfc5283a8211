//! Inspections from a CSV file. In: file, names of two columns. Out: readings, and the line of each, for messages. Never
//! knows what readings are for.

use std::path::Path;

use linkwear_gamma::inspection::Reading;

use super::csv_table::CsvTable;
use super::failure::Failure;

/// Readings and the line of the file each stands on.
pub fn read(file: &Path, time: &str, wear: &str) -> Result<(Vec<Reading>, Vec<usize>), Failure> {
    let table = CsvTable::read(file)?;
    let pairs = table.numbers(time)?.into_iter().zip(table.numbers(wear)?);
    Ok((pairs.map(|(time, wear)| Reading { time, wear }).collect(), table.lines().collect()))
}
