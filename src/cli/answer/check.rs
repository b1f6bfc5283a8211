//! `check --format json`.

use serde::Serialize;
use serde_json::{Map, Value};
#[cfg(test)]
use {
    super::common::{Numbers, Remark},
    schemars::JsonSchema,
};

use crate::wear_measure::WearMeasure;

/// What a mechanism is, before anything moves.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct CheckAnswer<'a> {
    /// Name of the mechanism.
    pub name: &'a str,
    /// Bodies, the ground not counted.
    pub bodies: usize,
    /// Joints.
    pub joints: usize,
    /// Coordinates before drivers take freedoms away (4 for a quaternion).
    pub coordinates: usize,
    /// Speeds before drivers take freedoms away, those of modes included.
    pub speeds: usize,
    /// Constraint rows before redundant ones are dropped.
    pub constraint_rows: usize,
    /// Rows that are independent in general positions.
    pub independent_rows: usize,
    /// Speeds less independent rows, flexible bodies taken as rigid: the true number of freedoms, before drivers take them away.
    pub mobility: usize,
    /// The Grübler-Kutzbach count, which knows no special geometry.
    pub grubler: i64,
    /// Driven joints.
    pub drivers: &'a [String],
    /// Freedoms that move nothing but the body named.
    pub idle: &'a [String],
    /// Constraint rows that say nothing new.
    pub redundant: Vec<RedundantAnswer<'a>>,
    /// Wrench components (`R1.Fx`) that redundant constraints leave undetermined.
    pub non_unique: &'a [String],
    /// Joints where loops are closed.
    pub cut_joints: Vec<&'a str>,
    /// How the loops close.
    pub assembly: AssemblyAnswer,
    /// Modal coordinates of flexible bodies.
    pub modal_coordinates: usize,
    /// Flexible bodies.
    pub flexible: Vec<FlexibleAnswer<'a>>,
    /// Parameters of the file.
    pub parameters: Vec<ParameterAnswer<'a>>,
    /// Inputs of the file.
    pub inputs: Vec<ParameterAnswer<'a>>,
    /// Measure of wear of each joint that wears.
    pub wear_measures: Vec<WearMeasure>,
    /// Remarks on the file.
    #[cfg_attr(test, schemars(with = "Vec<Remark>"))]
    pub warnings: &'a [Value],
}

/// A constraint row that says nothing new.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct RedundantAnswer<'a> {
    /// The cut joint it belongs to.
    pub joint: &'a str,
    /// What it would forbid.
    pub row: &'a str,
    /// Why it is not needed.
    pub reason: &'a str,
}

/// Ways to close the loops: coordinates (`R2.q`) with their values [rad or m].
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct AssemblyAnswer {
    /// The way that is taken.
    #[cfg_attr(test, schemars(with = "Numbers"))]
    pub taken: Map<String, Value>,
    /// Others that were found; `[assembly]` in the file chooses.
    #[cfg_attr(test, schemars(with = "Vec<Numbers>"))]
    pub others: Vec<Map<String, Value>>,
}

/// Modes of a flexible body.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct FlexibleAnswer<'a> {
    /// The body.
    pub body: &'a str,
    /// Modes that are kept.
    pub modes: Vec<ModeAnswer<'a>>,
    /// What comes next in every family of modes.
    pub left_out: Vec<ModeAnswer<'a>>,
}

/// A mode of a flexible body.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[allow(non_snake_case, reason = "units are written as they are")]
pub struct ModeAnswer<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its frequency [Hz].
    pub frequency_Hz: f64,
}

/// A parameter or an input of the file.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct ParameterAnswer<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its value, or default, in SI.
    pub value: f64,
    /// SI unit in base units (`kg m^-3`); `1` if it has none.
    pub unit: String,
    /// Whether it can be changed without generating again.
    pub tunable: bool,
    /// Whether the file says that the value is assumed.
    pub assumed: bool,
    /// Value and unit as the file has them; null for a formula.
    pub written: Option<String>,
}
