//! Reads the result of a fit back. In: FIT.json. Out: the fit, an estimate at given covariates, or what is wrong with the
//! file and where. Never knows how parameters are estimated.

use std::fs;
use std::path::{Path, PathBuf};

use linkwear_codegen::diagnostic::nearest;
use linkwear_gamma::fit::{Covariate, Fit};
use linkwear_gamma::life::Estimate;
use serde_json::Value;

use super::failure::Failure;

/// How far printed standard errors may be from the root of the variance beside them.
const SAME: f64 = 0.01;

const WRITE_ONE: &str = "give the file that `linkwear fit DATA.csv .. --out FIT.json` writes";

/// A fit as a file has it.
pub struct FitFile {
    file: PathBuf,
    text: String,
    /// Parameters; an empty covariance where the file has none.
    pub fit: Fit,
    /// Whether it was fitted over Lambda (true) or over an exposure as it is; none: the file does not say.
    pub over_lambda: Option<bool>,
    pub warnings: Vec<String>,
}

/// Reads `alpha`, `beta`, perhaps `exponent`, `covariates`, `covariance` of these (in this order, not of their logarithms).
pub fn read(file: &Path) -> Result<FitFile, Failure> {
    let text = fs::read_to_string(file).map_err(|error| Failure::Read(file.to_path_buf(), error))?;
    let value: Value = serde_json::from_str(&text).map_err(|error| Failure::Data {
        file: file.to_path_buf(),
        line: Some(error.line()),
        message: format!("not JSON: {error}"),
        help: WRITE_ONE.to_owned(),
    })?;
    let over_lambda = value.get("over_lambda").and_then(Value::as_bool);
    let (file, fit) = (file.to_path_buf(), Fit::default());
    let mut own = FitFile { file, text, fit, over_lambda, warnings: Vec::new() };
    own.fit = own.parameters(&value)?;
    if own.fit.covariance.is_empty() {
        own.warnings.push(
            "the fit has no `covariance`: its parameters are taken as known, bands have no width".into(),
        );
    }
    Ok(own)
}

impl FitFile {
    /// The process at values of its covariates, one for each.
    pub fn estimate(&self, values: &[(String, f64)]) -> Result<Estimate, Failure> {
        let fit = self.fit.at(&self.in_order(values)?).map_err(|_| {
            let message = format!("`covariance` is not one of {} parameters", self.fit.parameters());
            self.wrong("covariance", &message)
        })?;
        let wrong = |error: &dyn std::fmt::Display| self.wrong("covariance", &error.to_string());
        let estimate = Estimate::exact(fit.alpha, fit.beta, fit.exponent).map_err(|error| wrong(&error))?;
        if fit.covariance.is_empty() {
            return Ok(estimate);
        }
        estimate.with_covariance(&fit.covariance).map_err(|error| wrong(&error))
    }

    /// Values in the order of the fit's covariates.
    fn in_order(&self, values: &[(String, f64)]) -> Result<Vec<f64>, Failure> {
        let names: Vec<&str> = self.fit.covariates.iter().map(|covariate| covariate.name.as_str()).collect();
        for (at, (name, _)) in values.iter().enumerate() {
            if values[..at].iter().any(|(before, _)| before == name) {
                return Err(self.fault(
                    "covariates",
                    &format!("covariate `{name}` is given twice"),
                    "give one",
                ));
            }
            if !names.contains(&name.as_str()) {
                let help = match nearest(name, names.iter().copied()) {
                    Some(near) => format!("did you mean `{near}`?"),
                    None if names.is_empty() => "it has none: leave --covariate out".to_owned(),
                    None => format!("there are: {}", names.join(", ")),
                };
                return Err(self.fault("covariates", &format!("the fit has no covariate `{name}`"), &help));
            }
        }
        let value = |name: &&str| {
            let found = values.iter().find(|(given, _)| given == name);
            found.map(|(_, value)| *value).ok_or_else(|| {
                let message = format!("the fit has a covariate `{name}`, and no value of it is given");
                let help = format!("add --covariate {name}=VALUE, in the unit of the fit's data");
                self.fault("covariates", &message, &help)
            })
        };
        names.iter().map(value).collect()
    }

    fn parameters(&self, value: &Value) -> Result<Fit, Failure> {
        let (alpha, beta) = (self.positive(value, "alpha")?, self.positive(value, "beta")?);
        let exponent = match value.get("exponent") {
            None | Some(Value::Null) => None,
            Some(_) => Some(self.positive(value, "exponent")?),
        };
        let covariates = match value.get("covariates") {
            None | Some(Value::Null) => Vec::new(),
            Some(list) => serde_json::from_value::<Vec<Covariate>>(list.clone()).map_err(|error| {
                self.wrong(
                    "covariates",
                    &format!("`covariates` is no list of names and coefficients: {error}"),
                )
            })?,
        };
        let covariance = match value.get("covariance") {
            None | Some(Value::Null) => Vec::new(),
            Some(matrix) => {
                let matrix = self.matrix(matrix)?;
                self.agree(value, &matrix)?;
                matrix
            }
        };
        Ok(Fit { alpha, beta, exponent, covariates, covariance, ..Fit::default() })
    }

    fn positive(&self, value: &Value, key: &str) -> Result<f64, Failure> {
        let Some(found) = value.get(key) else {
            return Err(self.wrong(key, &format!("`{key}` is missing")));
        };
        match found.as_f64() {
            Some(number) if number > 0.0 && number.is_finite() => Ok(number),
            _ => Err(self.wrong(key, &format!("`{key}` is {found}: a positive number is needed"))),
        }
    }

    fn matrix(&self, value: &Value) -> Result<Vec<Vec<f64>>, Failure> {
        let row = |row: &Value| row.as_array()?.iter().map(Value::as_f64).collect::<Option<Vec<f64>>>();
        let rows = value.as_array().and_then(|rows| rows.iter().map(row).collect::<Option<Vec<_>>>());
        let rows = rows.filter(|rows| !rows.is_empty());
        rows.ok_or_else(|| self.wrong("covariance", "`covariance` is no list of lists of numbers"))
    }

    /// A matrix of logarithms, or of other parameters, would be taken for this one: standard errors tell.
    fn agree(&self, value: &Value, matrix: &[Vec<f64>]) -> Result<(), Failure> {
        for (at, key) in ["se_alpha", "se_beta"].into_iter().enumerate() {
            let Some(error) = value.get(key).and_then(Value::as_f64) else { continue };
            let variance = matrix.get(at).and_then(|row| row.get(at)).copied().unwrap_or(f64::NAN);
            let same = (variance.sqrt() - error).abs() <= SAME * error;
            if !same {
                let message = format!("`{key}` is {error}, but the variance in `covariance` is {variance}");
                return Err(self.wrong("covariance", &message));
            }
        }
        Ok(())
    }

    /// A file that is no good fit.
    fn wrong(&self, key: &str, message: &str) -> Failure {
        self.fault(key, message, WRITE_ONE)
    }

    /// A fit that does not do for what is asked; with the line where the key stands, if it does.
    pub fn fault(&self, key: &str, message: &str, help: &str) -> Failure {
        let quoted = format!("\"{key}\"");
        let line = self.text.lines().position(|line| line.contains(&quoted)).map(|at| at + 1);
        Failure::Data { file: self.file.clone(), line, message: message.to_owned(), help: help.to_owned() }
    }
}
