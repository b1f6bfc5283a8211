//! From arguments to a compiled mechanism, and its warnings to stderr.

use std::fs;

use linkwear_codegen::{Closure, Compiled, Diagnostics, Options, SourceFile, compile};
use serde_json::Value;

use super::failure::{Failure, entries};
use super::{ClosureName, Input};

/// A mechanism that was read and compiled.
pub struct Loaded {
    /// The text of the file.
    pub source: SourceFile,
    /// With overrides and closure as asked.
    pub compiled: Compiled,
    warnings: Diagnostics,
}

/// Reads and compiles; prints warnings.
pub fn load(input: &Input) -> Result<Loaded, Failure> {
    load_as(input, false)
}

/// As [`load`]; `rigid` takes flexible bodies as rigid.
pub fn load_as(input: &Input, rigid: bool) -> Result<Loaded, Failure> {
    let text = fs::read_to_string(&input.file).map_err(|error| Failure::Read(input.file.clone(), error))?;
    let source = SourceFile { name: input.file.display().to_string(), text };
    let closure = input.closure.map(|name| match name {
        ClosureName::Joint => Closure::Joint,
        ClosureName::Log => Closure::Log,
    });
    let options = Options { closure, overrides: input.overrides.clone(), rigid };
    let compiled = compile(&source, &options).map_err(Failure::Mechanism)?;
    let warnings = Diagnostics::from_list(compiled.warnings.clone()).located(&source);
    if !warnings.is_empty() {
        eprintln!("{warnings}");
    }
    Ok(Loaded { source, compiled, warnings })
}

impl Loaded {
    /// Warnings in the shape of the errors of a failure.
    pub fn warnings(&self) -> Vec<Value> {
        entries(&self.warnings)
    }

    /// Names of the overridden parameters that are folded into the code, so that it must be made anew.
    pub fn folded_overrides(&self, input: &Input) -> Vec<String> {
        let parameters = &self.compiled.mechanism.parameters;
        let folded = |name: &str| parameters.iter().any(|known| known.name == name && !known.tunable);
        input.overrides.iter().map(|(name, _)| name).filter(|name| folded(name)).cloned().collect()
    }
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
