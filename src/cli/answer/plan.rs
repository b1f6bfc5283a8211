//! `plan --format json`.

#[cfg(test)]
use schemars::JsonSchema;
use serde::Serialize;

use super::common::Ends;

/// When to replace a part, when to look at it, and how many spares to keep. Times are in the unit of the lives (of a fit: of its
/// exposure, divided by `--rate`; of a life: cycles), costs in the currency they were given in.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct PlanAnswer {
    /// What it rests on: `fit`, `lives`.
    pub from: &'static str,
    /// Parts are replaced when they fail.
    pub at_failure: AtFailureAnswer,
    /// Parts are replaced at an age, or at failure if that comes first.
    pub by_age: ByAgeAnswer,
    /// Parts are looked at; null without `--inspection`.
    pub by_looks: Option<ByLooksAnswer>,
    /// What one look at a part in use is worth; null without `--look-at`.
    pub look: Option<LookAnswer>,
    /// Spares of a fleet; null without `--parts`.
    pub spares: Option<SparesAnswer>,
    /// What is doubtful.
    pub warnings: Vec<String>,
}

/// Parts are replaced when they fail.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct AtFailureAnswer {
    /// Cost per unit of time in the long run [cost/time].
    pub cost_rate: f64,
    /// What the fit leaves open of it, 95 % [cost/time]; null where parameters are taken as known, and of lives.
    pub cost_rate_band: Option<Ends>,
}

/// Parts are replaced at an age, or at failure if that comes first.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct ByAgeAnswer {
    /// The age of least cost [time]; null if waiting for failure costs least.
    pub age: Option<f64>,
    /// What the fit leaves open of that age, 95 % [time], an end null where waiting for failure may cost least; null where parameters
    /// are taken as known, and of lives.
    pub age_band: Option<Ends>,
    /// How probable it is, by what the fit leaves open, that replacement at some age costs less than waiting; null likewise.
    pub pays: Option<f64>,
    /// Cost per unit of time in the long run [cost/time].
    pub cost_rate: f64,
    /// What the fit leaves open of the cost at this very age, 95 % [cost/time]; null likewise.
    pub cost_rate_band: Option<Ends>,
    /// Share of parts that fail before.
    pub fail: f64,
    /// Mean time in use of a part [time].
    pub mean_use: f64,
}

/// Parts are looked at in even intervals, and replaced from a wear on; of lives, when a look finds that they have failed.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct ByLooksAnswer {
    /// How a failure is noticed: `at once`, or `at a look` with `--downtime`.
    pub failures: &'static str,
    /// Time from look to look [time].
    pub interval: f64,
    /// What the fit leaves open of the interval of least cost, 95 % [time]; null where it is given, where parameters are taken as known,
    /// and of lives.
    pub interval_band: Option<Ends>,
    /// Wear from which a part is replaced [unit of wear]; null of lives, where a look finds what has failed.
    pub threshold: Option<f64>,
    /// What the fit leaves open of the threshold of least cost, 95 % [unit of wear]; null likewise.
    pub threshold_band: Option<Ends>,
    /// The look at which a part is replaced that still works, of lives; null where that is never, and of fits.
    pub last_look: Option<usize>,
    /// Cost per unit of time in the long run [cost/time].
    pub cost_rate: f64,
    /// What the fit leaves open of the cost at this very interval and threshold, 95 % [cost/time]; null where parameters are taken as
    /// known.
    pub cost_rate_band: Option<Ends>,
    /// Share of parts that fail.
    pub fail: f64,
    /// Looks at a part, mean.
    pub looks: f64,
    /// Mean length of a cycle from new part to new part [time].
    pub cycle: f64,
    /// Mean time that a cycle has with a failure nobody has noticed [time].
    pub unnoticed: f64,
}

/// What one look at the part in use is worth.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct LookAnswer {
    /// When, from now [time].
    pub at: f64,
    /// The most that it may cost [cost].
    pub value: f64,
    /// Expected cost of the part in use without it, less what the time it lasts saves [cost].
    pub without: f64,
    /// The same with it, before its own cost [cost].
    pub with: f64,
    /// When the part is replaced without it, from now [time]; null if at failure only.
    pub replace_after: Option<f64>,
    /// Probability that the part fails before.
    pub fails_before: f64,
    /// Probability that the look has it replaced at once.
    pub replaced_at_once: f64,
}

/// Spares of a fleet of parts that are all new at the start.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct SparesAnswer {
    /// Parts in use.
    pub parts: usize,
    /// Time planned for [time].
    pub horizon: f64,
    /// Probability asked for that the spares are enough.
    pub confidence: f64,
    /// If parts are replaced when they fail.
    pub at_failure: CountAnswer,
    /// If they are replaced at the age of least cost; null where that is never.
    pub by_age: Option<CountAnswer>,
}

/// Replacements within the time.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct CountAnswer {
    /// Expected number.
    pub mean: f64,
    /// Spares that are enough.
    pub needed: usize,
    /// Probability that they are.
    pub enough: f64,
}
