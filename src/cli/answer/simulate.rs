//! `simulate --format json`.

use linkwear_runtime::wear::ContactMeasure;
use linkwear_runtime::{Column, Peak};
use serde::Serialize;
use serde_json::{Map, Value, json};
#[cfg(test)]
use {super::common::Remark, super::measured::TurnColumns, schemars::JsonSchema};

use crate::study::turn_key;

/// A run.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[allow(non_snake_case, reason = "units are written as they are")]
pub struct SimulateAnswer<'a> {
    /// Name of the mechanism.
    pub name: &'a str,
    /// What ran the equations: `compiled`, `native` or `interpreter`. They agree in every bit.
    pub backend: &'static str,
    /// Time at the end of the run [s].
    pub time_s: f64,
    /// Rows of the table.
    pub samples: usize,
    /// Accepted steps.
    pub steps: u64,
    /// Of these, those by Rodas5P, where steps are taken by it or by Dormand-Prince.
    pub implicit_steps: u64,
    /// Rejected steps.
    pub rejected: u64,
    /// Evaluations of the equations.
    pub evaluations: u64,
    /// Projections onto the constraints.
    pub projections: u64,
    /// Solutions near singular positions, by a decomposition that reveals rank.
    pub rank_revealing_solves: u64,
    /// Newton iterations of implicit steps.
    pub newton_iterations: u64,
    /// Time that the run took here [s].
    pub wall_seconds: f64,
    /// Largest error of a loop's closure along lengths [m].
    pub max_loop_error_m: f64,
    /// Largest error of a loop's closure along angles [rad].
    pub max_loop_error_rad: f64,
    /// Largest difference between the energy and what went in and out [J].
    pub energy_error_J: f64,
    /// Energy that went through drives, dampers and springs [J], beside which the error is to be seen: of drives and forces
    /// what both supply together in a step.
    pub energy_throughput_J: f64,
    /// Largest loads of every joint, at the ends of steps and at 240 places of a turn at least.
    pub peaks: Vec<PeakAnswer<'a>>,
    /// File of the rows; null if none was asked for.
    pub out: Option<String>,
    /// Every joint with clearance in every turn.
    pub turns: Vec<TurnAnswer<'a>>,
    /// Remarks on the file and on the run.
    #[cfg_attr(test, schemars(with = "Vec<Remark>"))]
    pub warnings: Vec<Value>,
}

/// Largest loads of a joint, over all steps.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[allow(non_snake_case, reason = "units are written as they are")]
pub struct PeakAnswer<'a> {
    /// The joint.
    pub joint: &'a str,
    /// Largest force [N].
    pub force_N: f64,
    /// When [s].
    pub force_time_s: f64,
    /// Largest moment [N m].
    pub moment_N_m: f64,
    /// When [s].
    pub moment_time_s: f64,
}

impl<'a> From<&'a Peak> for PeakAnswer<'a> {
    fn from(Peak { joint, force, moment }: &'a Peak) -> Self {
        Self {
            joint,
            force_N: force.value,
            force_time_s: force.t,
            moment_N_m: moment.value,
            moment_time_s: moment.t,
        }
    }
}

/// A joint with clearance in a turn.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct TurnAnswer<'a> {
    /// Which turn, from 1.
    pub turn: usize,
    /// The joint.
    pub joint: &'a str,
    #[serde(flatten)]
    #[cfg_attr(test, schemars(with = "TurnColumns"))]
    measured: Map<String, Value>,
}

impl<'a> TurnAnswer<'a> {
    pub fn new(turn: usize, joint: &'a str, measure: &ContactMeasure) -> Self {
        let entry = |(column, value): &(Column, fn(&ContactMeasure) -> f64)| {
            let value = value(measure);
            // Within a turn losses are counted.
            let number = if column.name == "contact losses" { json!(value as u64) } else { json!(value) };
            (turn_key(column), number)
        };
        let journal = if measure.journal.is_some() { &ContactMeasure::JOURNAL[..] } else { &[] };
        Self { turn, joint, measured: ContactMeasure::COLUMNS.iter().chain(journal).map(entry).collect() }
    }
}
