//! Values of options that are more than a number or a name. In: the text. Out: the value, or what to write instead.

use clap::builder::{PossibleValuesParser, TypedValueParser};
use linkwear::backend::Backend;
use linkwear::life::Coupling;
use linkwear_gamma::process::{PROCESSES, Process, named};

/// A back end by its name.
pub fn backend() -> impl TypedValueParser<Value = Backend> {
    PossibleValuesParser::new(["auto", "compiled", "interpreter"]).map(|name| match name.as_str() {
        "compiled" => Backend::Compiled,
        "interpreter" => Backend::Interpreter,
        _ => Backend::Auto,
    })
}

/// A coupling by its name.
pub fn coupling() -> impl TypedValueParser<Value = Coupling> {
    PossibleValuesParser::new(["table", "full"])
        .map(|name| if name == "full" { Coupling::Full } else { Coupling::Table })
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

/// A positive number.
pub fn positive(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if value > 0.0 && value.is_finite() => Ok(value),
        _ => Err("a positive number is needed".to_owned()),
    }
}

/// Enough draws for the ends of a 95 % band.
pub fn draw_count(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(count) if (100..=1_000_000).contains(&count) => Ok(count),
        _ => Err("a number from 100 to 1000000 is needed".to_owned()),
    }
}

/// The name of a process that can be fitted.
pub fn process_parser() -> impl TypedValueParser<Value = &'static dyn Process> {
    PossibleValuesParser::new(PROCESSES.map(Process::name))
        .map(|name| named(&name).expect("a name from the list of processes"))
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
    fn lengths_of_runs_are_positive_and_finite() {
        assert_eq!(positive("2.5"), Ok(2.5));
        for bad in ["0", "-1", "nan", "inf", "two"] {
            assert!(positive(bad).is_err(), "{bad}");
        }
    }
}
