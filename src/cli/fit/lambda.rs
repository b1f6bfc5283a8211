//! Lambda by exposure, from a file. In: the JSON of `life`, or a CSV of exposure and Lambda. Out: a table to look up.
//! Never knows readings.

use std::fs;
use std::path::Path;

use serde_json::Value;

use super::super::failure::Failure;
use super::read::{Table, fault};

/// Micrometres in a metre.
const MICRO: f64 = 1e6;

/// Lambda at rising exposures, linear between them.
pub struct LambdaTable(Vec<(f64, f64)>);

impl LambdaTable {
    /// Lambda at an exposure; none outside.
    pub fn at(&self, exposure: f64) -> Option<f64> {
        let above = self.0.partition_point(|(known, _)| *known < exposure);
        let (x1, y1) = *self.0.get(above)?;
        if x1 == exposure {
            return Some(y1);
        }
        let (x0, y0) = *self.0.get(above.checked_sub(1)?)?;
        Some(y0 + (y1 - y0) * (exposure - x0) / (x1 - x0))
    }

    /// The largest exposure.
    pub fn end(&self) -> f64 {
        self.0.last().map_or(0.0, |(exposure, _)| *exposure)
    }
}

/// Reads either kind; both begin at (0, 0).
pub fn lambda_table(path: &Path) -> Result<LambdaTable, Failure> {
    let mut points = vec![(0.0, 0.0)];
    if path.extension().is_some_and(|extension| extension == "json") {
        points.extend(of_life(path)?);
    } else {
        let table = Table::read(path)?;
        let (exposures, lambdas) = (table.numbers(0)?, table.numbers(1)?);
        points.extend(exposures.into_iter().zip(lambdas).filter(|(exposure, _)| *exposure > 0.0));
    }
    let rising = points.windows(2).all(|pair| pair[0].0 < pair[1].0 && pair[0].1 < pair[1].1);
    if !rising || points.len() < 2 {
        let message = format!("`{}` has no Lambda that rises with exposure", path.display());
        return Err(fault(path, None, message, "two columns, exposure and Lambda, both rising"));
    }
    Ok(LambdaTable(points))
}

/// Lambda [um], the unit of the Gamma layer, after each cycle of the joint that failed.
fn of_life(path: &Path) -> Result<Vec<(f64, f64)>, Failure> {
    let text = fs::read_to_string(path).map_err(|error| Failure::Read(path.to_path_buf(), error))?;
    let foreign = || {
        let help = "write it by `linkwear life FILE --format json > life.json`";
        fault(path, None, format!("`{}` is no result of `life`", path.display()), help)
    };
    let life: Value = serde_json::from_str(&text).map_err(|_| foreign())?;
    let joint = life["failed_joint"].as_str().ok_or_else(foreign)?;
    let mut sum = 0.0;
    let mut points = Vec::new();
    for (at, cycle) in life["cycles"].as_array().ok_or_else(foreign)?.iter().enumerate() {
        let mut joints = cycle["joints"].as_array().ok_or_else(foreign)?.iter();
        let own = joints.find(|entry| entry["joint"] == joint).ok_or_else(foreign)?;
        sum += MICRO * own["dLambda_m"].as_f64().ok_or_else(foreign)?;
        points.push(((at + 1) as f64, sum));
    }
    Ok(points)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lambda_is_linear_between_points_and_unknown_outside() {
        let table = LambdaTable(vec![(0.0, 0.0), (2.0, 4.0), (3.0, 5.0)]);
        assert_eq!([0.0, 1.0, 2.0, 2.5, 3.0].map(|x| table.at(x)), [0.0, 2.0, 4.0, 4.5, 5.0].map(Some));
        assert_eq!(table.at(3.1), None);
    }
}
