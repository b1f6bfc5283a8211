//! `fit --format json`, and the file of `fit --out`.

use serde::Serialize;
use serde_json::{Map, Value};
#[cfg(test)]
use {
    linkwear_gamma::process::{PROCESSES, Process},
    schemars::{JsonSchema, Schema, SchemaGenerator, json_schema},
    serde_json::json,
    std::collections::BTreeMap,
};

/// A fit: of all readings, and of each group where there are groups. Numbers are in the units of the data.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct FitAnswer<'a> {
    #[serde(flatten)]
    pub all: OneFit<'a>,
    #[serde(flatten)]
    pub groups: Option<GroupsAnswer<'a>>,
}

/// Fits of groups; absent without `--groups`.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct GroupsAnswer<'a> {
    /// The fit of each group.
    pub groups: Vec<OneFit<'a>>,
    /// One process for all groups against one for each; null for one group.
    pub group_test: Option<RatioAnswer>,
}

/// A test by the ratio of likelihoods.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct RatioAnswer {
    /// Twice the difference of the log-likelihoods.
    pub statistic: f64,
    /// Degrees of freedom.
    pub degrees: usize,
    /// Probability of so large a statistic if the smaller model is true.
    pub p_value: f64,
}

/// A fit and what is known about it.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct OneFit<'a> {
    #[serde(flatten)]
    #[cfg_attr(test, schemars(with = "FittedProcess"))]
    pub file: Map<String, Value>,
    /// `all`, or the group.
    pub name: &'a str,
    #[serde(flatten)]
    #[cfg_attr(test, schemars(with = "StandardErrors"))]
    pub standard_errors_by_name: Map<String, Value>,
    /// Standard error of the exponent; null where it is not estimated.
    pub se_exponent: Option<f64>,
    /// Standard error of the units' coefficient of variation; null where they are alike.
    pub se_cv: Option<f64>,
    /// Akaike's criterion.
    pub aic: f64,
    /// Bayesian criterion.
    pub bic: f64,
    /// Names of what was estimated, in the order of `standard_errors` and `covariance`.
    pub parameters: Vec<String>,
    /// Standard errors.
    pub standard_errors: Vec<f64>,
    /// Intervals by profile likelihood, lower and upper end, by the name of the parameter: an end is null where the data set none, the
    /// whole is null where it could not be found.
    #[cfg_attr(test, schemars(with = "BTreeMap<String, Option<[Option<f64>; 2]>>"))]
    pub profile_intervals: Map<String, Value>,
    /// The same by the bootstrap; null without.
    #[cfg_attr(test, schemars(with = "Option<BTreeMap<String, Option<[Option<f64>; 2]>>>"))]
    pub bootstrap_intervals: Option<Map<String, Value>>,
    /// The parametric bootstrap.
    pub bootstrap: BootstrapAnswer,
    /// Probability of the intervals.
    pub level: f64,
    /// Bias of the process's two parameters to first order in 1/n; null where theory has none.
    pub first_order_bias: Option<[f64; 2]>,
    /// How well the process fits.
    pub goodness: GoodnessAnswer<'a>,
    /// With `--compare`, the process and the others, all with units alike; `aic` compares them, but for `--resolution`,
    /// which the process at hand alone takes. Empty without.
    pub comparison: Vec<ComparedAnswer>,
    /// With `--compare`, every process with units alike and with units that differ; empty without.
    pub compare: Vec<CriteriaAnswer>,
    /// What is doubtful.
    pub warnings: Vec<String>,
}

/// A fitted process, as `predict` reads it.
#[cfg(test)]
#[derive(JsonSchema)]
#[expect(dead_code, reason = "the fit writes it; here are its keys")]
pub struct FittedProcess {
    /// The process: `gamma`, `inverse-gaussian`, `wiener`.
    process: String,
    #[serde(flatten)]
    parameters: Parameters,
    /// Exponent c of Lambda = exposure^c; null where it is not estimated.
    exponent: Option<f64>,
    /// Covariates, each of which multiplies Lambda as a power; then those that multiply the size of increments.
    covariates: Vec<CovariateAnswer>,
    /// Covariance of what was estimated, row by row.
    covariance: Vec<Vec<f64>>,
    /// Log-likelihood of the increments, in the units of the data.
    log_likelihood: f64,
    /// Number of increments.
    n: usize,
    /// Number of units (specimens).
    units: usize,
    /// What wear is counted in, as the data call it.
    wear_unit: String,
    /// What exposure or Lambda is counted in, as the data call it.
    exposure_unit: String,
    /// Whether it was fitted over Lambda, or over an exposure as it is.
    over_lambda: Option<bool>,
    /// Step of the gauge [unit of wear]; null where readings are taken as exact.
    resolution: Option<f64>,
    /// Standard deviation of the gauge's error before rounding [unit of wear]; null without.
    gauge: Option<f64>,
    /// Increments that it was made from, column by column.
    increments: IncrementsAnswer,
    #[serde(flatten)]
    units_that_differ: Option<UnitsAnswer>,
}

/// How units differ; absent without `--random-effects`.
#[cfg(test)]
#[derive(JsonSchema)]
#[expect(dead_code, reason = "the fit writes it; here are its keys")]
pub struct UnitsAnswer {
    /// The law of the parameter that differs.
    random: RandomAnswer,
    /// Whether no difference was found: the likelihood is largest where all units are alike.
    boundary: bool,
    /// The test of no difference.
    lr_test: UnitsTestAnswer,
    /// Names of the units.
    unit_names: Vec<String>,
    /// Wear of each unit at its last reading, or the level that it was set to after that [unit of wear]; null where it is not known or the part was replaced.
    unit_wear: Vec<Option<f64>>,
}

/// The law of the parameter that differs between units.
#[cfg(test)]
#[derive(JsonSchema)]
#[expect(dead_code, reason = "the fit writes it; here are its keys")]
pub struct RandomAnswer {
    /// The parameter: `beta`, `1 / drift`, `drift`.
    parameter: String,
    /// Its law: `gamma`; `normal`, that of 1 / drift cut off at 0.
    law: String,
    /// Shape of a Gamma law; null of another, or where no difference was found.
    shape: Option<f64>,
    /// Rate of a Gamma law; null of another, or where no difference was found.
    rate: Option<f64>,
    /// Its mean; of a normal law before it is cut off.
    mean: f64,
    /// Its standard deviation, likewise.
    std: f64,
    /// Its coefficient of variation; 0 where no difference was found.
    cv: f64,
}

/// The test of no difference between units by the ratio of likelihoods.
#[cfg(test)]
#[derive(JsonSchema)]
#[expect(dead_code, reason = "the fit writes it; here are its keys")]
pub struct UnitsTestAnswer {
    /// Twice the difference of the log-likelihoods; 0 on the boundary.
    statistic: f64,
    /// Probability of so large a statistic if units do not differ, by its law for so few units and readings.
    p: f64,
    /// The same by its law for many units: half at 0, half chi-square with one degree of freedom.
    p_asymptotic: f64,
}

/// A covariate of a fit.
#[cfg(test)]
#[derive(JsonSchema)]
#[expect(dead_code, reason = "the fit writes it; here are its keys")]
pub struct CovariateAnswer {
    /// Its name in the data.
    name: String,
    /// Its power.
    coefficient: f64,
    /// Whether it multiplies the size of increments, and not Lambda; absent if not.
    #[serde(skip_serializing_if = "Option::is_none")]
    of_size: Option<bool>,
}

/// Increments, column by column.
#[cfg(test)]
#[derive(JsonSchema)]
#[expect(dead_code, reason = "the fit writes it; here are its keys")]
pub struct IncrementsAnswer {
    /// Exposure at the earlier reading [unit of exposure].
    from: Vec<f64>,
    /// Exposure at the later reading [unit of exposure].
    to: Vec<f64>,
    /// Wear between them [unit of wear].
    wear: Vec<f64>,
    /// Which unit (specimen) each is of, from 0.
    unit: Vec<usize>,
    /// Of each covariate its values.
    covariates: Vec<Vec<f64>>,
    /// What is known of each: `exact`, `from-level` (from the level of a reset), `anew` (from a reading after one), `through` (with a
    /// bound on the way), `at-least`, `below`; `entered` and `entered-from-new` are no increments, but limits that wear was below when
    /// the unit entered. Absent where all are exact.
    #[serde(skip_serializing_if = "Option::is_none")]
    known: Option<Vec<String>>,
    /// Exposure of the bound on the way [unit of exposure]; null where there is none; absent where there is none at all.
    #[serde(skip_serializing_if = "Option::is_none")]
    at: Option<Vec<Option<f64>>>,
    /// That bound [unit of wear].
    #[serde(skip_serializing_if = "Option::is_none")]
    below: Option<Vec<Option<f64>>>,
}

/// Parameters of the process that was fitted.
#[cfg(test)]
pub struct Parameters;

#[cfg(test)]
impl JsonSchema for Parameters {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Parameters".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        of_processes("", "Parameter")
    }
}

/// Standard errors of the parameters of the process that was fitted.
#[cfg(test)]
pub struct StandardErrors;

#[cfg(test)]
impl JsonSchema for StandardErrors {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "StandardErrors".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        of_processes("se_", "Standard error of the parameter")
    }
}

/// The same of every parameter of every process: those of the one at hand are there.
#[cfg(test)]
fn of_processes(prefix: &str, what: &str) -> Schema {
    let mut properties = Map::new();
    for name in PROCESSES.into_iter().flat_map(Process::parameters) {
        let known = PROCESSES.into_iter().filter(|process| process.parameters().contains(&name));
        let known: Vec<&str> = known.map(Process::name).collect();
        let description = format!("{what} {name}, where the process has it ({}).", known.join(", "));
        properties.insert(format!("{prefix}{name}"), json!({ "description": description, "type": "number" }));
    }
    json_schema!({ "type": "object", "properties": properties })
}

/// The parametric bootstrap.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct BootstrapAnswer {
    /// Replicates that were asked for; 0: none.
    pub replicates: usize,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Replicates without an estimate; null without bootstrap.
    pub failed: Option<usize>,
}

/// How well the process fits.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct GoodnessAnswer<'a> {
    /// Kolmogorov and Smirnov: the largest distance of the two distribution functions.
    pub kolmogorov_smirnov: f64,
    /// Anderson and Darling's A^2.
    pub anderson_darling: f64,
    /// Probability of so bad a fit of a true process, by the first; null without bootstrap.
    pub p_kolmogorov_smirnov: Option<f64>,
    /// The same by the second.
    pub p_anderson_darling: f64,
    /// Where the probabilities are from: `bootstrap`, or `asymptotic`, for many increments.
    pub p_values_by: &'static str,
    /// Pairs of expected and seen increments [unit of wear].
    pub quantiles: &'a [(f64, f64)],
}

/// A process, with units alike or with units that differ, beside others.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct CriteriaAnswer {
    /// The process: `gamma`, `inverse-gaussian`, `wiener`.
    pub process: &'static str,
    /// Whether units may differ.
    pub random: bool,
    /// Log-likelihood of the increments; null for one that does not fit these data.
    pub log_likelihood: Option<f64>,
    /// Akaike's criterion; null likewise.
    pub aic: Option<f64>,
    /// Bayesian criterion; null likewise.
    pub bic: Option<f64>,
    /// Whether no difference was found; null where units are alike.
    pub boundary: Option<bool>,
    /// True where readings that the gauge rounds are taken as exact: criteria are not to be compared with those of rounded readings.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub exact_readings: bool,
    /// Why it does not fit these data.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub why: Option<String>,
}

/// A process beside others.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct ComparedAnswer {
    /// The process, in words.
    pub process: String,
    /// Log-likelihood of the increments; null for one that does not fit these data.
    pub log_likelihood: Option<f64>,
    /// Akaike's criterion.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub aic: Option<f64>,
    #[serde(flatten)]
    #[cfg_attr(test, schemars(with = "Parameters"))]
    pub parameters: Map<String, Value>,
    /// Exponent and powers of the covariates, where they are estimated.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shape: Option<Vec<f64>>,
    /// True where readings that the gauge rounds are taken as exact: its criterion is not to be compared with that of rounded readings.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub exact_readings: bool,
    /// Why it does not fit these data.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub why: Option<String>,
}
