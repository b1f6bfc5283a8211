//! Values of options that are more than a number or a name. In: the text. Out: the value, or what to write instead.

use std::num::NonZero;
use std::path::PathBuf;

use clap::builder::{OsStringValueParser, PossibleValuesParser, TypedValueParser};
use linkwear_codegen::limits::THREADS;
use linkwear_codegen::spec::{Dimension, parse_expression};

use crate::study::Axis;
use linkwear_runtime::Integrator;

/// One of some names, each with what it means.
pub fn one_of<T: Clone + Send + Sync + 'static>(
    choices: impl IntoIterator<Item = (&'static str, T)>,
) -> impl TypedValueParser<Value = T> {
    let choices: Vec<_> = choices.into_iter().collect();
    let names = PossibleValuesParser::new(choices.iter().map(|(name, _)| *name));
    names.try_map(move |given| {
        let chosen = choices.iter().find(|(name, _)| *name == given);
        chosen.map(|(_, meant)| meant.clone()).ok_or("not in the list")
    })
}

/// A path to write to; `-`, which is stdout where rows are written, is none: stdout has the answer.
pub fn output() -> impl TypedValueParser<Value = PathBuf> {
    OsStringValueParser::new().try_map(|name| {
        let cure =
            "stdout has the answer: give a file (`./-` for one of this name) or a stream such as /dev/stdout";
        if name == "-" { Err(cure) } else { Ok(PathBuf::from(name)) }
    })
}

/// A number of threads.
pub fn threads(text: &str) -> Result<NonZero<usize>, String> {
    let most = THREADS.most;
    let count = text.parse().ok().filter(|count: &NonZero<usize>| count.get() <= most);
    count.ok_or_else(|| format!("a whole number from 1 to {most} is needed: {}", THREADS.help))
}

/// A parameter that varies, and over what.
pub fn axis(text: &str) -> Result<Axis, String> {
    Axis::parse(text).map_err(|error| {
        format!("{error}; write NAME=A..B:N, as speed=5Hz..20Hz:4, or NAME=a,b,c, as speed=5Hz,10Hz")
    })
}

/// A parameter that is sought, and between which bounds.
pub fn sought(text: &str) -> Result<Axis, String> {
    let range = "write NAME=LO..HI, as c0=5um..50um";
    let axis = Axis::parse(text).map_err(|error| format!("{error}; {range}"))?;
    match crate::identify::Free::new(&axis) {
        Ok(_) => Ok(axis),
        Err(error) => Err(format!("{error}; {range}")),
    }
}

/// An accuracy that a run may have.
pub fn accuracy(text: &str) -> Result<f64, String> {
    let known = Integrator::TOLERANCES;
    let value = text.trim().parse().ok().filter(|value| known.contains(value));
    value.ok_or_else(|| format!("a number between {:e} and {} is needed", known.start(), known.end()))
}

/// `sobol:N`.
pub fn sample(text: &str) -> Result<u64, String> {
    let count = text.strip_prefix("sobol:").and_then(|count| count.parse().ok());
    count.filter(|count| *count > 0).ok_or_else(|| "write sobol:N, as sobol:64".to_owned())
}

/// `name=value`, both non-empty.
pub fn assignment(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((name, value)) if !name.trim().is_empty() && !value.trim().is_empty() => {
            Ok((name.trim().to_owned(), value.trim().to_owned()))
        }
        _ => Err("write NAME=VALUE, e.g. speed=10Hz or L1=\"120 mm\"".to_owned()),
    }
}

/// `name=value`, the value a positive number.
pub fn covariate(text: &str) -> Result<(String, f64), String> {
    let (name, value) = assignment(text).map_err(|_| "write NAME=VALUE, e.g. load=100".to_owned())?;
    Ok((name, positive(&value)?))
}

/// A number from 0 on.
pub fn from_zero(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if value >= 0.0 && value.is_finite() => Ok(value),
        _ => Err("a number from 0 on is needed, as 1e-6".to_owned()),
    }
}

/// A positive number.
pub fn positive(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if value > 0.0 && value.is_finite() => Ok(value),
        _ => Err("a positive number is needed".to_owned()),
    }
}

/// `D|COL`, as it is written: a positive number for all rows, or the column that has one for each. What reads as a number is one.
pub fn limit(text: &str) -> Result<String, String> {
    if text.trim().parse::<f64>().is_ok() {
        positive(text)?;
    }
    Ok(text.to_owned())
}

/// A density with its unit [kg/m^3].
pub fn density(text: &str) -> Result<f64, String> {
    let found = parse_expression(text, &|_| false).ok().and_then(|read| read.quantity());
    match found {
        Some((value, dimension))
            if dimension == Dimension::of(-3, 1, 0) && value > 0.0 && value.is_finite() =>
        {
            Ok(value)
        }
        _ => Err("write a density with its unit, as \"7850 kg/m^3\" or \"2.7 t/m^3\"".to_owned()),
    }
}

/// Another joint of a machine: its fit, and how far it is worn.
#[derive(Clone, Debug, PartialEq)]
pub struct OtherJoint {
    /// Result of `fit`.
    pub fit: PathBuf,
    /// Wear at failure.
    pub threshold: f64,
    /// Wear now.
    pub current: Option<f64>,
    /// Exposure until now.
    pub at: Option<f64>,
}

/// `FIT.json:W[:W0[:EXPOSURE]]`; a file's name may have colons, numbers have none.
pub fn other_joint(text: &str) -> Result<OtherJoint, String> {
    let wrong =
        || "write FIT.json:W, FIT.json:W:W0 or FIT.json:W:W0:EXPOSURE, as left.json:0.5:0.12:300".to_owned();
    let mut numbers = Vec::new();
    let mut file = text;
    while let Some((before, last)) = file.rsplit_once(':').filter(|_| numbers.len() < 3) {
        let Ok(number) = from_zero(last) else { break };
        numbers.push(number);
        file = before;
    }
    numbers.reverse();
    let threshold = numbers.first().copied().filter(|wear| *wear > 0.0 && !file.is_empty());
    let threshold = threshold.ok_or_else(wrong)?;
    let (current, at) = (numbers.get(1).copied(), numbers.get(2).copied());
    if let Some(wear) = current.filter(|wear| *wear >= threshold) {
        return Err(format!(
            "the present wear {wear} has reached the threshold {threshold}: the joint has failed"
        ));
    }
    Ok(OtherJoint { fit: PathBuf::from(file), threshold, current, at })
}

/// Two numbers, `A..B`, from 0 on and rising.
pub fn range(text: &str) -> Result<[f64; 2], String> {
    let wrong = || "write A..B, two numbers from 0 on, the smaller one first, as 100..250".to_owned();
    let (from, to) = text.split_once("..").ok_or_else(wrong)?;
    let range = [from_zero(from).map_err(|_| wrong())?, from_zero(to).map_err(|_| wrong())?];
    if range[0] < range[1] { Ok(range) } else { Err(wrong()) }
}

/// Two positive numbers, `A..B`, rising.
pub fn positive_range(text: &str) -> Result<[f64; 2], String> {
    let wrong = || "write A..B, two positive numbers, the smaller one first, as 0.5..2".to_owned();
    range(text).ok().filter(|[from, _]| *from > 0.0).ok_or_else(wrong)
}

/// A part of one, as 0.01 or 1%, neither none nor all.
pub fn part(text: &str) -> Result<f64, String> {
    let wrong = || "a part between 0 and 1 is needed, as 0.01 or 1%".to_owned();
    let percent = text.trim().strip_suffix('%').map(str::trim);
    within_one(&percent.map_or_else(|| text.to_owned(), hundredth)).map_err(|_| wrong())
}

/// A hundredth of a number as it is written: a quotient would be rounded once more.
fn hundredth(text: &str) -> String {
    let (digits, power) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
    match power.parse::<i32>() {
        Ok(power) => format!("{digits}e{}", power.saturating_sub(2)),
        Err(_) => text.to_owned(),
    }
}

/// A probability, neither 0 nor 1.
pub fn within_one(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if value > 0.0 && value < 1.0 => Ok(value),
        _ => Err("a number between 0 and 1 is needed, e.g. 0.95".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_assignment_splits_at_the_first_equals_sign() {
        let pair = |a: &str, b: &str| Ok((a.to_owned(), b.to_owned()));
        assert_eq!(assignment("speed = 10 Hz"), pair("speed", "10 Hz"));
        assert_eq!(assignment("a=b=c"), pair("a", "b=c"));
        assert!(assignment("speed").is_err());
        assert!(assignment("=3").is_err());
        assert!(assignment("speed=").is_err());
    }

    #[test]
    fn a_covariate_has_a_name_and_a_positive_number() {
        assert_eq!(covariate("load = 2.5"), Ok(("load".to_owned(), 2.5)));
        for bad in ["load", "load=", "=3", "load=-1", "load=heavy"] {
            assert!(covariate(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn another_joint_is_a_file_and_up_to_three_numbers() {
        let joint =
            |threshold, current, at| OtherJoint { fit: PathBuf::from("a:b.json"), threshold, current, at };
        assert_eq!(other_joint("a:b.json:0.5"), Ok(joint(0.5, None, None)));
        assert_eq!(other_joint("a:b.json:0.5:0"), Ok(joint(0.5, Some(0.0), None)));
        assert_eq!(other_joint("a:b.json:0.5:0.1:30"), Ok(joint(0.5, Some(0.1), Some(30.0))));
        for bad in ["a.json", "a.json:", "a.json:0", "a.json:-1", ":0.5", "a.json:0.5:x", "a.json:0.5:0.5"] {
            assert!(other_joint(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn ranges_rise_and_parts_are_parts() {
        assert_eq!(range("1.5..2"), Ok([1.5, 2.0]));
        for bad in ["1", "2..1", "1..1", "-1..2", "..", "1..nan", "1..inf"] {
            assert!(range(bad).is_err() && positive_range(bad).is_err(), "{bad}");
        }
        assert!(range("0..2").is_ok() && positive_range("0..2").is_err());
        assert_eq!(positive_range("1.5..2"), Ok([1.5, 2.0]));
        for (percent, same) in [
            ("1%", "0.01"),
            // Their quotients by 100 are one step off.
            ("99.99%", "0.9999"),
            (" 0.07 %", "0.0007"),
            ("1.1e1%", "0.11"),
            ("7E-3%", "7e-5"),
        ] {
            assert_eq!(part(percent), Ok(same.parse().unwrap()), "{percent}");
        }
        for bad in ["0", "1", "100%", "0%", "B1", "-1%", "%", "1e%", "1ex%", "1%%", "nan%", "inf%"] {
            assert!(part(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn a_limit_is_a_positive_number_or_a_column() {
        for good in ["0.6", "limit_um"] {
            assert_eq!(limit(good).as_deref(), Ok(good));
        }
        for bad in ["0", "-1", "nan", "inf"] {
            assert!(limit(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn lengths_of_runs_are_positive_and_finite() {
        assert_eq!(positive("2.5"), Ok(2.5));
        for bad in ["0", "-1", "nan", "inf", "two"] {
            assert!(positive(bad).is_err(), "{bad}");
        }
    }
}
