//! A parameter that is sought, and between which bounds. In: a range with a unit. Out: places between the bounds, 0 to 1. Never knows
//! what it is a parameter of.
//!
//! Between positive bounds places go by the logarithm: errors of such parameters are parts of them, and products of powers are
//! straight lines. Else they go by the value.

use thiserror::Error;

use crate::study::Axis;

/// A parameter that is sought.
#[derive(Clone, Debug, PartialEq)]
pub struct Free {
    /// Its name.
    pub name: String,
    /// The least value, in `unit`.
    pub lower: f64,
    /// The largest value, in `unit`.
    pub upper: f64,
    /// The unit that its bounds were written in; empty if it has none.
    pub unit: String,
}

/// What is no range to seek a parameter in.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum FreeError {
    /// A list, or a range with a number of values.
    #[error("`{0}` is no range of two bounds")]
    NoRange(String),
    /// The lower bound is not below the upper one.
    #[error("the bounds of `{name}` are reversed or the same: {written}")]
    Reversed {
        /// The parameter.
        name: String,
        /// The range.
        written: String,
    },
}

impl Free {
    /// Of a parameter's range.
    ///
    /// # Errors
    /// [`FreeError`].
    pub fn new(axis: &Axis) -> Result<Self, FreeError> {
        let no_range = || FreeError::NoRange(format!("{}={}", axis.name, axis.written));
        let ([lower, upper], unit) = axis.bounds().ok_or_else(no_range)?;
        if lower >= upper {
            return Err(FreeError::Reversed { name: axis.name.clone(), written: axis.written.clone() });
        }
        Ok(Self { name: axis.name.clone(), lower, upper, unit: unit.to_owned() })
    }

    /// Whether places go by the logarithm.
    pub fn is_logarithmic(&self) -> bool {
        self.lower > 0.0
    }

    /// Width of the bounds: of logarithms, or of values.
    pub(super) fn width(&self) -> f64 {
        if self.is_logarithmic() { libm::log(self.upper / self.lower) } else { self.upper - self.lower }
    }

    /// What the width is added to: a logarithm, or a value.
    pub(super) fn origin(&self) -> f64 {
        if self.is_logarithmic() { libm::log(self.lower) } else { self.lower }
    }

    /// The value at a place; the bounds themselves at 0 and 1.
    pub fn value(&self, place: f64) -> f64 {
        if place <= 0.0 {
            self.lower
        } else if place >= 1.0 {
            self.upper
        } else if self.is_logarithmic() {
            self.lower * libm::exp(place * self.width())
        } else {
            self.lower + place * self.width()
        }
    }

    /// The place of a value; outside of 0 to 1 beyond the bounds.
    pub fn place(&self, value: f64) -> f64 {
        if self.is_logarithmic() {
            libm::log(value / self.lower) / self.width()
        } else {
            (value - self.lower) / self.width()
        }
    }

    /// Change of the value with its place.
    pub(super) fn slope(&self, place: f64) -> f64 {
        if self.is_logarithmic() { self.value(place) * self.width() } else { self.width() }
    }

    /// A value with its unit, as `--set` takes it.
    pub fn written(&self, value: f64) -> String {
        crate::study::written(value, &self.unit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn free(text: &str) -> Result<Free, FreeError> {
        Free::new(&Axis::parse(text).expect("an axis"))
    }

    #[test]
    fn places_lie_evenly_by_logarithm_or_by_value() {
        let k = free("k=1e-9..1e-7").expect("a range");
        assert!((k.value(0.5) / 1e-8 - 1.0).abs() < 1e-14 && (k.place(1e-8) - 0.5).abs() < 1e-14);
        assert_eq!((k.value(0.0), k.value(1.0), k.value(1.2)), (1e-9, 1e-7, 1e-7));
        let x = free("x=-1 mm..3 mm").expect("a range");
        assert_eq!((x.value(0.5), x.place(1.0), x.written(1.0)), (1.0, 0.5, "1 mm".to_owned()));
        assert!((k.slope(0.3) * 1e-6 - (k.value(0.3 + 1e-6) - k.value(0.3))).abs() < 1e-16);
    }

    #[test]
    fn what_is_no_range_is_told() {
        assert!(matches!(free("c=1 um,2 um"), Err(FreeError::NoRange(_))));
        assert!(matches!(free("c=1 um..2 um:4"), Err(FreeError::NoRange(_))));
        for reversed in ["c=2 um..1 um", "c=1 um..1 um", "c=1 mm..2 um"] {
            assert!(matches!(free(reversed), Err(FreeError::Reversed { .. })), "{reversed}");
        }
    }
}
