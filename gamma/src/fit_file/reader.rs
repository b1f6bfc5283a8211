//! Reads a fit's file. In: text. Out: a [`FitFile`], or what is wrong with it, where, and what to do. Never knows paths.

use serde_json::Value;

use super::columns::Columns;
use super::definition::{Covariate, FitFile};
use super::error::{FitFileError, WRITE_ONE, fault};
use super::once::Once;
use crate::data::Increment;
use crate::fit::UnitsTest;
use crate::process::{PROCESSES, Process, named};

/// How far printed standard errors may be from the root of the variance beside them.
const SAME: f64 = 0.01;

impl FitFile {
    /// The form of files that is read; one without a number, as people write it by hand, is taken to have it.
    pub const FORMAT: u64 = 1;

    /// Reads `format` (1, if it is not there), `process` (the Gamma process, if it is not there), its parameters, perhaps `exponent`, `covariates` and the
    /// `covariance` of these, in this order and not of their logarithms.
    ///
    /// # Errors
    /// [`FitFileError`].
    pub fn parse(text: &str) -> Result<Self, FitFileError> {
        let Once(value) = serde_json::from_str(text).map_err(|error| FitFileError {
            line: Some(error.line()),
            message: if error.is_data() { error.to_string() } else { format!("not JSON: {error}") },
            cure: WRITE_ONE.to_owned(),
        })?;
        let reader = Reader { text, value: &value };
        reader.check_format()?;
        let process = reader.process()?;
        let [first, second] = process.parameters().map(|name| reader.positive(name));
        let text_of = |key: &str| value.get(key).and_then(Value::as_str).unwrap_or_default().to_owned();
        let count = |key: &str| value.get(key).and_then(Value::as_u64).unwrap_or(0) as usize;
        Ok(Self {
            process,
            parameters: [first?, second?],
            exponent: reader.given("exponent").map(|_| reader.positive("exponent")).transpose()?,
            covariates: reader.covariates()?,
            cv: reader.cv(process)?,
            units_test: reader.units_test(),
            seen: reader.seen()?,
            covariance: reader.covariance(process)?,
            log_likelihood: value.get("log_likelihood").and_then(Value::as_f64).unwrap_or(f64::NAN),
            n: count("n"),
            units: count("units"),
            wear_unit: text_of("wear_unit"),
            exposure_unit: text_of("exposure_unit"),
            over_lambda: value.get("over_lambda").and_then(Value::as_bool),
            increments: reader.increments()?,
            resolution: reader.given("resolution").map(|_| reader.positive("resolution")).transpose()?,
            gauge: reader.given("gauge").map(|_| reader.positive("gauge")).transpose()?,
            text: text.to_owned(),
        })
    }
}

/// A file that is JSON.
struct Reader<'a> {
    text: &'a str,
    value: &'a Value,
}

impl Reader<'_> {
    fn wrong(&self, key: &str, message: &str) -> FitFileError {
        fault(self.text, key, message, WRITE_ONE)
    }

    /// A key that is there and not null.
    fn given(&self, key: &str) -> Option<&Value> {
        self.value.get(key).filter(|value| !value.is_null())
    }

    fn check_format(&self) -> Result<(), FitFileError> {
        match self.given("format") {
            Some(given) if given.as_u64() != Some(FitFile::FORMAT) => {
                let message =
                    format!("`format` is {given}: this program reads fits of format {}", FitFile::FORMAT);
                let cure = "fit the data again by this program, or ask the version that wrote the file";
                Err(fault(self.text, "format", &message, cure))
            }
            _ => Ok(()),
        }
    }

    fn process(&self) -> Result<&'static dyn Process, FitFileError> {
        let Some(given) = self.given("process") else { return Ok(PROCESSES[0]) };
        given.as_str().and_then(named).ok_or_else(|| {
            let names = PROCESSES.map(Process::name).join(", ");
            self.wrong("process", &format!("`process` is {given}: known are {names}"))
        })
    }

    fn positive(&self, key: &str) -> Result<f64, FitFileError> {
        let found = self.value.get(key).ok_or_else(|| self.wrong(key, &format!("`{key}` is missing")))?;
        let number = found.as_f64().filter(|number| *number > 0.0 && number.is_finite());
        number.ok_or_else(|| self.wrong(key, &format!("`{key}` is {found}: a positive number is needed")))
    }

    fn covariates(&self) -> Result<Vec<Covariate>, FitFileError> {
        let Some(list) = self.given("covariates") else { return Ok(Vec::new()) };
        serde_json::from_value(list.clone()).map_err(|error| {
            let message = format!("`covariates` is no list of names and coefficients: {error}");
            self.wrong("covariates", &message)
        })
    }

    fn cv(&self, process: &dyn Process) -> Result<Option<f64>, FitFileError> {
        let Some(random) = self.given("random") else { return Ok(None) };
        if process.random_effect().is_none() {
            return Err(self.wrong("random", "no law is known by which units of this process differ"));
        }
        let cv = random.get("cv").and_then(Value::as_f64).filter(|cv| *cv >= 0.0 && cv.is_finite());
        cv.map(Some).ok_or_else(|| self.wrong("random", "`random` has no `cv`, a number of zero or more"))
    }

    fn units_test(&self) -> Option<UnitsTest> {
        let number = |key: &str| self.given("lr_test")?.get(key)?.as_f64();
        Some(UnitsTest {
            statistic: number("statistic")?,
            p_value: number("p")?,
            asymptotic_p: number("p_asymptotic")?,
        })
    }

    fn seen(&self) -> Result<Vec<(String, f64)>, FitFileError> {
        let list = |key: &str| self.given(key).cloned().unwrap_or_else(|| Value::Array(Vec::new()));
        let names: Option<Vec<String>> = serde_json::from_value(list("unit_names")).ok();
        let wears: Option<Vec<Option<f64>>> = serde_json::from_value(list("unit_wear")).ok();
        match (names, wears) {
            (Some(names), Some(wears)) if names.len() == wears.len() => {
                Ok(names.into_iter().zip(wears.into_iter().map(|wear| wear.unwrap_or(f64::NAN))).collect())
            }
            _ => Err(self.wrong("unit_names", "`unit_names` and `unit_wear` do not belong together")),
        }
    }

    fn increments(&self) -> Result<Vec<Increment>, FitFileError> {
        let Some(given) = self.given("increments") else { return Ok(Vec::new()) };
        let wrong = |what: &str| self.wrong("increments", &format!("`increments` {what}"));
        let columns: Columns = serde_json::from_value(given.clone())
            .map_err(|error| wrong(&format!("are no columns `from`, `to`, `wear`: {error}")))?;
        columns.increments().map_err(|what| wrong(&what))
    }

    /// A matrix of logarithms, or of other parameters, would be taken for this one: standard errors tell.
    fn covariance(&self, process: &dyn Process) -> Result<Vec<Vec<f64>>, FitFileError> {
        let Some(given) = self.given("covariance") else { return Ok(Vec::new()) };
        let matrix: Vec<Vec<f64>> = serde_json::from_value(given.clone()).unwrap_or_default();
        if matrix.is_empty() {
            return Err(self.wrong("covariance", "`covariance` is no list of lists of numbers"));
        }
        for (at, name) in process.parameters().into_iter().enumerate() {
            let key = format!("se_{name}");
            let Some(error) = self.value.get(&key).and_then(Value::as_f64) else { continue };
            let variance = matrix.get(at).and_then(|row| row.get(at)).copied().unwrap_or(f64::NAN);
            let same = (libm::sqrt(variance) - error).abs() <= SAME * error;
            if !same {
                let message = format!("`{key}` is {error}, but the variance in `covariance` is {variance}");
                return Err(self.wrong("covariance", &message));
            }
        }
        Ok(matrix)
    }
}
