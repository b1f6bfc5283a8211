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

/// Lambda by exposure.
pub struct LambdaTable {
    lambda: Clock,
    /// Lambda of a new part, at exposure 0; of a table that begins later it is not known, and Lambda counts as it is written.
    new: Option<f64>,
    /// Exposures between which it is known: beyond them straight lines would be made up.
    pub range: [f64; 2],
}

impl LambdaTable {
    /// From a file; of which joint, if a life has several.
    ///
    /// # Errors
    /// [`Failure`], if it has no Lambda that rises with exposure, or does not say whose.
    pub fn read(path: &Path, joint: Option<&str>) -> Result<Self, Failure> {
        let points = if path.extension().is_some_and(|extension| extension == "json") {
            of_life(path, joint)?
        } else if let Some(joint) = joint {
            let message = format!("`{}` is a table, which has no joint `{joint}`", path.display());
            return Err(Failure::data(path, None, message, "leave the joint out: a table has one Lambda"));
        } else {
            let table = CsvTable::read(path)?;
            table.numbers_at(0)?.into_iter().zip(table.numbers_at(1)?).collect()
        };
        let [begin, end] = [points.first(), points.last()].map(|row| row.copied().unwrap_or_default());
        let lambda = Clock::table(points).map_err(|error| {
            let message = format!("`{}` has no Lambda that rises with exposure: {error}", path.display());
            Failure::data(path, None, message, "two columns, exposure and Lambda, both rising")
        })?;
        let range = [begin.0.max(0.0), end.0];
        let new = (begin.0 <= 0.0 && end.0 >= 0.0).then(|| lambda.exposure(0.0));
        if new.is_none() && begin.1 < 0.0 {
            let message = format!("Lambda is {} at exposure {}, where no part is new", begin.1, begin.0);
            let help = "begin the table at exposure 0, or count Lambda from a new part on";
            return Err(Failure::data(path, None, message, help));
        }
        Ok(Self { lambda, new, range })
    }

    /// Whether it tells Lambda of a new part.
    pub fn begins_at_zero(&self) -> bool {
        self.new.is_some()
    }

    /// Lambda since the part was new, if that is known; none out of range.
    pub fn at(&self, exposure: f64) -> Option<f64> {
        let [begin, end] = self.range;
        (begin..=end).contains(&exposure).then(|| self.lambda.exposure(exposure) - self.new.unwrap_or(0.0))
    }
}

/// Joint and file of `JOINT=FILE`, or the file alone.
pub fn named(text: &str) -> (Option<&str>, &Path) {
    let both = text.split_once('=').map(|(joint, path)| (Some(joint.trim()), Path::new(path.trim())));
    both.filter(|(_, path)| !Path::new(text).exists() && path.exists()).unwrap_or((None, Path::new(text)))
}

/// Lambda \[um\], the unit of the Gamma layer, of a new joint and after each cycle. Each joint of a life has its own.
fn of_life(path: &Path, joint: Option<&str>) -> Result<Vec<(f64, f64)>, Failure> {
    let text = read_text(path, limits::DATA_BYTES).map_err(Failure::read(path))?;
    let foreign = || {
        let help = "write it by `linkwear life FILE --format json > life.json`";
        Failure::data(path, None, format!("`{}` is no result of `life`", path.display()), help)
    };
    let life: Value = serde_json::from_str(&text).map_err(|_| foreign())?;
    let first = life["cycles"][0]["joints"].as_array().ok_or_else(foreign)?;
    let joints: Vec<&str> = first.iter().filter_map(|entry| entry["joint"].as_str()).collect();
    let joint = match (joint, joints.as_slice()) {
        (None, [only]) => *only,
        (_, []) => return Err(foreign()),
        (Some(joint), _) if joints.contains(&joint) => joint,
        _ => {
            let path = path.display();
            let message = match joint {
                Some(joint) => format!("no joint `{joint}` wears in `{path}`"),
                None => format!(
                    "`{path}` has the Lambda of {} joints, and does not say whose wear this is",
                    joints.len()
                ),
            };
            let help = format!("write --lambda JOINT={path}; wearing joints: {}", joints.join(", "));
            return Err(Failure::usage(message, help));
        }
    };
    let mut sum = 0.0;
    let mut points = vec![(0.0, 0.0)];
    for (at, cycle) in life["cycles"].as_array().ok_or_else(foreign)?.iter().enumerate() {
        let mut joints = cycle["joints"].as_array().ok_or_else(foreign)?.iter();
        let entry = joints.find(|entry| entry["joint"] == joint).ok_or_else(foreign)?;
        sum += PER_METRE * entry["dLambda_m"].as_f64().ok_or_else(foreign)?;
        points.push(((at + 1) as f64, sum));
    }
    Ok(points)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(name: &str, rows: &str) -> Result<LambdaTable, Failure> {
        let path = std::env::temp_dir().join(format!("linkwear-lambda-{}-{name}.csv", std::process::id()));
        std::fs::write(&path, format!("exposure,lambda\n{rows}")).expect("a temporary file");
        let read = LambdaTable::read(&path, None);
        std::fs::remove_file(path).expect("the file");
        read
    }

    #[test]
    fn differences_alone_count_and_nothing_is_made_up() {
        let lambda = |rows, exposure| table("at", rows).expect("rising").at(exposure);
        for rows in ["0,0\n5,5\n", "0,10\n5,15\n", "-5,5\n5,15\n"] {
            assert_eq!(
                [0.0, 2.0, 5.0, 5.1, -1.0].map(|t| lambda(rows, t)),
                [Some(0.0), Some(2.0), Some(5.0), None, None]
            );
        }
        // Begun later: from nowhere else than its own rows.
        let late = table("late", "2,4\n5,10\n").expect("rising");
        assert!(!late.begins_at_zero());
        assert_eq!([0.0, 1.9, 2.0, 5.0].map(|t| late.at(t)), [None, None, Some(4.0), Some(10.0)]);
        assert!(table("negative", "2,-4\n5,10\n").is_err());
        assert!(table("one", "5,10\n").is_err());
    }
}
