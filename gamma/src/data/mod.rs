//! Observed wear, checked and turned into increments. In: readings with the rows they stand in. Out: increments of
//! wear and exposure, unit by unit; or what is wrong, with rows and cure. Never knows files or laws of wear.

mod error;
mod history;
mod increment;
mod reading;

use std::collections::HashMap;

use self::history::histories;

pub use error::{DataError, NotIncreasing};
pub use increment::{Gauge, Increment, Known, Observations, Rounding};
pub use reading::{Reading, Reset, Seen};

#[cfg(test)]
mod tests;

/// How far from a whole number of steps of the gauge increments may be, for the digits that print leaves out.
const OFF_STEP: f64 = 1e-2;

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
        let mut bad = bad.peekable();
        if bad.peek().is_none() {
            return Ok(());
        }
        let mut wears: HashMap<usize, f64> = HashMap::new();
        for reading in readings {
            wears.entry(reading.row).or_insert(reading.wear);
        }
        let bad = bad.map(|increment| {
            let after = wears.get(&increment.row).copied().unwrap_or(0.0);
            let unit = self.units[increment.unit].clone();
            NotIncreasing { unit, row: increment.row, before: after - increment.wear, after }
        });
        Err(DataError::NotIncreasing(bad.collect()))
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
