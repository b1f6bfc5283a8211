//! A number that a law cannot take. Never knows whose number it is.

use core::error::Error;
use core::fmt;

/// A constant of a law is outside its range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutOfRange {
    /// Name of the constant.
    pub name: &'static str,
    /// Its value, in SI units.
    pub value: f64,
    /// What it must be.
    pub need: &'static str,
}

impl fmt::Display for OutOfRange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} is {}; it must be {}", self.name, self.value, self.need)
    }
}

impl Error for OutOfRange {}

/// `value` if it fulfils `fits` (NaN never does).
pub(crate) fn checked(
    name: &'static str,
    value: f64,
    need: &'static str,
    fits: impl FnOnce(f64) -> bool,
) -> Result<f64, OutOfRange> {
    if fits(value) { Ok(value) } else { Err(OutOfRange { name, value, need }) }
}

/// A finite number above zero.
pub(crate) fn positive(name: &'static str, value: f64) -> Result<f64, OutOfRange> {
    checked(name, value, "finite and above 0", |x| x > 0.0 && x.is_finite())
}

/// A finite number, not below zero.
pub(crate) fn not_negative(name: &'static str, value: f64) -> Result<f64, OutOfRange> {
    checked(name, value, "finite and not below 0", |x| x >= 0.0 && x.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_out_of_range_are_refused_by_name() {
        for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let error = positive("hardness", value).unwrap_err();
            assert_eq!(error.name, "hardness");
        }
        assert_eq!(not_negative("slope", 0.0), Ok(0.0));
        let error = not_negative("clearance", -0.5).unwrap_err();
        assert_eq!(error.to_string(), "clearance is -0.5; it must be finite and not below 0");
    }
}
