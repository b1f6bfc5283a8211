//! Reads the result of a fit back. In: FIT.json. Out: an estimate with its covariance, or what is wrong with the file and
//! where. Never knows how parameters are estimated.

use std::fs;
use std::path::Path;

use linkwear_gamma::life::Estimate;
use serde_json::Value;

use super::failure::Failure;

/// How far printed standard errors may be from the root of the variance beside them.
const SAME: f64 = 0.01;

/// An estimate as a file has it.
pub struct FitFile {
    pub estimate: Estimate,
    pub warnings: Vec<String>,
}

/// Reads `alpha`, `beta`, perhaps `exponent`, perhaps `covariance` of these (in this order, not of their logarithms).
pub fn read(file: &Path) -> Result<FitFile, Failure> {
    let text = fs::read_to_string(file).map_err(|error| Failure::Read(file.to_path_buf(), error))?;
    let reader = Reader { file, text: &text };
    let value: Value = serde_json::from_str(&text).map_err(|error| Failure::Data {
        file: file.to_path_buf(),
        line: Some(error.line()),
        message: format!("not JSON: {error}"),
        help: WRITE_ONE.to_owned(),
    })?;
    reader.estimate(&value)
}

const WRITE_ONE: &str = "give the file that `linkwear fit DATA.csv .. --format json` writes";

struct Reader<'a> {
    file: &'a Path,
    text: &'a str,
}

impl Reader<'_> {
    fn estimate(&self, value: &Value) -> Result<FitFile, Failure> {
        let alpha = self.positive(value, "alpha")?;
        let beta = self.positive(value, "beta")?;
        let exponent = match value.get("exponent") {
            None | Some(Value::Null) => None,
            Some(_) => Some(self.positive(value, "exponent")?),
        };
        let wrong = |error: &dyn std::fmt::Display| self.wrong("covariance", &error.to_string());
        let estimate = Estimate::exact(alpha, beta, exponent).map_err(|error| wrong(&error))?;
        let mut warnings = Vec::new();
        let estimate = match value.get("covariance") {
            None | Some(Value::Null) => {
                warnings.push(
                    "the fit has no `covariance`: its parameters are taken as known, bands have no width"
                        .into(),
                );
                estimate
            }
            Some(matrix) => {
                let matrix = self.matrix(matrix)?;
                self.agree(value, &matrix)?;
                estimate.with_covariance(&matrix).map_err(|error| wrong(&error))?
            }
        };
        Ok(FitFile { estimate, warnings })
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

    /// With the line where the key stands, if it does.
    fn wrong(&self, key: &str, message: &str) -> Failure {
        let quoted = format!("\"{key}\"");
        let line = self.text.lines().position(|line| line.contains(&quoted)).map(|at| at + 1);
        Failure::Data {
            file: self.file.to_path_buf(),
            line,
            message: message.to_owned(),
            help: WRITE_ONE.to_owned(),
        }
    }
}
