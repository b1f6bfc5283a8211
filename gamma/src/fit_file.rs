//! A fit as its file has it. In: a fit and the names of its data, or the text of a file. Out: JSON, an [`Estimate`] at given
//! covariates, or what is wrong with the file, where, and what to do. Never knows how parameters are estimated, nor paths.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};
use thiserror::Error;

use crate::data::Observations;
use crate::fit::Fit;
use crate::life::{Estimate, LifeError, Sample};
use crate::process::{PROCESSES, Process, named};

/// How far parameters may be from the maximum of the increments beside them: digits lost in print, no other fit.
const SAME_MAXIMUM: f64 = 1e-3;

/// How far printed standard errors may be from the root of the variance beside them.
const SAME: f64 = 0.01;

const WRITE_ONE: &str = "give the file that `linkwear fit DATA.csv .. --out FIT.json` writes";

/// A fitted process: what a prediction needs, in the units of the data.
#[derive(Clone, Debug, PartialEq)]
pub struct FitFile {
    /// The process.
    pub process: &'static dyn Process,
    /// Its parameters, in the order of [`Process::parameters`].
    pub parameters: [f64; 2],
    /// Exponent c of Lambda = exposure^c, when it was estimated; none: Lambda is the exposure as given.
    pub exponent: Option<f64>,
    /// Covariates that multiply Lambda, each as value^b.
    pub covariates: Vec<Covariate>,
    /// Covariance of (the two parameters, [exponent], [b of each covariate]): square, symmetric; empty if unknown.
    pub covariance: Vec<Vec<f64>>,
    /// Log-likelihood at the estimate, of the wear increments in the units given; NaN if the file has none.
    pub log_likelihood: f64,
    /// Number of increments.
    pub n: usize,
    /// Number of units (specimens).
    pub units: usize,
    /// What wear is counted in, as the data call it.
    pub wear_unit: String,
    /// What exposure or Lambda is counted in, as the data call it.
    pub exposure_unit: String,
    /// Whether it was fitted over Lambda (true) or over an exposure as it is; none: the file does not say.
    pub over_lambda: Option<bool>,
    /// Increments it was made from: exposure before, exposure after, wear; empty in files that do not hold them.
    pub increments: Vec<[f64; 3]>,
    /// Step of the gauge they were read with, if they are taken as rounded.
    pub resolution: Option<f64>,
    /// Standard deviation of the gauge's error before rounding, if there is one.
    pub gauge: Option<f64>,
    /// The text it was read from.
    text: String,
}

/// Increments as the file has them.
#[derive(Serialize, Deserialize)]
struct Columns {
    from: Vec<f64>,
    to: Vec<f64>,
    wear: Vec<f64>,
}

/// A covariate of a fit.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Covariate {
    /// Its name in the data.
    pub name: String,
    /// Its power b.
    pub coefficient: f64,
}

/// What is wrong with a fit's file, or with what it is asked for.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("{message}")]
pub struct FitFileError {
    /// Line of the file, from 1, where there is one to blame.
    pub line: Option<usize>,
    /// The cause.
    pub message: String,
    /// What to do.
    pub cure: String,
}

impl FitFile {
    /// Of a fit: names of its covariates, what wear and exposure are counted in, whether exposure is Lambda already.
    pub fn new(
        fit: &Fit,
        observations: &Observations,
        covariates: &[String],
        (wear, exposure): (&str, &str),
        over_lambda: bool,
    ) -> Self {
        let found = fit.parameters();
        let covariate = |(name, b): (&String, &f64)| Covariate { name: name.clone(), coefficient: *b };
        Self {
            process: fit.model.process,
            parameters: [found[0], found[1]],
            exponent: fit.exponent(),
            covariates: covariates.iter().zip(fit.powers()).map(covariate).collect(),
            covariance: fit.covariance(),
            log_likelihood: fit.log_likelihood,
            n: fit.increments,
            units: observations.units.len(),
            wear_unit: wear.to_owned(),
            exposure_unit: exposure.to_owned(),
            over_lambda: Some(over_lambda),
            increments: observations.increments.iter().map(|one| [one.from, one.to, one.wear]).collect(),
            resolution: fit.model.resolution.map(|rounding| rounding.step),
            gauge: fit.model.resolution.map(|rounding| rounding.error).filter(|error| *error > 0.0),
            text: String::new(),
        }
    }

    /// Names of the process's parameters, `exponent`, `power of` each covariate: those that were estimated, in the order of
    /// the covariance.
    pub fn names(&self) -> Vec<String> {
        let mut names: Vec<String> = self.process.parameters().map(str::to_owned).to_vec();
        names.extend(self.exponent.map(|_| "exponent".to_owned()));
        names.extend(self.covariates.iter().map(|covariate| format!("power of {}", covariate.name)));
        names
    }

    /// As the file has it.
    pub fn to_json(&self) -> Value {
        let mut file = Map::new();
        file.insert("process".into(), json!(self.process.name()));
        for (name, value) in self.process.parameters().into_iter().zip(self.parameters) {
            file.insert(name.into(), json!(value));
        }
        let column = |at: usize| self.increments.iter().map(|one| one[at]).collect();
        let more = json!({
            "exponent": self.exponent,
            "covariates": self.covariates,
            "covariance": self.covariance,
            "log_likelihood": self.log_likelihood,
            "n": self.n,
            "units": self.units,
            "wear_unit": self.wear_unit,
            "exposure_unit": self.exposure_unit,
            "over_lambda": self.over_lambda,
            "resolution": self.resolution,
            "gauge": self.gauge,
            "increments": Columns { from: column(0), to: column(1), wear: column(2) },
        });
        file.extend(more.as_object().cloned().unwrap_or_default());
        Value::Object(file)
    }

    /// Reads `process` (the Gamma process, if it is not there), its parameters, perhaps `exponent`, `covariates` and the
    /// `covariance` of these, in this order and not of their logarithms.
    ///
    /// # Errors
    /// [`FitFileError`].
    pub fn parse(text: &str) -> Result<Self, FitFileError> {
        let value: Value = serde_json::from_str(text).map_err(|error| FitFileError {
            line: Some(error.line()),
            message: format!("not JSON: {error}"),
            cure: WRITE_ONE.to_owned(),
        })?;
        let reader = Reader { text, value: &value };
        let process = reader.process()?;
        let [first, second] = process.parameters().map(|name| reader.positive(name));
        let text_of = |key: &str| value.get(key).and_then(Value::as_str).unwrap_or_default().to_owned();
        let count = |key: &str| value.get(key).and_then(Value::as_u64).unwrap_or(0) as usize;
        Ok(Self {
            process,
            parameters: [first?, second?],
            exponent: reader.given("exponent").map(|_| reader.positive("exponent")).transpose()?,
            covariates: reader.covariates()?,
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

    /// What a reader of the answer has to know about the fit.
    pub fn warning(&self) -> Option<&'static str> {
        let known = "the fit has no `covariance`: its parameters are taken as known, bands have no width";
        self.covariance.is_empty().then_some(known)
    }

    /// The process where the covariates have these values, one for each: Lambda times the values to the powers b is the
    /// process with other parameters; the uncertainty of the powers goes over to them to first order.
    ///
    /// # Errors
    /// [`FitFileError`] for values that are missing, unknown or not positive, and for a covariance that is none.
    pub fn estimate(&self, values: &[(String, f64)]) -> Result<Estimate, FitFileError> {
        let wrong = |error: LifeError| self.fault("covariance", &error.to_string(), WRITE_ONE);
        let (all, kept) = (self.names().len(), self.names().len() - self.covariates.len());
        let sized = self.covariance.len() == all && self.covariance.iter().all(|row| row.len() == all);
        if !(self.covariance.is_empty() || sized) {
            let message = format!("`covariance` is not one of {all} parameters");
            return Err(self.fault("covariance", &message, WRITE_ONE));
        }
        let ln_values: Vec<f64> = self.in_order(values)?.into_iter().map(libm::log).collect();
        let powers = self.covariates.iter().map(|covariate| covariate.coefficient);
        let ln_factor: f64 = powers.zip(&ln_values).map(|(power, ln)| power * ln).sum();
        let scales = self.process.exposure_powers();
        let factors = scales.map(|scale| libm::exp(scale * ln_factor));
        let parameters = [self.parameters[0] * factors[0], self.parameters[1] * factors[1]];
        let estimate = Estimate::new(self.process, parameters, self.exponent).map_err(wrong)?;
        let estimate = estimate.with_sample(self.sample()?);
        if self.covariance.is_empty() {
            return Ok(estimate);
        }
        // Derivatives of the parameters kept by all of them.
        let mut slopes = vec![vec![0.0; all]; kept];
        for (at, row) in slopes.iter_mut().enumerate() {
            row[at] = factors.get(at).copied().unwrap_or(1.0);
            let through = if at < 2 { scales[at] * parameters[at] } else { 0.0 };
            for (slope, ln) in row[kept..].iter_mut().zip(&ln_values) {
                *slope = through * ln;
            }
        }
        let entry = |i: usize, j: usize| -> f64 {
            let of_row = |k: usize| -> f64 { (0..all).map(|l| self.covariance[k][l] * slopes[j][l]).sum() };
            (0..all).map(|k| slopes[i][k] * of_row(k)).sum()
        };
        let covariance: Vec<Vec<f64>> = (0..kept).map(|i| (0..kept).map(|j| entry(i, j)).collect()).collect();
        estimate.with_covariance(&covariance).map_err(wrong)
    }

    fn sample(&self) -> Result<Sample, FitFileError> {
        if self.increments.is_empty() {
            return Ok(Sample::Unknown);
        }
        if self.resolution.is_some() || !self.covariates.is_empty() {
            return Ok(Sample::Indirect { increments: self.increments.len() });
        }
        if self.exponent.is_none() {
            let exposures: Vec<f64> = self.increments.iter().map(|[from, to, _]| to - from).collect();
            let wears: Vec<f64> = self.increments.iter().map(|[.., wear]| *wear).collect();
            let maximum = self.process.maximum(&exposures, &wears);
            let same = |(log, own): (&f64, &f64)| (libm::exp(*log) / own - 1.0).abs() < SAME_MAXIMUM;
            if !maximum.is_some_and(|logs| logs.iter().zip(&self.parameters).all(same)) {
                let message = "`increments` are not those that the parameters were estimated from";
                return Err(self.fault("increments", message, WRITE_ONE));
            }
        }
        Ok(Sample::Increments(self.increments.clone()))
    }

    /// Values in the order of the fit's covariates.
    fn in_order(&self, values: &[(String, f64)]) -> Result<Vec<f64>, FitFileError> {
        let fault = |message: String, cure: &str| Err(self.fault("covariates", &message, cure));
        let names: Vec<&str> = self.covariates.iter().map(|covariate| covariate.name.as_str()).collect();
        for (at, (name, value)) in values.iter().enumerate() {
            if values[..at].iter().any(|(before, _)| before == name) {
                return fault(format!("covariate `{name}` is given twice"), "give one");
            }
            if !names.contains(&name.as_str()) {
                let cure = match names.is_empty() {
                    true => "it has none: give no value (leave --covariate out)".to_owned(),
                    false => format!("its covariates are: `{}`", names.join("`, `")),
                };
                return fault(format!("the fit has no covariate `{name}`"), &cure);
            }
            if !(value.is_finite() && *value > 0.0) {
                return fault(format!("covariate `{name}` is {value}"), "give a positive, finite number");
            }
        }
        let mut ordered = Vec::new();
        for name in names {
            let Some((_, value)) = values.iter().find(|(given, _)| given == name) else {
                let cure = format!("add --covariate {name}=VALUE, in the unit of the fit's data");
                return fault(
                    format!("the fit has a covariate `{name}`, and no value of it is given"),
                    &cure,
                );
            };
            ordered.push(*value);
        }
        Ok(ordered)
    }

    /// The fit does not do for what is asked; with the line where the key stands, if it does.
    pub fn fault(&self, key: &str, message: &str, cure: &str) -> FitFileError {
        fault(&self.text, key, message, cure)
    }
}

fn fault(text: &str, key: &str, message: &str, cure: &str) -> FitFileError {
    let quoted = format!("\"{key}\"");
    let line = text.lines().position(|line| line.contains(&quoted)).map(|at| at + 1);
    FitFileError { line, message: message.to_owned(), cure: cure.to_owned() }
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

    fn increments(&self) -> Result<Vec<[f64; 3]>, FitFileError> {
        let Some(given) = self.given("increments") else { return Ok(Vec::new()) };
        let wrong = |what: &str| self.wrong("increments", &format!("`increments` {what}"));
        let columns: Columns = serde_json::from_value(given.clone())
            .map_err(|error| wrong(&format!("are no columns `from`, `to`, `wear`: {error}")))?;
        let Columns { from, to, wear } = columns;
        if from.len() != to.len() || from.len() != wear.len() {
            return Err(wrong("have columns of different lengths"));
        }
        let rows: Vec<[f64; 3]> =
            from.into_iter().zip(to).zip(wear).map(|((from, to), wear)| [from, to, wear]).collect();
        let rises =
            |[from, to, wear]: &[f64; 3]| *from >= 0.0 && from < to && to.is_finite() && wear.is_finite();
        match rows.iter().position(|row| !rises(row)) {
            Some(at) => {
                Err(wrong(&format!("have no rising, finite exposure or no finite wear in row {}", at + 1)))
            }
            None => Ok(rows),
        }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::{Gauge, Reading};
    use crate::fit::{Model, estimate};

    /// Two loads, ten units each, wear 1.5 times as fast at the second load, and some scatter.
    fn readings(unit_of_load: f64) -> Vec<Reading> {
        let scatter =
            |unit: usize, step: usize| 1.0 + 0.3 * (((7 * unit + 5 * step) % 11) as f64 / 5.0 - 1.0);
        let mut readings = Vec::new();
        for unit in 0..20 {
            let (load, pace) = if unit % 2 == 0 { (2.0, 1.0) } else { (5.0, 1.5) };
            let mut wear = 0.0;
            for step in 0..6 {
                readings.push(Reading {
                    unit: unit.to_string(),
                    exposure: step as f64,
                    wear,
                    covariates: vec![load / unit_of_load],
                    row: readings.len() + 2,
                });
                wear += pace * scatter(unit, step);
            }
        }
        readings
    }

    fn fitted(process: &'static dyn Process, unit_of_load: f64) -> FitFile {
        let data = Observations::new(&readings(unit_of_load), false, Gauge::Exact).expect("growing wear");
        let model = Model { process, covariates: 1, ..Model::default() };
        let fit = estimate(&data, &model).expect("a maximum");
        FitFile::new(&fit, &data, &["load".to_owned()], ("um", "h"), false)
    }

    fn at(file: &FitFile, load: f64) -> Estimate {
        file.estimate(&[("load".to_owned(), load)]).expect("one value")
    }

    #[test]
    fn a_fit_at_a_load_does_not_depend_on_the_unit_of_the_load() {
        for process in PROCESSES {
            // With the load counted in units of 3, a load of 3 is 1: there the parameters and their covariance hold.
            let (plain, scaled) = (at(&fitted(process, 1.0), 3.0), fitted(process, 3.0));
            let one = at(&scaled, 1.0);
            for k in 0..2 {
                let (a, b) = (plain.parameters()[k], one.parameters()[k]);
                assert!((a / b - 1.0).abs() < 1e-9, "{process:?}: {a} {b}");
                assert!((b / scaled.parameters[k] - 1.0).abs() < 1e-14);
            }
            for gradient in [[1.0, 0.0], [0.0, 1.0], [1.0, 1.0]] {
                let (a, b) = (plain.variance(&gradient), one.variance(&gradient));
                // Both maxima are found to 1e-10; the change of variables is linear in the logarithms, so exact.
                assert!((a / b - 1.0).abs() < 1e-7, "{process:?}: {a} {b}");
            }
        }
    }

    #[test]
    fn values_that_do_not_match_the_covariates_are_refused() {
        let text = r#"{ "alpha": 2.0, "beta": 1.0, "covariates": [{ "name": "load", "coefficient": 0.5 }] }"#;
        let fit = FitFile::parse(text).expect("a fit");
        assert!((at(&fit, 4.0).parameters()[0] - 4.0).abs() < 1e-14);
        let load = |value: f64| ("load".to_owned(), value);
        let cases = [
            vec![],
            vec![load(1.0), load(2.0)],
            vec![load(-1.0)],
            vec![load(f64::NAN)],
            vec![("mass".to_owned(), 1.0)],
        ];
        for values in cases {
            let error = fit.estimate(&values).expect_err("no match");
            assert!(error.line == Some(1) && !error.cure.is_empty(), "{values:?}: {error}");
        }
        let wrong = FitFile { covariance: vec![vec![1.0]], ..fit };
        assert!(wrong.estimate(&[load(1.0)]).is_err());
    }

    #[test]
    fn a_fit_survives_its_file_bit_for_bit() {
        for process in PROCESSES {
            let file = fitted(process, 1.0);
            let read = FitFile::parse(&file.to_json().to_string()).expect("what was written");
            assert_eq!(FitFile { text: String::new(), ..read }, file);
        }
        let error =
            FitFile::parse("{\n\"process\": \"levy\", \"alpha\": 1, \"beta\": 1 }").expect_err("unknown");
        assert!(
            error.line == Some(2) && error.message.contains("gamma, wiener, inverse-gaussian"),
            "{error}"
        );
    }
}
