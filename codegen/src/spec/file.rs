//! The tables of a mechanism file, as types: the parser and the JSON Schema are both made from them.
//! Every field is optional here; what must be present is said by the resolver, which can explain why.

use linkwear_runtime::contact::Restitution;
use linkwear_runtime::wear::{Area, Measure};
#[cfg(test)]
use schemars::JsonSchema;
use serde::Deserialize;

use super::body::BodySpec;
use super::doc::Doc;
use super::force::ForceSpec;
use super::joint::JointSpec;
use super::point::PointSpec;
use super::start::StartSpec;
use super::texts::{tables, texts_of, without_texts};
use super::written::{At, Name, Quantity, Table, Triple};

/// A mechanism file.
#[derive(Clone, Debug, Default, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(test, schemars(extend("required" = ["spec", "name", "bodies"])))]
pub struct File {
    /// Version of this format: 1.
    pub spec: Option<At<i64>>,
    /// Name of the mechanism, also in generated code.
    pub name: Option<Name>,
    /// What it is, in a sentence.
    pub doc: Option<String>,
    /// Acceleration of free fall in the ground frame.
    pub gravity: Option<Triple>,
    /// How loops are closed: at a joint, or by the logarithm of the gap.
    pub closure: Option<Closure>,
    /// Named quantities.
    pub parameters: Table<Parameter>,
    /// Signals from outside: they may change while the mechanism runs.
    pub inputs: Table<Input>,
    /// Named points at the reference pose.
    pub points: Table<PointSpec>,
    /// Moving bodies.
    pub bodies: Table<BodySpec>,
    /// Joints between bodies or to the ground.
    pub joints: Table<JointSpec>,
    /// Springs, forces and torques.
    pub forces: Table<ForceSpec>,
    /// Guesses of joint coordinates from which assembly starts.
    pub assembly: Table<StartSpec>,
    /// Start values of joint coordinates and speeds that are met exactly.
    pub initial: Table<StartSpec>,
    /// Clearance of revolute and spherical joints, by joint, with the laws of contact.
    pub clearance: Table<ClearanceSpec>,
    /// Wear of joints with clearance, by joint.
    pub wear: Table<WearSpec>,
    /// Groups of points, bodies and joints made several times.
    pub repeat: Table<RepeatSpec>,
    /// What `check` and every run leave unsaid.
    pub check: CheckSpec,
}

tables! {
    /// Warnings that are known and meant.
    pub struct CheckSpec {
        /// Codes of warnings that are not to be given, for instance "W0112".
        pub allow: Option<At<Vec<Name>>>,
    }
}

tables! {
    /// A joint with clearance: the joint's first body is the bearing or socket, its second the journal or ball.
    #[cfg_attr(test, schemars(extend("required" = ["radial", "journal_radius"])))]
    pub struct ClearanceSpec {
        /// Radial clearance: radius of the bearing less that of the journal. May be tunable.
        pub radial: Option<Quantity>,
        /// Radius of the journal or ball.
        pub journal_radius: Option<Quantity>,
        /// Length of the bearing.
        pub length: Option<Quantity>,
        /// Elastic modulus E* of the pair: 1/E* is the sum of (1 - nu^2)/E of both sides.
        pub modulus: Option<Quantity>,
        /// Contact stiffness in SI, a bare number, instead of the one that follows from `modulus` and the radii.
        pub stiffness: Option<Quantity>,
        /// Law of restitution; by default that of Lankarani and Nikravesh.
        pub law: Option<At<Restitution>>,
        /// Coefficient of restitution.
        pub restitution: Option<Quantity>,
        /// Exponent of penetration; 1.5 by default.
        pub exponent: Option<Quantity>,
        /// Least impact speed that damping is related to; 1 mm/s by default.
        pub impact_speed_floor: Option<Quantity>,
        /// Coefficient of friction, at high speed; 0 by default.
        pub friction: Option<Quantity>,
        /// Coefficient of friction at rest (Stribeck); by default that at high speed.
        pub static_friction: Option<Quantity>,
        /// Stribeck speed; 10 mm/s by default.
        pub stribeck_speed: Option<Quantity>,
        /// Growth of the coefficient of friction with sliding speed; 0 by default.
        pub friction_slope: Option<Quantity>,
        /// Sliding speed below which friction is smoothed; 1 mm/s by default. Two speeds: Ambrosio's correction.
        pub friction_speed: Option<At<Vec<Quantity>>>,
        /// Our own assumption.
        pub assumed: bool,
    }
}

tables! {
    /// How a joint with clearance wears, and when it has failed.
    #[cfg_attr(test, schemars(extend("required" = ["coefficient", "hardness", "threshold"])))]
    pub struct WearSpec {
        /// Dimensionless wear coefficient k of Archard's law.
        pub coefficient: Option<Quantity>,
        /// Hardness of the softer side.
        pub hardness: Option<Quantity>,
        /// Area that carries the load; by default that of Hertz.
        pub area: Option<At<Area>>,
        /// Wear depth at which the joint has failed.
        pub threshold: Option<Quantity>,
        /// Growth of the clearance per wear; 1 by default, 0 for no feedback.
        pub feedback: Option<Quantity>,
        /// Feeds the worn profile back to the gap instead of the clearance.
        pub profile: Option<bool>,
        /// Bearing angles of the profile; 72 by default.
        pub bins: Option<At<i64>>,
        /// What of the depth by bearing angle counts as wear; by default the depth by the area.
        pub measure: Option<At<Measure>>,
        /// Revolutions that one cycle stands for; 1 by default.
        pub revolutions_per_cycle: Option<Quantity>,
        /// Limit of mean pressure times sliding speed.
        pub pressure_speed: Option<Quantity>,
        /// Gamma process: shape per mean wear; by default `beta`. Without both the life is its mean.
        pub alpha: Option<Quantity>,
        /// Gamma process: rate; by default `alpha`.
        pub beta: Option<Quantity>,
        /// Our own assumption.
        pub assumed: bool,
    }
}

/// How loops are closed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Closure {
    /// Cut one joint and keep the rows it takes away.
    #[default]
    Joint,
    /// Six rows: the logarithm of the gap between two branches.
    Log,
}

/// A named quantity.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename = "$linkwear::ByForm")]
#[cfg_attr(test, derive(JsonSchema), schemars(rename = "Parameter", untagged))]
pub enum Parameter {
    /// Without marks.
    #[serde(rename = "scalar", alias = "list")]
    Plain(Quantity),
    /// With marks.
    #[serde(rename = "table")]
    Marked(ParameterTable),
}

tables! {
    /// A parameter with its marks.
    #[cfg_attr(test, schemars(extend("required" = ["value"])))]
    pub struct ParameterTable {
        /// Quantity or formula over other parameters.
        pub value: Option<Quantity>,
        /// Stays changeable in the generated code.
        pub tunable: bool,
        /// Our own assumption, not from the cited source.
        pub assumed: bool,
        /// What it is.
        pub doc: Option<Doc>,
    }
}

impl Parameter {
    /// Quantity or formula over other parameters.
    pub fn value(&self) -> Option<&Quantity> {
        match self {
            Self::Plain(value) => Some(value),
            Self::Marked(table) => table.value.as_ref(),
        }
    }

    /// Whether it stays changeable in the generated code, and whether it is our own assumption.
    pub const fn marks(&self) -> (bool, bool) {
        match self {
            Self::Plain(_) => (false, false),
            Self::Marked(table) => (table.tunable, table.assumed),
        }
    }
}

/// A signal from outside: a quantity that it has unless something else is connected.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename = "$linkwear::ByForm")]
#[cfg_attr(test, derive(JsonSchema), schemars(rename = "Input", untagged))]
pub enum Input {
    /// Its default with its unit.
    #[serde(rename = "scalar", alias = "list")]
    Plain(Quantity),
    /// Unit and default apart.
    #[serde(rename = "table")]
    Table(InputTable),
}

tables! {
    /// A signal with unit and default apart.
    pub struct InputTable {
        /// Unit of the default if that is a bare number, and of the same dimension if it is not.
        pub unit: Option<Name>,
        /// Value unless something else is connected; 0 by default.
        pub default: Option<Quantity>,
        /// What it is.
        pub doc: Option<Doc>,
    }
}

tables! {
    /// A group made `count` times; names and texts may contain `{i}`, `{i+1}` and the like.
    #[cfg_attr(test, schemars(extend("required" = ["count"])))]
    pub struct RepeatSpec {
        /// How many cells: a whole number or a formula over parameters.
        pub count: Option<Quantity>,
        /// Name of the index in braces; "i" by default.
        pub index: Option<Name>,
        /// Value of the index in the first cell; 1 by default.
        pub first: Option<At<i64>>,
        /// Points of a cell.
        pub points: Table<PointSpec>,
        /// Bodies of a cell.
        pub bodies: Table<BodySpec>,
        /// Joints of a cell.
        pub joints: Table<JointSpec>,
        /// Forces of a cell.
        pub forces: Table<ForceSpec>,
        /// Guesses of a cell.
        pub assembly: Table<StartSpec>,
        /// Start values of a cell.
        pub initial: Table<StartSpec>,
    }
}

without_texts!(Restitution, Area, Measure);
