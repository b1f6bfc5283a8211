//! Readings of one joint, checked. In: (time, wear). Out: a history no later code has to check. Never knows parameters.

use super::error::InspectionError;
use crate::process::Process;

/// One inspection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// When \[unit of time\], since the joint was new.
    pub time: f64,
    /// Wear measured \[unit of wear\].
    pub wear: f64,
}

/// Readings in the order of time.
#[derive(Clone, Debug, PartialEq)]
pub struct History {
    readings: Vec<Reading>,
    /// Whether wear is known to have been 0 at time 0, before the first reading.
    from_new: bool,
}

impl History {
    /// Readings without gauge error: wear rises from each to the next, if it does so by the process. Before a first reading that is later
    /// than time 0 the joint was new, at time 0 without wear; a reading at time 0 says what it began with.
    ///
    /// # Errors
    /// [`InspectionError`] with the first reading that cannot be.
    pub fn exact(process: &dyn Process, readings: Vec<Reading>) -> Result<Self, InspectionError> {
        let from_new = readings.first().is_some_and(|first| first.time > 0.0);
        let history = Self::any(readings, if from_new { 1 } else { 2 }, "to see wear rise")?;
        let history = Self { from_new, ..history };
        if !process.is_increasing() {
            return Ok(history);
        }
        for (at, pair) in history.since_new().windows(2).enumerate() {
            let row = at + if from_new { 1 } else { 2 };
            let (wear, before) = (pair[1].wear, pair[0].wear);
            if wear < before {
                return Err(InspectionError::Falls { row, wear, before });
            }
            if wear == before {
                return Err(InspectionError::StandsStill { row, wear });
            }
        }
        Ok(history)
    }

    /// Readings with gauge error: they may fall.
    ///
    /// # Errors
    /// [`InspectionError`] with the first reading that cannot be.
    pub fn noisy(readings: Vec<Reading>) -> Result<Self, InspectionError> {
        Self::any(readings, 1, "to learn anything")
    }

    fn any(readings: Vec<Reading>, needed: usize, why: &'static str) -> Result<Self, InspectionError> {
        if readings.len() < needed {
            return Err(InspectionError::TooFew { readings: readings.len(), needed, why });
        }
        for (at, reading) in readings.iter().enumerate() {
            let row = at + 1;
            for (what, value) in [("time", reading.time), ("wear", reading.wear)] {
                if !(value.is_finite() && value >= 0.0) {
                    return Err(InspectionError::NoNumber { row, what, value });
                }
            }
            let before = at.checked_sub(1).map(|before| readings[before].time);
            if let Some(before) = before.filter(|before| reading.time <= *before) {
                return Err(InspectionError::Order { row, time: reading.time, before });
            }
        }
        Ok(Self { readings, from_new: false })
    }

    /// The readings.
    pub fn readings(&self) -> &[Reading] {
        &self.readings
    }

    /// The readings, after the new joint where it goes before them.
    fn since_new(&self) -> Vec<Reading> {
        let new = self.from_new.then_some(Reading { time: 0.0, wear: 0.0 });
        new.into_iter().chain(self.readings.iter().copied()).collect()
    }

    /// From the new joint, if it goes before, and from each reading to the next: exposure before and after at `rate` units of it per
    /// unit of time, wear between.
    pub(super) fn increments(&self, rate: f64) -> Vec<[f64; 3]> {
        let between = |pair: &[Reading]| {
            let [from, to] = [pair[0].time, pair[1].time].map(|time| rate * time);
            [from, to, pair[1].wear - pair[0].wear]
        };
        self.since_new().windows(2).map(between).collect()
    }

    /// The last reading.
    pub fn last(&self) -> Reading {
        self.readings[self.readings.len() - 1]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::process::{Gamma, Wiener};

    #[test]
    fn a_joint_was_new_before_its_first_reading() {
        let increments = |rows: &[(f64, f64)]| exact(rows).expect("rising").increments(2.0);
        let plain = increments(&[(0.0, 0.0), (2.0, 1.5), (4.0, 4.0)]);
        assert_eq!(increments(&[(2.0, 1.5), (4.0, 4.0)]), plain);
        assert_eq!(increments(&[(2.0, 1.5)]), plain[..1]);
        // What it began with is read.
        assert_eq!(increments(&[(0.0, 0.5), (2.0, 1.5)]), [[0.0, 4.0, 1.0]]);
    }

    fn exact(rows: &[(f64, f64)]) -> Result<History, InspectionError> {
        History::exact(&Gamma, rows.iter().map(|(time, wear)| Reading { time: *time, wear: *wear }).collect())
    }

    #[test]
    fn readings_that_cannot_be_are_named_by_row() {
        let cases: [(&[(f64, f64)], &str); 8] = [
            (&[(0.0, 0.0), (2.0, 1.0), (1.0, 2.0)], "reading 3: its time 1 is not after the 2"),
            (&[(0.0, 0.0), (1.0, 1.0), (1.0, 2.0)], "reading 3: its time 1 is not after the 1"),
            (&[(0.0, 0.0), (1.0, 2.0), (2.0, 1.5)], "reading 3: wear falls from 2 to 1.5"),
            (&[(0.0, 0.0), (1.0, 2.0), (2.0, 2.0)], "reading 3: wear stays at 2"),
            (&[(0.0, 0.0), (1.0, f64::NAN)], "reading 2: the wear is NaN"),
            (&[(-1.0, 0.0), (1.0, 1.0)], "reading 1: the time is -1"),
            (&[(0.0, 0.0)], "1 reading(s): at least 2 are needed"),
            (&[], "0 reading(s)"),
        ];
        for (rows, expected) in cases {
            let error = exact(rows).expect_err("cannot be").to_string();
            assert!(error.starts_with(expected), "{error}");
        }
        assert!(exact(&[(0.0, 0.0), (1.0, 0.5)]).is_ok());
        // From the new joint on.
        let error = exact(&[(1.0, 0.0), (2.0, 0.5)]).expect_err("no wear").to_string();
        assert!(error.starts_with("reading 1: wear stays at 0"), "{error}");
        let fall = vec![Reading { time: 1.0, wear: 1.0 }, Reading { time: 2.0, wear: 0.9 }];
        assert!(History::noisy(fall.clone()).is_ok() && History::exact(&Wiener, fall).is_ok());
    }
}
