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
    /// Where the joints stand at t = 0, by column (`R1.q`, `S2.q0`) [rad, m; 1 for quaternions]; empty where a run would not start.
    #[cfg_attr(test, schemars(with = "Numbers"))]
    pub start: Map<String, Value>,
    /// Joints with clearance, as they were read.
    pub clearances: Vec<ClearanceAnswer<'a>>,
    /// Joints that wear, as they were read.
    pub wear: Vec<WearAnswer<'a>>,
    /// Couplings, as they were read; absent where there are none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub couplings: Vec<CouplingAnswer<'a>>,
    /// End stops, as they were read; absent where there are none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub stops: Vec<StopAnswer<'a>>,
    /// States of the file's own; absent where there are none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub states: Vec<StateAnswer<'a>>,
    /// Sensors; absent where there are none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub sensors: Vec<SensorAnswer<'a>>,
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
    /// Duty cycles of the file; absent where there are none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub missions: Vec<MissionAnswer<'a>>,
    /// Remarks on the file.
    #[cfg_attr(test, schemars(with = "Vec<Remark>"))]
    pub warnings: &'a [Value],
}

/// A coupling: the sum of its terms is its offset.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct CouplingAnswer<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its kind, as in the file.
    pub kind: &'a str,
    /// Coordinates with their factors.
    pub terms: Vec<CoupledAnswer>,
    /// What the sum is; null where that depends on what the file leaves open.
    pub offset: Option<f64>,
    /// Unit of the sum: rad or m.
    pub unit: &'a str,
    /// Whether it holds exactly; else it gives way as a spring.
    pub rigid: bool,
}

/// A coordinate in a coupling.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct CoupledAnswer {
    /// The coordinate, `R1.q`, or `C.q2` of a joint with several.
    pub coordinate: String,
    /// Its factor, in SI.
    pub factor: Option<f64>,
}

/// End stops of a coordinate.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct StopAnswer<'a> {
    /// Its name.
    pub name: &'a str,
    /// The coordinate, `R1.q`, or `C.q2` of a joint with several.
    pub coordinate: String,
    /// Where it is stopped from below; null where it is not.
    pub lower: Option<f64>,
    /// Where it is stopped from above; null where it is not.
    pub upper: Option<f64>,
    /// Unit of the coordinate: rad or m.
    pub unit: &'a str,
    /// Force over depth [N m/rad or N/m].
    pub stiffness: Option<f64>,
    /// What takes energy of an impact: none, damping, restitution (at any speed) or law (made for an impact speed).
    pub loss: &'a str,
}

/// A state of the file's own.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct StateAnswer<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its value at the start.
    pub initial: Option<f64>,
    /// Its unit in SI.
    pub unit: String,
}

/// A sensor.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct SensorAnswer<'a> {
    /// Its name; its column is `NAME.value`.
    pub name: &'a str,
    /// Its unit in SI.
    pub unit: String,
}

/// A duty cycle, as it was read.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct MissionAnswer<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its segments, in the order of the file; of a measured series its bins.
    pub segments: Vec<SegmentAnswer<'a>>,
}

/// A segment of a duty cycle.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct SegmentAnswer<'a> {
    /// Its name.
    pub name: &'a str,
    /// Share of the operating time; null where segments have durations.
    pub share: Option<f64>,
    /// Its duration [s]; null where segments have shares.
    pub duration: Option<f64>,
    /// Parameters and inputs that it sets, in SI.
    #[cfg_attr(test, schemars(with = "Numbers"))]
    pub set: Map<String, Value>,
    /// Factor on the friction of each joint with clearance.
    #[cfg_attr(test, schemars(with = "Numbers"))]
    pub friction: Map<String, Value>,
    /// Factor on the wear coefficient of each joint with clearance.
    #[cfg_attr(test, schemars(with = "Numbers"))]
    pub wear: Map<String, Value>,
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

/// A joint with clearance.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[allow(non_snake_case, reason = "units are written as they are")]
pub struct ClearanceAnswer<'a> {
    /// The joint.
    pub joint: &'a str,
    /// Body with the bearing or socket.
    pub bearing: &'a str,
    /// Body with the journal or ball.
    pub journal: &'a str,
    /// Whether it is a ball in a socket.
    pub ball: bool,
    /// Radial clearance [m]; null where a run would not start.
    pub radial_m: Option<f64>,
    /// Radius of the journal or ball [m].
    pub journal_radius_m: f64,
    /// Length of the bearing [m].
    pub length_m: f64,
    /// Which side touches with both ends of that length, `bearing` or `journal`; null where the journal does not tilt.
    pub ends: Option<&'a str>,
    /// Elastic modulus E* of the pair [Pa].
    pub modulus_Pa: f64,
    /// Stiffness K at this clearance, in F = K p^n [N/m^n]; null as `radial_m`.
    pub stiffness: Option<f64>,
    /// Whether the file gives it; else it follows from the modulus and, as that wears, the clearance.
    pub stiffness_given: bool,
    /// Exponent n.
    pub exponent: f64,
    /// Law of restitution, as in files.
    pub law: &'a str,
    /// Coefficient of restitution.
    pub restitution: f64,
    /// Least impact speed that damping is related to [m/s].
    pub impact_speed_floor_m_per_s: f64,
    /// Friction; null without.
    pub friction: Option<FrictionAnswer>,
}

/// Friction of a joint with clearance.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct FrictionAnswer {
    /// Coefficient at high speed.
    pub coefficient: f64,
    /// Coefficient at rest; null where it is the same.
    pub static_coefficient: Option<f64>,
    /// Speed over which the one goes over into the other [m/s]; null where there is no other.
    pub stribeck_speed_m_per_s: Option<f64>,
    /// Growth of the coefficient with sliding speed [s/m].
    pub slope_s_per_m: f64,
    /// Speed below which friction is smoothed, or the two of Ambrosio's correction [m/s].
    pub friction_speed_m_per_s: Vec<f64>,
}

/// How a joint wears.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[allow(non_snake_case, reason = "units are written as they are")]
pub struct WearAnswer<'a> {
    /// The joint.
    pub joint: &'a str,
    /// Dimensionless wear coefficient k.
    pub coefficient: f64,
    /// Factor on it, as the file writes it; absent if there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub coefficient_factor: Option<String>,
    /// Hardness of the softer side [Pa].
    pub hardness_Pa: f64,
    /// Volume that the journal loses over that of the bush; absent if only the bush wears.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub journal_ratio: Option<f64>,
    /// Wear depth at which the joint has failed [m].
    pub threshold_m: f64,
    /// Area that carries the load, as in files.
    pub area: &'a str,
    /// What counts as wear, as in files; null: the depth by the area, with `profile` the mean.
    pub measure: Option<&'a str>,
    /// Whether the worn profile changes the gap.
    pub profile: bool,
    /// Bearing angles of the profile.
    pub bins: usize,
    /// Growth of the clearance per wear.
    pub feedback: f64,
    /// Revolutions that a cycle stands for.
    pub revolutions_per_cycle: f64,
    /// Limit of mean pressure times sliding speed [Pa m/s]; null without.
    pub pressure_speed_Pa_m_per_s: Option<f64>,
    /// Gamma process: shape per mean wear [1/m]; null without one.
    pub alpha_per_m: Option<f64>,
    /// Its rate [1/m]; null without one.
    pub beta_per_m: Option<f64>,
    /// Coefficient of variation of what the first cycle wears, from which `life` takes alpha and beta; null where the file gives these.
    pub cycle_variation: Option<f64>,
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
