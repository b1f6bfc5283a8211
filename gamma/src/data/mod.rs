//! Observed wear, checked and turned into increments. In: readings with the rows they stand in. Out: increments of
//! wear and exposure, unit by unit; or what is wrong, with rows and cure. Never knows files or laws of wear.

mod error;
mod history;
mod reading;

use self::history::histories;

pub use error::{DataError, NotIncreasing};
pub use reading::{Reading, Reset, Seen};

#[cfg(test)]
mod tests;

/// How far from a whole number of steps of the gauge increments may be, for the digits that print leaves out.
const OFF_STEP: f64 = 1e-2;

/// What is known of the wear of one unit between two exposures.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Increment {
    /// Index of the unit in [`Observations::units`].
    pub unit: usize,
    /// Exposure at the earlier reading.
    pub from: f64,
    /// Exposure at the later reading, above `from`.
    pub to: f64,
    /// Wear between them, or a bound of it, as `known` has it.
    pub wear: f64,
    /// Logarithms of the covariates.
    pub ln_covariates: Vec<f64>,
    /// Row of the later reading; 0 for none.
    pub row: usize,
    /// How much is known of it.
    pub known: Known,
}

/// What is known of an increment of wear.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Known {
    /// Wear grew by just so much from a reading to the next.
    #[default]
    Exact,
    /// It did so from a level that is no reading, as after regrinding: exact even where a gauge rounds.
    FromLevel,
    /// It did so from a reading of its own, taken at the exposure of the one before it, after the part was worked on.
    Anew,
    /// It did so, and at exposure `at` on the way it had grown by less than `below`: the gauge showed nothing yet.
    Through {
        /// Exposure on the way.
        at: f64,
        /// What it had grown by less than.
        below: f64,
    },
    /// It reached so much, by `to` at the latest.
    AtLeast,
    /// It was less at `to`.
    Below,
    /// No increment: the unit is among the data only because its wear at `to` was below `wear`, from a new unit at 0.
    Entered {
        /// Whether the unit's increments begin at the new unit, too; else at its entry.
        from_new: bool,
    },
}

impl Increment {
    /// Whether its wear is known, and not only bounded.
    pub fn is_exact(&self) -> bool {
        self.is_plain() || matches!(self.known, Known::Through { .. })
    }

    /// Whether all is known of it that a difference of two readings tells, and no more.
    pub fn is_plain(&self) -> bool {
        matches!(self.known, Known::Exact | Known::FromLevel | Known::Anew)
    }

    /// Whether it tells of wear, and not of how the unit came into the sample.
    pub fn is_growth(&self) -> bool {
        !matches!(self.known, Known::Entered { .. })
    }
}

/// What a process is fitted to.
#[derive(Clone, Debug, PartialEq)]
pub struct Observations {
    /// Names of the units, in the order in which they first appear. A part that takes the place of another is a unit of its own,
    /// named after the first: `a`, `a#2`, `a#3`.
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

impl Observations {
    /// Increments of readings, units in order of first appearance. With `from_zero` every unit that does not begin at
    /// exposure 0 gets (0, 0) as its first reading.
    ///
    /// # Errors
    /// [`DataError`], with rows and a cure.
    pub fn new(readings: &[Reading], from_zero: bool, gauge: Gauge) -> Result<Self, DataError> {
        Self::with_wear(readings, from_zero, gauge).map(|(own, _)| own)
    }

    /// The same, and what each unit wears now: its last reading, or the level it was set to after that; NaN where that is not
    /// known.
    ///
    /// # Errors
    /// [`DataError`], with rows and a cure.
    pub fn with_wear(
        readings: &[Reading],
        from_zero: bool,
        gauge: Gauge,
    ) -> Result<(Self, Vec<f64>), DataError> {
        check_numbers(readings)?;
        let (own, wear) = histories(readings, from_zero, gauge)?;
        let (first, last) = (readings[0].row, readings[readings.len() - 1].row);
        let mut growth = own.increments.iter().filter(|increment| increment.is_growth());
        if growth.all(|increment| increment.wear == 0.0) {
            return Err(DataError::Constant { first, last });
        }
        own.check_growth(readings, gauge)?;
        if let Gauge::Resolution(Rounding { step, .. }) = gauge {
            own.check_steps(step)?;
        }
        Ok((own, wear))
    }

    /// Whether all that is known are differences of readings.
    pub fn is_plain(&self) -> bool {
        self.increments.iter().all(Increment::is_plain)
    }

    /// Whether the wear of some increments is bounded, on its way or at its end.
    pub fn has_bounds(&self) -> bool {
        self.increments.iter().any(|one| one.is_growth() && !one.is_plain())
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
        let bad = self.increments.iter().filter(|increment| increment.is_exact() && refused(increment.wear));
        let bad = bad.map(|increment| {
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
        if let Some(Reset::Replaced(Some(level)) | Reset::Reground(Some(level))) = reading.reset
            && !(level.is_finite() && level >= 0.0)
        {
            return bad("the level of wear after a reset", level);
        }
        if let Some(limit) = reading.entered_below.filter(|limit| !(limit.is_finite() && *limit > 0.0)) {
            return bad("the wear that units entered below", limit);
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
