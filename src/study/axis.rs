//! A parameter that varies, and over what. In: `speed=5Hz..20Hz:4`, `speed=5Hz,10Hz`. Out: texts of quantities, as `--set` takes them.
//! Never knows which parameters there are.

use linkwear_codegen::spec::{as_written, unit_size};
use thiserror::Error;

/// A parameter and its values.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The parameter.
    pub name: String,
    /// What was written after its name.
    pub written: String,
    pub(super) values: Values,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Values {
    List(Vec<String>),
    Range(Range),
}

/// From one end to another, in the unit of the first.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Range {
    ends: [f64; 2],
    unit: String,
    /// Values of a grid, both ends included; none where a sample chooses them.
    pub count: Option<u64>,
}

/// What is no parameter with values.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum AxisError {
    /// There is no `=` between two words.
    #[error("`{0}` names no parameter and values")]
    Form(String),
    /// A list has an empty place.
    #[error("a value of `{0}` is empty")]
    Empty(String),
    /// The number behind the colon is none that a grid can have.
    #[error("`{0}` is no number of values from 2 on")]
    Count(String),
    /// A value of a list has a colon, which stands behind the ends of a range alone.
    #[error("`{0}` is no value: a number of values stands behind the two ends of a range")]
    Colon(String),
    /// An end is no number with a unit.
    #[error("the end `{0}` of a range is no number with a unit")]
    End(String),
    /// The ends have different dimensions, or one counts turns and the other radians.
    #[error("the ends of `{text}` differ: {first} and {last}")]
    Ends {
        /// The range.
        text: String,
        /// What the first is.
        first: String,
        /// What the other is.
        last: String,
    },
}

impl Axis {
    /// Reads `NAME=A..B:N`, `NAME=A..B` or `NAME=a,b,c`.
    ///
    /// # Errors
    /// [`AxisError`].
    pub fn parse(text: &str) -> Result<Self, AxisError> {
        let (name, written) = text.split_once('=').ok_or_else(|| AxisError::Form(text.to_owned()))?;
        let (name, written) = (name.trim(), written.trim());
        if name.is_empty() || written.is_empty() {
            return Err(AxisError::Form(text.to_owned()));
        }
        let values = match written.split_once("..") {
            Some((first, rest)) => Values::Range(Range::parse(written, first, rest)?),
            None => {
                let list: Vec<String> = written.split(',').map(|value| value.trim().to_owned()).collect();
                if list.iter().any(String::is_empty) {
                    return Err(AxisError::Empty(written.to_owned()));
                }
                if let Some(value) = list.iter().find(|value| value.contains(':')) {
                    return Err(AxisError::Colon(value.clone()));
                }
                Values::List(list)
            }
        };
        Ok(Self { name: name.to_owned(), written: written.to_owned(), values })
    }

    /// Values that a grid takes of it; none of a range without a number of them.
    pub(super) fn count(&self) -> Option<u64> {
        match &self.values {
            Values::List(list) => Some(list.len() as u64),
            Values::Range(range) => range.count,
        }
    }

    /// A value of a grid, counted from 0.
    pub(super) fn of_grid(&self, at: u64) -> String {
        match &self.values {
            Values::List(list) => list.get(usize::try_from(at).unwrap_or(0)).cloned().unwrap_or_default(),
            Values::Range(range) => range.of_grid(at),
        }
    }

    /// The value at a coordinate from 0 to below 1.
    pub(super) fn at(&self, coordinate: f64) -> String {
        match &self.values {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "below the length")]
            Values::List(list) => {
                let place = (coordinate * list.len() as f64) as usize;
                list.get(place.min(list.len().saturating_sub(1))).cloned().unwrap_or_default()
            }
            Values::Range(range) => range.at(coordinate),
        }
    }

    /// Both ends of a range without a number of values, and their unit.
    pub(crate) fn bounds(&self) -> Option<([f64; 2], &str)> {
        match &self.values {
            Values::Range(range) if range.count.is_none() => Some((range.ends, &range.unit)),
            _ => None,
        }
    }

    /// The values that are written: all of a list, both ends of a range.
    pub fn ends(&self) -> Vec<String> {
        match &self.values {
            Values::List(list) => list.clone(),
            Values::Range(range) => range.ends.iter().map(|end| range.text(*end)).collect(),
        }
    }
}

impl Range {
    /// An end without a unit has that of the other.
    fn parse(written: &str, first: &str, rest: &str) -> Result<Self, AxisError> {
        let (last, count) = match rest.rsplit_once(':') {
            None => (rest, None),
            Some((last, count)) => match count.trim().parse() {
                Ok(count) if count >= 2 => (last, Some(count)),
                _ => return Err(AxisError::Count(count.trim().to_owned())),
            },
        };
        let end = |text: &str| as_number(text).ok_or_else(|| AxisError::End(text.trim().to_owned()));
        let ((a, unit), (b, last_unit)) = (end(first)?, end(last)?);
        let unit = if unit.is_empty() { last_unit.clone() } else { unit };
        if last_unit.is_empty() || last_unit == unit {
            return Ok(Self { ends: [a, b], unit, count });
        }
        let (Some(of_first), Some(of_last)) = (unit_size(&unit), unit_size(&last_unit)) else {
            return Err(AxisError::End(last.trim().to_owned()));
        };
        let both = [of_first, of_last];
        let told = if of_first.dimension != of_last.dimension {
            both.map(|end| end.dimension.description())
        } else if of_first.turning.differs_from(of_last.turning) {
            let units = [&unit, &last_unit];
            std::array::from_fn(|end| format!("{} [{}]", both[end].turning.counted(), units[end]))
        } else {
            return Ok(Self { ends: [a, of_last.to_unit(b, of_first)], unit, count });
        };
        let [first, last] = told;
        Err(AxisError::Ends { text: written.to_owned(), first, last })
    }

    /// Ends are met exactly, and round values between round ends.
    fn of_grid(&self, at: u64) -> String {
        let last = self.count.unwrap_or(2).saturating_sub(1).max(1);
        let [a, b] = self.ends;
        self.text(match at {
            0 => a,
            at if at >= last => b,
            at => rounded((a * (last - at) as f64 + b * at as f64) / last as f64, a.abs().max(b.abs())),
        })
    }

    fn at(&self, coordinate: f64) -> String {
        let [a, b] = self.ends;
        self.text(a + (b - a) * coordinate)
    }

    fn text(&self, value: f64) -> String {
        written(value, &self.unit)
    }
}

/// A value with its unit as one would write it; shortest digits that read back to the same bits.
pub fn written(value: f64, unit: &str) -> String {
    let size = value.abs();
    let plain = value == 0.0 || (1e-5..1e16).contains(&size);
    let number = if plain { value.to_string() } else { format!("{value:e}") };
    format!("{number} {unit}").trim_end().to_owned()
}

/// Without the last digit that a double has beside numbers of this size: 0.1 between 0 and 0.3, and not 0.09999999999999999.
fn rounded(value: f64, size: f64) -> f64 {
    const DIGITS: f64 = 14.0;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and 400")]
    let decimals = (DIGITS - size.log10().floor()).clamp(0.0, 400.0) as usize;
    let text = format!("{value:.decimals$}");
    // A zero has no sign.
    text.parse().map_or(value, |value: f64| value + 0.0)
}

fn as_number(text: &str) -> Option<(f64, String)> {
    let (number, unit) = as_written(text)?;
    number.is_finite().then(|| (number, unit.to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(text: &str) -> Vec<String> {
        let axis = Axis::parse(text).expect("an axis");
        (0..axis.count().expect("a number")).map(|at| axis.of_grid(at)).collect()
    }

    #[test]
    fn ranges_have_both_ends_and_lists_their_values() {
        assert_eq!(grid("speed=5Hz..20Hz:4"), ["5 Hz", "10 Hz", "15 Hz", "20 Hz"]);
        assert_eq!(grid("speed = 5..20 Hz:2"), ["5 Hz", "20 Hz"]);
        assert_eq!(grid("L=1 mm..0.002 m:3"), ["1 mm", "1.5 mm", "2 mm"]);
        // 33 * 1e-6 / 1e-3 is 0.032999999999999995.
        assert_eq!(grid("c0=0.01 mm..33 um:2"), ["0.01 mm", "0.033 mm"]);
        assert_eq!(grid("x=-0.1..0.3:5"), ["-0.1", "0", "0.1", "0.2", "0.3"].map(str::to_owned));
        assert_eq!(grid("k=1e-9..3e-9:3"), ["1e-9", "2e-9", "3e-9"]);
        assert_eq!(grid("c0=5 um, 10 um"), ["5 um", "10 um"]);
    }

    #[test]
    fn what_is_none_is_told() {
        use AxisError::{Count, Empty, End, Form};
        let error = |text: &str| Axis::parse(text).expect_err(text);
        assert_eq!(error("speed"), Form("speed".into()));
        assert_eq!(error("=3"), Form("=3".into()));
        assert_eq!(error("x=1,,2"), Empty("1,,2".into()));
        assert_eq!(error("x=1..2:1"), Count("1".into()));
        assert_eq!(error("x=1..2:many"), Count("many".into()));
        assert_eq!(error("x=a..2:3"), End("a".into()));
        for range in ["speed=1Hz..4rad/s:2", "speed=1Hz..4rad/s"] {
            let told = error(range).to_string();
            assert!(told.contains("differ: turns [Hz] and radians [rad/s]"), "{told}");
        }
        assert_eq!(grid("speed=1Hz..120rpm:2"), ["1 Hz", "2 Hz"]);
        assert!(error("x=1 mm..2 s:3").to_string().contains("a length [m] and a time [s]"));
    }
}
