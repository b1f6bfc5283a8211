//! Observed wear, checked and turned into increments. In: readings with the rows they stand in. Out: increments of
//! wear and exposure, unit by unit; or what is wrong, with rows and cure. Never knows files or laws of wear.

use std::fmt;

use thiserror::Error;

/// How far from a whole number of steps of the gauge increments may be, for the digits that print leaves out.
const OFF_STEP: f64 = 1e-2;

/// One reading of one unit (specimen).
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// Name of the unit.
    pub unit: String,
    /// Exposure, or Lambda itself, in the data's own unit.
    pub exposure: f64,
    /// Wear, in the data's own unit.
    pub wear: f64,
    /// Covariates such as load, in the data's own units; of the interval that ends at this reading.
    pub covariates: Vec<f64>,
    /// Row of the source, as its errors shall name it.
    pub row: usize,
}

/// Wear between two readings of one unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Increment {
    /// Index of the unit in [`Observations::units`].
    pub unit: usize,
    /// Exposure at the earlier reading.
    pub from: f64,
    /// Exposure at the later reading, above `from`.
    pub to: f64,
    /// Wear between them.
    pub wear: f64,
    /// Logarithms of the covariates.
    pub ln_covariates: Vec<f64>,
    /// Row of the later reading; 0 for none.
    pub row: usize,
}

/// What a Gamma process is fitted to.
#[derive(Clone, Debug, PartialEq)]
pub struct Observations {
    /// Names of the units, in the order in which they first appear.
    pub units: Vec<String>,
    /// Increments, unit by unit, in order of exposure.
    pub increments: Vec<Increment>,
}

/// How a gauge gives readings: true wear with a normal error, then rounded to the nearest multiple of a step, but for a shift that
/// all readings of a unit share. Readings at exposure 0 are exact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rounding {
    /// The step, in the unit of wear.
    pub step: f64,
    /// Standard deviation of the error before rounding; 0 for none.
    pub error: f64,
}

impl Rounding {
    /// Without an error before.
    pub fn to(step: f64) -> Self {
        Self { step, error: 0.0 }
    }
}

/// How zero and negative increments are taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Gauge {
    /// Readings are exact: every increment must be positive.
    Exact,
    /// Readings are rounded.
    Resolution(Rounding),
    /// Readings carry random errors: any increment may be seen.
    Noisy,
}

/// An increment that a Gamma process cannot have.
#[derive(Clone, Debug, PartialEq)]
pub struct NotIncreasing {
    /// Name of the unit.
    pub unit: String,
    /// Row of the later reading.
    pub row: usize,
    /// Wear before.
    pub before: f64,
    /// Wear after, not above `before`.
    pub after: f64,
}

impl fmt::Display for NotIncreasing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "row {} (unit {}: {} after {})", self.row, self.unit, self.after, self.before)
    }
}

/// Why readings cannot be fitted.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum DataError {
    /// There is nothing.
    #[error("there are no readings")]
    Empty,
    /// A number is not finite, or out of the range of its kind.
    #[error("row {row}: {what} is {value}")]
    BadNumber {
        /// The row.
        row: usize,
        /// What the number is.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// Exposure goes back.
    #[error("row {row}: unit {unit} goes back from {before} to {after}")]
    Unsorted {
        /// Name of the unit.
        unit: String,
        /// Row of the later line.
        row: usize,
        /// Exposure before.
        before: f64,
        /// Exposure after.
        after: f64,
    },
    /// Two readings of a unit at one exposure.
    #[error("rows {first} and {row}: unit {unit} is read twice at {exposure}")]
    Duplicate {
        /// Name of the unit.
        unit: String,
        /// Row of the first.
        first: usize,
        /// Row of the second.
        row: usize,
        /// The exposure.
        exposure: f64,
    },
    /// A unit with one reading has no increment.
    #[error("row {row}: unit {unit} has one reading only, so no increment")]
    OneReading {
        /// Name of the unit.
        unit: String,
        /// Its row.
        row: usize,
    },
    /// Too few increments for the number of parameters.
    #[error("row {row}: the data give {increments} increment(s); {parameters} parameters need at least {}", parameters + 1)]
    TooFew {
        /// Row of the last reading.
        row: usize,
        /// How many there are.
        increments: usize,
        /// How many parameters are sought.
        parameters: usize,
    },
    /// Wear never changes.
    #[error("rows {first} to {last}: wear is constant")]
    Constant {
        /// First row.
        first: usize,
        /// Last row.
        last: usize,
    },
    /// Increments that are zero or negative.
    #[error("{} increment(s) of wear are not positive: {}", .0.len(), listed(.0))]
    NotIncreasing(Vec<NotIncreasing>),
    /// Readings of a unit that do not differ by a multiple of the gauge's step.
    #[error(
        "row {row}: unit {unit} grew by {wear} since its reading before, no multiple of the resolution {step}"
    )]
    NotMultiple {
        /// Name of the unit.
        unit: String,
        /// Row of the later reading.
        row: usize,
        /// Wear between both.
        wear: f64,
        /// The gauge's step.
        step: f64,
    },
    /// A covariate never changes, so its effect cannot be seen.
    #[error("covariate {index} is the same in all rows ({value})")]
    ConstantCovariate {
        /// Which, from 1.
        index: usize,
        /// Its value.
        value: f64,
    },
}

fn listed(rows: &[NotIncreasing]) -> String {
    rows.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}

impl DataError {
    /// The row to look at first, when one is to blame.
    pub fn row(&self) -> Option<usize> {
        match self {
            Self::Empty | Self::ConstantCovariate { .. } => None,
            Self::BadNumber { row, .. }
            | Self::Unsorted { row, .. }
            | Self::Duplicate { row, .. }
            | Self::OneReading { row, .. }
            | Self::NotMultiple { row, .. }
            | Self::TooFew { row, .. } => Some(*row),
            Self::Constant { first, .. } => Some(*first),
            Self::NotIncreasing(rows) => rows.first().map(|increment| increment.row),
        }
    }

    /// What to do.
    pub fn cure(&self) -> &'static str {
        match self {
            Self::Empty => "give at least two readings of a unit",
            Self::BadNumber { .. } => "correct or delete the row",
            Self::Unsorted { .. } => "sort the readings of each unit by exposure",
            Self::Duplicate { .. } => "delete one of the two rows, or write their mean",
            Self::OneReading { .. } => "delete the row, add readings, or begin each unit at (0, 0)",
            Self::TooFew { .. } => "add readings or units, or estimate fewer parameters",
            Self::Constant { .. } => "nothing can be learnt from it: wear has to grow",
            Self::NotIncreasing(_) => {
                "wear cannot shrink: correct the rows or leave them out; if all are zero, state the gauge's resolution, and if it errs, its error too"
            }
            Self::NotMultiple { .. } => {
                "state the step that the readings were rounded to, in their unit; leave the resolution out if they were not"
            }
            Self::ConstantCovariate { .. } => "leave the covariate out",
        }
    }
}

impl Observations {
    /// Increments of readings, units in order of first appearance. With `from_zero` every unit that does not begin at
    /// exposure 0 gets (0, 0) as its first reading.
    ///
    /// # Errors
    /// [`DataError`], with rows and a cure.
    pub fn new(readings: &[Reading], from_zero: bool, gauge: Gauge) -> Result<Self, DataError> {
        check_numbers(readings)?;
        let mut units: Vec<String> = Vec::new();
        for reading in readings {
            if !units.contains(&reading.unit) {
                units.push(reading.unit.clone());
            }
        }
        let mut increments = Vec::new();
        for (unit, name) in units.iter().enumerate() {
            let own: Vec<&Reading> = readings.iter().filter(|reading| reading.unit == *name).collect();
            increments.extend(increments_of(unit, &own, from_zero)?);
        }
        let own = Self { units, increments };
        let (first, last) = (readings[0].row, readings[readings.len() - 1].row);
        if own.increments.iter().all(|increment| increment.wear == 0.0) {
            return Err(DataError::Constant { first, last });
        }
        own.check_growth(readings, gauge)?;
        if let Gauge::Resolution(Rounding { step, .. }) = gauge {
            own.check_steps(step)?;
        }
        Ok(own)
    }

    fn check_steps(&self, step: f64) -> Result<(), DataError> {
        let off = |increment: &&Increment| {
            let steps = increment.wear / step;
            (steps - libm::round(steps)).abs() > OFF_STEP
        };
        let Some(increment) = self.increments.iter().find(off) else { return Ok(()) };
        let (unit, wear) = (self.units[increment.unit].clone(), increment.wear);
        Err(DataError::NotMultiple { unit, row: increment.row, wear, step })
    }

    fn check_growth(&self, readings: &[Reading], gauge: Gauge) -> Result<(), DataError> {
        let refused = |wear: f64| match gauge {
            Gauge::Exact => wear <= 0.0,
            Gauge::Resolution(rounding) => wear < 0.0 && rounding.error == 0.0,
            Gauge::Noisy => false,
        };
        let bad = self.increments.iter().filter(|increment| refused(increment.wear)).map(|increment| {
            let after = readings.iter().find(|reading| reading.row == increment.row).map_or(0.0, |r| r.wear);
            let unit = self.units[increment.unit].clone();
            NotIncreasing { unit, row: increment.row, before: after - increment.wear, after }
        });
        let bad: Vec<NotIncreasing> = bad.collect();
        if bad.is_empty() { Ok(()) } else { Err(DataError::NotIncreasing(bad)) }
    }
}

fn check_numbers(readings: &[Reading]) -> Result<(), DataError> {
    if readings.is_empty() {
        return Err(DataError::Empty);
    }
    for reading in readings {
        let row = reading.row;
        let bad = |what, value| Err(DataError::BadNumber { row, what, value });
        if !reading.wear.is_finite() {
            return bad("wear", reading.wear);
        }
        if !reading.exposure.is_finite() || reading.exposure < 0.0 {
            return bad("exposure", reading.exposure);
        }
        if let Some(value) = reading.covariates.iter().find(|value| !value.is_finite() || **value <= 0.0) {
            return bad("a covariate, whose logarithm is needed,", *value);
        }
    }
    for index in 0..readings[0].covariates.len() {
        let value = readings[0].covariates[index];
        if readings.iter().all(|reading| reading.covariates[index] == value) {
            return Err(DataError::ConstantCovariate { index: index + 1, value });
        }
    }
    Ok(())
}

fn increments_of(unit: usize, own: &[&Reading], from_zero: bool) -> Result<Vec<Increment>, DataError> {
    let zero = (from_zero && own[0].exposure > 0.0).then_some((0.0, 0.0));
    if own.len() == 1 && zero.is_none() {
        return Err(DataError::OneReading { unit: own[0].unit.clone(), row: own[0].row });
    }
    let mut before = zero.map(|(exposure, wear)| (exposure, wear, 0));
    let mut increments = Vec::new();
    for reading in own {
        if let Some((exposure, wear, first)) = before {
            if reading.exposure < exposure {
                let (before, after) = (exposure, reading.exposure);
                return Err(DataError::Unsorted {
                    unit: reading.unit.clone(),
                    row: reading.row,
                    before,
                    after,
                });
            }
            if reading.exposure == exposure {
                return Err(DataError::Duplicate {
                    unit: reading.unit.clone(),
                    first,
                    row: reading.row,
                    exposure,
                });
            }
            increments.push(Increment {
                unit,
                from: exposure,
                to: reading.exposure,
                wear: reading.wear - wear,
                ln_covariates: reading.covariates.iter().map(|value| libm::log(*value)).collect(),
                row: reading.row,
            });
        }
        before = Some((reading.exposure, reading.wear, reading.row));
    }
    Ok(increments)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn readings(rows: &[(&str, f64, f64)]) -> Vec<Reading> {
        let reading = |(at, (unit, exposure, wear)): (usize, &(&str, f64, f64))| Reading {
            unit: (*unit).to_owned(),
            exposure: *exposure,
            wear: *wear,
            covariates: Vec::new(),
            row: at + 2,
        };
        rows.iter().enumerate().map(reading).collect()
    }

    fn refused(rows: &[(&str, f64, f64)], gauge: Gauge) -> DataError {
        Observations::new(&readings(rows), false, gauge).unwrap_err()
    }

    #[test]
    fn increments_are_taken_within_units_even_when_their_rows_are_mixed() {
        let rows = readings(&[("a", 1.0, 2.0), ("b", 1.0, 1.0), ("a", 3.0, 5.0), ("b", 2.0, 4.0)]);
        let seen = Observations::new(&rows, false, Gauge::Exact).unwrap();
        let found: Vec<_> = seen.increments.iter().map(|i| (i.unit, i.from, i.to, i.wear, i.row)).collect();
        assert_eq!(found, [(0, 1.0, 3.0, 3.0, 4), (1, 1.0, 2.0, 3.0, 5)]);
        let seen = Observations::new(&rows, true, Gauge::Exact).unwrap();
        assert_eq!(seen.increments.len(), 4);
        assert_eq!((seen.increments[0].from, seen.increments[0].wear), (0.0, 2.0));
    }

    #[test]
    fn every_fault_names_its_row_and_a_cure() {
        let faults = [
            (refused(&[("a", 2.0, 1.0), ("a", 1.0, 2.0)], Gauge::Exact), 3, "goes back"),
            (refused(&[("a", 2.0, 1.0), ("a", 2.0, 2.0)], Gauge::Exact), 3, "twice"),
            (refused(&[("a", 1.0, 1.0), ("a", 2.0, 2.0), ("b", 1.0, 1.0)], Gauge::Exact), 4, "one reading"),
            (refused(&[("a", 1.0, 1.0), ("a", 2.0, f64::NAN)], Gauge::Exact), 3, "NaN"),
            (refused(&[("a", -1.0, 1.0), ("a", 2.0, 3.0)], Gauge::Exact), 2, "exposure is -1"),
            (refused(&[("a", 1.0, 1.0), ("a", 2.0, 1.0)], Gauge::Exact), 2, "constant"),
        ];
        for (fault, row, words) in faults {
            assert_eq!(fault.row(), Some(row), "{fault}");
            assert!(fault.to_string().contains(words) && !fault.cure().is_empty(), "{fault}");
        }
        assert_eq!(Observations::new(&[], false, Gauge::Exact), Err(DataError::Empty));
    }

    #[test]
    fn all_rows_that_do_not_grow_are_named_and_zeros_pass_with_a_resolution() {
        let rows = [("a", 1.0, 1.0), ("a", 2.0, 1.0), ("a", 3.0, 2.0), ("b", 1.0, 3.0), ("b", 2.0, 2.5)];
        let text = refused(&rows, Gauge::Exact).to_string();
        assert!(
            text.contains("row 3 (unit a: 1 after 1)") && text.contains("row 6 (unit b: 2.5 after 3)"),
            "{text}"
        );
        let DataError::NotIncreasing(bad) = refused(&rows, Gauge::Resolution(Rounding::to(0.5))) else {
            panic!()
        };
        assert_eq!(bad.len(), 1);
        assert!(Observations::new(&readings(&rows), false, Gauge::Noisy).is_ok());
        let errs = Gauge::Resolution(Rounding { step: 0.5, error: 0.2 });
        assert!(Observations::new(&readings(&[("a", 1.0, 1.0), ("a", 2.0, 0.5)]), false, errs).is_ok());
        let off = refused(&[("a", 1.0, 1.0), ("a", 2.0, 1.6)], Gauge::Resolution(Rounding::to(0.5)));
        assert!(off.row() == Some(3) && off.to_string().contains("no multiple"), "{off}");
    }
}
