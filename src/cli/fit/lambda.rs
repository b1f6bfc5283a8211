//! Lambda by exposure, from a file. In: the JSON of `life`, or a CSV of exposure and Lambda. Out: straight lines.
//! Never knows readings.

use std::path::Path;

use crate::csv_table::CsvTable;
use linkwear_codegen::input::read_text;
use linkwear_codegen::limits;
use linkwear_gamma::life::Clock;
use linkwear_gamma::monte_carlo::PER_METRE;
use serde_json::Value;

use super::super::failure::Failure;

/// Lambda by exposure, straight lines from (0, 0) on, and the largest exposure.
pub fn lambda_table(path: &Path) -> Result<(Clock, f64), Failure> {
    let mut points = vec![(0.0, 0.0)];
    if path.extension().is_some_and(|extension| extension == "json") {
        points.extend(of_life(path)?);
    } else {
        let table = CsvTable::read(path)?;
        let (exposures, lambdas) = (table.numbers_at(0)?, table.numbers_at(1)?);
        points.extend(exposures.into_iter().zip(lambdas).filter(|(exposure, _)| *exposure > 0.0));
    }
    let end = points.last().map_or(0.0, |(exposure, _)| *exposure);
    let clock = Clock::table(points).map_err(|error| {
        let message = format!("`{}` has no Lambda that rises with exposure: {error}", path.display());
        Failure::data(path, None, message, "two columns, exposure and Lambda, both rising")
    })?;
    Ok((clock, end))
}

/// Lambda [um], the unit of the Gamma layer, after each cycle of the joint that failed.
fn of_life(path: &Path) -> Result<Vec<(f64, f64)>, Failure> {
    let text = read_text(path, limits::DATA_BYTES).map_err(Failure::read(path))?;
    let foreign = || {
        let help = "write it by `linkwear life FILE --format json > life.json`";
        Failure::data(path, None, format!("`{}` is no result of `life`", path.display()), help)
    };
    let life: Value = serde_json::from_str(&text).map_err(|_| foreign())?;
    let joint = life["failed_joint"].as_str().ok_or_else(foreign)?;
    let mut sum = 0.0;
    let mut points = Vec::new();
    for (at, cycle) in life["cycles"].as_array().ok_or_else(foreign)?.iter().enumerate() {
        let mut joints = cycle["joints"].as_array().ok_or_else(foreign)?.iter();
        let entry = joints.find(|entry| entry["joint"] == joint).ok_or_else(foreign)?;
        sum += PER_METRE * entry["dLambda_m"].as_f64().ok_or_else(foreign)?;
        points.push(((at + 1) as f64, sum));
    }
    Ok(points)
}
