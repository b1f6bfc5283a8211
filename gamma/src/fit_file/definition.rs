//! A fit as its file has it. In: a fit and the names of its data. Out: JSON. Never knows how it is read.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};

use super::columns::Columns;
use super::error::{FitFileError, fault};
use crate::data::{Increment, Observations};
use crate::fit::{Fit, Heterogeneity, UnitsTest};
use crate::process::Process;

/// A fitted process: what a prediction needs, in the units of the data.
#[derive(Clone, Debug, PartialEq)]
pub struct FitFile {
    /// The process.
    pub process: &'static dyn Process,
    /// Its parameters, in the order of [`Process::parameters`].
    pub parameters: [f64; 2],
    /// Exponent c of Lambda = exposure^c, when it was estimated; none: Lambda is the exposure as given.
    pub exponent: Option<f64>,
    /// Covariates that multiply Lambda, each as value^b; then those that multiply the size of increments.
    pub covariates: Vec<Covariate>,
    /// Coefficient of variation of what differs between units, 0 if no difference was found; none: it was not looked for.
    pub cv: Option<f64>,
    /// The test of no difference, if it was looked for.
    pub units_test: Option<UnitsTest>,
    /// Names of the units and what each had worn at its last reading, if it was looked for; empty if not known.
    pub seen: Vec<(String, f64)>,
    /// Covariance of (the two parameters, [exponent], [b of each covariate], [cv]): square, symmetric; empty if unknown.
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
    /// Increments it was made from; empty in files that do not hold them, and without covariates in files of older programs.
    pub increments: Vec<Increment>,
    /// Step of the gauge they were read with, if they are taken as rounded.
    pub resolution: Option<f64>,
    /// Standard deviation of the gauge's error before rounding, if there is one.
    pub gauge: Option<f64>,
    /// The text it was read from.
    pub(super) text: String,
}

/// A covariate of a fit.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Covariate {
    /// Its name in the data.
    pub name: String,
    /// Its power.
    pub coefficient: f64,
    /// Whether it multiplies the size of increments, and not Lambda.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub of_size: bool,
}

impl FitFile {
    /// The text it was read from; empty for one that was not read.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Of a fit: names of its covariates, those of size last, what wear and exposure are counted in, whether exposure is Lambda already.
    pub fn new(
        fit: &Fit,
        observations: &Observations,
        covariates: &[String],
        (wear, exposure): (&str, &str),
        over_lambda: bool,
    ) -> Self {
        let found = fit.parameters();
        let covariate = |(at, (name, b)): (usize, (&String, &f64))| {
            let of_size = at >= fit.powers().len();
            Covariate { name: name.clone(), coefficient: *b, of_size }
        };
        let powers = fit.powers().iter().chain(fit.size_powers());
        Self {
            process: fit.model.process,
            parameters: [found[0], found[1]],
            exponent: fit.exponent(),
            covariates: covariates.iter().zip(powers).enumerate().map(covariate).collect(),
            cv: fit.cv(),
            units_test: None,
            seen: Vec::new(),
            covariance: fit.covariance(),
            log_likelihood: fit.log_likelihood,
            n: fit.increments,
            units: observations.units.len(),
            wear_unit: wear.to_owned(),
            exposure_unit: exposure.to_owned(),
            over_lambda: Some(over_lambda),
            increments: observations
                .increments
                .iter()
                .map(|one| Increment { row: 0, ..one.clone() })
                .collect(),
            resolution: fit.model.resolution.map(|rounding| rounding.step),
            gauge: fit.model.resolution.map(|rounding| rounding.error).filter(|error| *error > 0.0),
            text: String::new(),
        }
    }

    /// With what was found of differences between units, and the wear of each at its last reading.
    pub fn with_units(self, found: &Heterogeneity, last: &[f64], observations: &Observations) -> Self {
        let seen = observations.units.iter().cloned().zip(last.iter().copied()).collect();
        Self { cv: Some(found.fit.cv().unwrap_or(0.0)), units_test: Some(found.test), seen, ..self }
    }

    /// Whether units differ by this fit.
    pub fn units_differ(&self) -> bool {
        self.cv.is_some_and(|cv| cv > 0.0)
    }

    /// Names of the process's parameters, `exponent`, `power of` each covariate, `size power of` each of size, `cv`: those that were estimated, in the order of
    /// the covariance.
    pub fn names(&self) -> Vec<String> {
        let mut names: Vec<String> = self.process.parameters().map(str::to_owned).to_vec();
        names.extend(self.exponent.map(|_| "exponent".to_owned()));
        names.extend(self.covariates.iter().map(|Covariate { name, of_size, .. }| match of_size {
            false => format!("power of {name}"),
            true => format!("size power of {name}"),
        }));
        names.extend(self.cv.filter(|cv| *cv > 0.0).map(|_| "cv".to_owned()));
        names
    }

    /// As the file has it.
    pub fn to_json(&self) -> Value {
        let mut file = Map::new();
        file.insert("process".into(), json!(self.process.name()));
        for (name, value) in self.process.parameters().into_iter().zip(self.parameters) {
            file.insert(name.into(), json!(value));
        }
        let columns =
            Columns::new(&self.increments, self.covariates.len(), self.has_covariates_of_increments());
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
            "increments": columns,
        });
        file.extend(more.as_object().cloned().unwrap_or_default());
        file.extend(self.units_json());
        Value::Object(file)
    }

    /// What the file says of differences between units: nothing where they were not looked for.
    fn units_json(&self) -> Map<String, Value> {
        let (Some(cv), Some(effect)) = (self.cv, self.process.random_effect()) else { return Map::new() };
        let own = effect.numbers(self.parameters.map(libm::log), cv);
        let (shape, rate) = if cv > 0.0 { (own.shape, own.rate) } else { (None, None) };
        let test = self.units_test.map(|test| {
            json!({ "statistic": test.statistic, "p": test.p_value, "p_asymptotic": test.asymptotic_p })
        });
        let known = json!({
            "random": {
                "parameter": effect.parameter(), "law": effect.law(),
                "shape": shape, "rate": rate, "mean": own.mean, "std": own.std, "cv": cv,
            },
            "boundary": cv == 0.0,
            "lr_test": test,
            "unit_names": self.seen.iter().map(|(name, _)| name).collect::<Vec<_>>(),
            "unit_wear": self.seen.iter().map(|(_, wear)| wear).collect::<Vec<_>>(),
        });
        known.as_object().cloned().unwrap_or_default()
    }

    /// Whether each increment has a value of each covariate.
    pub(super) fn has_covariates_of_increments(&self) -> bool {
        self.increments.iter().all(|one| one.ln_covariates.len() == self.covariates.len())
    }

    /// What a reader of the answer has to know about the fit.
    pub fn warning(&self) -> Option<&'static str> {
        let known = "the fit has no `covariance`: its parameters are taken as known, bands have no width";
        self.covariance.is_empty().then_some(known)
    }

    /// The fit does not do for what is asked; with the line where the key stands, if it does.
    pub fn fault(&self, key: &str, message: &str, cure: &str) -> FitFileError {
        fault(&self.text, key, message, cure)
    }
}
