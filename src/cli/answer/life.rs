//! `life --format json`, `merge --format json` and life.json.

use linkwear_gamma::life::{Contribution, ErrorBudget, WithError};
use linkwear_runtime::life::{CycleJoint, CycleRecord};
use serde::Serialize;
use serde_json::{Map, Value};
#[cfg(test)]
use {
    super::common::{Numbers, Remark},
    super::measured::CycleColumns,
    schemars::JsonSchema,
};

use super::common::{Ends, Quantiles};
use crate::life::{HOUR, YEAR};
use crate::wear_measure::WearMeasure;

/// A life of joints that wear, to the failure threshold.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct LifeAnswer<'a> {
    /// Name of the mechanism.
    pub name: &'a str,
    /// What ran the equations: `compiled`, `native` or `interpreter`. They agree in every bit.
    pub backend: &'a str,
    /// Source of the wear per revolution: `table`, or `full`, the dynamics at every wear step.
    pub coupling: &'static str,
    /// Mean life [cycles]; that of the mean path where there are no random lives.
    pub mean: f64,
    /// Standard deviation of the lives [cycles]; 0 without random lives.
    pub std: f64,
    /// Coefficient of variation of the lives; 0 without random lives.
    pub cov: f64,
    /// Quantiles of the lives [cycles]; the mean path's life without random lives.
    pub quantiles: Quantiles<f64>,
    /// Mean life in whole cycles, the last one counted in full [cycles].
    pub mean_whole_cycles: f64,
    /// Number of lives, 1 for the mean path alone.
    pub trajectories: u64,
    /// Whether there are random lives.
    pub random: bool,
    /// Seed of the random numbers.
    pub seed: u64,
    /// The life in which every increment is its mean.
    pub mean_path: MeanPathAnswer,
    /// Joint that fails first on the mean path.
    pub failed_joint: &'a str,
    /// Revolutions that a cycle stands for, of that joint.
    pub revolutions_per_cycle: f64,
    /// Mean life in revolutions.
    pub revolutions: f64,
    /// Gamma process of each joint; null where there is none.
    pub parameters: Option<Vec<ProcessAnswer<'a>>>,
    /// Coefficient of variation of the wear-rate factor that all joints of a life share; null without one.
    pub shared_factor: Option<f64>,
    /// Largest error of the table of wear per revolution, relative; null without a table.
    pub table_error: Option<f64>,
    /// Wear at which each joint has failed [m].
    #[cfg_attr(test, schemars(with = "Numbers"))]
    pub thresholds_m: Map<String, Value>,
    /// Measurements of a revolution.
    pub measurements: u64,
    /// Cycles of the mean path.
    pub cycles: Vec<CycleAnswer>,
    /// Measure of wear of each joint that wears.
    pub wear_measures: &'a [WearMeasure],
    /// Bushes and journals after the last cycle of the mean path, where journals wear too; absent else.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub worn: Vec<WornAnswer<'a>>,
    /// Remarks on the file and on the life.
    #[cfg_attr(test, schemars(with = "Vec<Remark>"))]
    pub warnings: Vec<Value>,
    /// The same in time, where a revolution has one length.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time: Option<TimeAnswer>,
    /// The duty cycle by which the machine was used; absent without one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mission: Option<MissionAnswer<'a>>,
    #[serde(flatten)]
    pub scatter: Option<ScatterAnswer>,
    /// How far off the mean may be.
    pub error_budget: HalfWidths,
}

/// A joint whose bush and journal are worn.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[allow(non_snake_case, reason = "units are written as they are")]
pub struct WornAnswer<'a> {
    /// The joint.
    pub joint: &'a str,
    /// Angles in the frame of bush and journal alike [rad].
    pub angle_rad: Vec<f64>,
    /// Depth of the bush there [m]; null where it is not kept by angle.
    pub bush_m: Option<&'a [f64]>,
    /// Depth of the journal there [m].
    pub journal_m: &'a [f64],
}

/// The life in which every increment is its mean.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct MeanPathAnswer {
    /// Its length, the last cycle in part [cycles].
    pub cycles: f64,
    /// Its length, the last cycle counted in full [cycles].
    pub whole_cycles: u64,
    /// Error by steps of wear, a bound [cycles].
    pub step_error: f64,
}

/// Gamma process of a joint.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct ProcessAnswer<'a> {
    /// The joint.
    pub joint: &'a str,
    /// Shape per mean wear [1/um].
    pub alpha_per_um: f64,
    /// Rate [1/um].
    pub beta_per_um: f64,
    /// Where it is from: `file`, the mechanism's, or the file of a fit.
    pub from: &'a str,
    /// Coefficient of variation of what the first cycle wears, where the file gives that instead of the parameters.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cycle_variation: Option<f64>,
}

/// A cycle of the mean path.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct CycleAnswer {
    /// Which, from 1.
    pub cycle: u64,
    /// Largest wear of a joint over its threshold, at the end of the cycle: 1 or more is failure.
    pub used: f64,
    /// Each joint that wears.
    pub joints: Vec<CycleJointAnswer>,
}

/// A joint in a cycle.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct CycleJointAnswer {
    /// The joint.
    pub joint: String,
    #[serde(flatten)]
    #[cfg_attr(test, schemars(with = "CycleColumns"))]
    pub numbers: Map<String, Value>,
}

/// Lives in time.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct TimeAnswer {
    /// Length of a cycle [s].
    pub seconds_per_cycle: f64,
    /// Mean life.
    pub mean: Duration,
    /// Standard deviation of the lives.
    pub std: Duration,
    /// Quantiles of the lives.
    pub quantiles: Quantiles<Duration>,
}

/// A time without a pause.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct Duration {
    /// In hours [h].
    pub hours: f64,
    /// In years of 365.25 days.
    pub years: f64,
}

/// A duty cycle and what it makes of a life.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct MissionAnswer<'a> {
    /// Its name.
    pub name: &'a str,
    /// Length of a mission [s]; null where segments have shares.
    pub seconds: Option<f64>,
    /// Mean life in missions; null where segments have shares.
    pub missions: Option<f64>,
    /// Length of a revolution on average [s]; null where they last differently.
    pub seconds_per_revolution: Option<f64>,
    /// By how much of itself the mean path's life is another in half as many bins; null unless segments are bins of a series, and where half as many bins have no life.
    pub binning_error: Option<f64>,
    /// Its segments, in the order of the file.
    pub segments: Vec<SegmentAnswer<'a>>,
}

/// A segment of a duty cycle.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct SegmentAnswer<'a> {
    /// Its name.
    pub name: &'a str,
    /// Share of the operating time.
    pub time_share: f64,
    /// Share of the revolutions.
    pub revolution_share: f64,
    /// Parameters and inputs that it sets, in SI.
    #[cfg_attr(test, schemars(with = "Numbers"))]
    pub set: Map<String, Value>,
    /// Its duration [s]; null where segments have shares.
    pub duration: Option<f64>,
    /// Length of a revolution [s]; null where they last differently.
    pub seconds_per_revolution: Option<f64>,
    /// Share of the wear of each joint, along the mean path.
    #[cfg_attr(test, schemars(with = "Numbers"))]
    pub wear_shares: Map<String, Value>,
    /// The mean path's life if the machine ran in this segment only; null where the mission's life does not tell it: with
    /// `profile = true`, and where another joint would fail first, further on than that life has gone.
    pub alone: Option<AloneAnswer<'a>>,
}

/// A life in one segment of a duty cycle only.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct AloneAnswer<'a> {
    /// Joint that fails first.
    pub failed_joint: &'a str,
    /// Its length [cycles].
    pub cycles: f64,
    /// Its length in revolutions.
    pub revolutions: f64,
    /// Its length in time; null where revolutions last differently.
    pub time: Option<Duration>,
}

/// What random lives tell; absent without them.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct ScatterAnswer {
    /// Standard errors, by the finite number of lives.
    pub standard_errors: StandardErrors,
    /// Intervals that hold the true value with 95 %, by the finite number of lives.
    pub intervals95: Intervals,
    /// Largest relative error of quantiles and spread where lives are counted in bins.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bin_error: Option<f64>,
    /// Part of the lives that is longer, from before the first failure to after the last.
    pub reliability: Vec<LongerAnswer>,
    /// Part of the lives that ends in each cycle, or in each group of equally many where there are many.
    pub histogram: Vec<EndedAnswer>,
    /// Wear of the random lives at whole cycles, as they were lived: of the first 1000 of them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wear_spread: Option<WearSpreadAnswer>,
    /// Part of the lives in which each joint is the first to fail.
    #[cfg_attr(test, schemars(with = "Numbers"))]
    pub failed_first: Map<String, Value>,
}

/// Standard errors of the lives' statistics.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct StandardErrors {
    /// Of the mean [cycles].
    pub mean: f64,
    /// Of the standard deviation [cycles]; null for two lives, which do not tell it.
    pub std: Option<f64>,
    /// The coefficient of variation with its own.
    pub cov: Measured,
    /// Of the quantiles [cycles]; null for too few lives.
    pub quantiles: Quantiles<Option<f64>>,
}

/// A value with its standard error.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct Measured {
    /// The value.
    pub value: f64,
    /// Its standard error; null for two lives, which do not tell it.
    pub standard_error: Option<f64>,
}

/// Intervals of the lives' statistics.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct Intervals {
    /// Of the mean [cycles].
    pub mean: Ends,
    /// Of the standard deviation [cycles].
    pub std: Ends,
    /// Of the quantiles [cycles]; null for too few lives.
    pub quantiles: Quantiles<Option<Ends>>,
}

/// Part of the lives that is longer.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct LongerAnswer {
    /// Than so many cycles [cycles].
    pub cycles: f64,
    /// The part, 0 to 1.
    pub reliability: f64,
    /// Its standard error.
    pub standard_error: f64,
}

/// Part of the lives that ends in some cycles.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct EndedAnswer {
    /// After so many whole cycles [cycles].
    pub from: f64,
    /// And not after more than so many [cycles].
    pub to: f64,
    /// The part, 0 to 1.
    pub part: f64,
}

/// How wear scatters along the lives, what is worn being fed back in each of them.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct WearSpreadAnswer {
    /// Number of lives, those of the lowest numbers.
    pub lives: u64,
    /// Whole cycles, evenly spaced, until all lives have ended.
    pub cycles: Vec<SpreadAnswer>,
}

/// Wear of lives after a cycle. A life that has ended keeps the wear that it ended with.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct SpreadAnswer {
    /// Which, from 1.
    pub cycle: u64,
    /// Part of the lives that have ended by then, 0 to 1.
    pub ended: f64,
    /// Each joint that wears.
    pub joints: Vec<JointSpreadAnswer>,
}

/// A joint of lives after a cycle.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct JointSpreadAnswer {
    /// The joint.
    pub joint: String,
    /// Quantiles of its wear W [m].
    pub wear_m: Quantiles<f64>,
    /// Quantiles of its clearance [m]; absent where a worn profile is fed back, which no one number holds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clearance_m: Option<Quantiles<f64>>,
}

/// Half-widths at 95 % of the mean life.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct HalfWidths {
    /// By source [cycles]; 0 for one that does not arise, null for one of unknown size.
    pub half_widths_95: Sources<f64>,
    /// Of all together [cycles]; null if one is unknown.
    pub total: Option<f64>,
}

/// Something of each source of error.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct Sources<T> {
    /// The finite number of lives.
    pub monte_carlo: Option<T>,
    /// The table of wear per revolution, or the steps of wear.
    pub table: Option<T>,
    /// Revolutions that had not settled when they were measured.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub settling: Option<Option<T>>,
    /// The finite number of revolutions whose mean was taken.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub averaging: Option<Option<T>>,
    /// The uncertainty of estimated parameters.
    pub parameters: Option<T>,
}

impl<T> Sources<T> {
    /// Something of each that arises.
    pub fn of(budget: &ErrorBudget, of: impl Fn(Contribution) -> T) -> Self {
        let ErrorBudget { monte_carlo, table, settling, averaging, parameters } = *budget;
        Self {
            monte_carlo: Some(of(monte_carlo)),
            table: Some(of(table)),
            settling: settling.map(|part| Some(of(part))),
            averaging: averaging.map(|part| Some(of(part))),
            parameters: Some(of(parameters)),
        }
    }
}

impl Duration {
    /// Of so many seconds.
    pub fn of(seconds: f64) -> Self {
        Self { hours: seconds / HOUR, years: seconds / YEAR }
    }
}

/// An error that the lives tell.
pub fn known(error: f64) -> Option<f64> {
    (!error.is_nan()).then_some(error)
}

impl From<WithError> for Measured {
    fn from(found: WithError) -> Self {
        Self { value: found.value, standard_error: known(found.error) }
    }
}

impl CycleAnswer {
    /// A cycle; names are of the joints.
    pub fn new(names: &[String], cycle: &CycleRecord) -> Self {
        let joint = |(name, joint): (&String, &CycleJoint)| {
            let numbers = CycleJoint::columns().map(|column| column.key());
            CycleJointAnswer {
                joint: name.clone(),
                numbers: numbers.zip(joint.values().map(Value::from)).collect(),
            }
        };
        let joints = names.iter().zip(&cycle.joints).map(joint).collect();
        Self { cycle: cycle.cycle, used: cycle.used, joints }
    }
}

/// A part of the random lives.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct ShardAnswer {
    /// Which, from 1.
    pub index: u64,
    /// Of how many.
    pub of: u64,
}
