//! The tables of a mechanism file, as types: the parser and the JSON Schema are both made from them.
//! Every field is optional here; what must be present is said by the resolver, which can explain why.

use linkwear_runtime::contact::Restitution;
use linkwear_runtime::wear::{Area, Measure};
#[cfg(test)]
use schemars::JsonSchema;
use serde::Deserialize;

use super::body::BodySpec;
use super::controller::ControllerSpec;
use super::coupling::CouplingSpec;
use super::doc::Doc;
use super::force::ForceSpec;
use super::include::IncludeSpec;
use super::joint::JointSpec;
use super::mission::MissionSpec;
use super::point::PointSpec;
use super::sensor::Sensor;
use super::start::StartSpec;
use super::state::StateSpec;
use super::stop::StopSpec;
use super::table::TableSpec;
use super::texts::{tables, texts_of, without_texts};
use super::word::Word;
use super::written::{At, Name, Quantity, Table, Triple};

/// A mechanism file.
#[derive(Clone, Debug, Default, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(test, schemars(extend("required" = ["spec", "name"])))]
pub struct File {
    /// Version of this format: 1.
    /// [1; required; e.g. 1]
    #[cfg_attr(test, schemars(extend("const" = 1)))]
    pub spec: Option<At<i64>>,
    /// Name of the mechanism, also in generated code.
    /// [text; letters, digits and _; required; e.g. "four_bar"]
    pub name: Option<Name>,
    /// What it is, in a sentence.
    /// [text; e.g. "A crank-rocker"]
    pub doc: Option<String>,
    /// Acceleration of free fall in the ground frame.
    /// [m/s^2; default zero, with a warning; e.g. [0, 0, "-9.81 m/s^2"]]
    pub gravity: Option<Triple>,
    /// How loops are closed: at a joint, or by the logarithm of the gap.
    /// [word; default "joint"; e.g. "log"]
    pub closure: Option<Closure>,
    /// Named quantities.
    /// [table]
    pub parameters: Table<Parameter>,
    /// Signals from outside: they may change while the mechanism runs.
    /// [table]
    pub inputs: Table<Input>,
    /// Named points at the reference pose.
    /// [table]
    pub points: Table<PointSpec>,
    /// Moving bodies; those of included files count.
    /// [table; at least one]
    pub bodies: Table<BodySpec>,
    /// Joints between bodies or to the ground.
    /// [table]
    pub joints: Table<JointSpec>,
    /// Gears, belts and other relations between joint coordinates.
    /// [table]
    pub couplings: Table<CouplingSpec>,
    /// End stops of joint coordinates.
    /// [table]
    pub stops: Table<StopSpec>,
    /// Springs, forces and torques.
    /// [table]
    pub forces: Table<ForceSpec>,
    /// Quantities with a rate by formula, integrated along with the motion.
    /// [table]
    pub states: Table<StateSpec>,
    /// Formulas with a name and a column of their own.
    /// [table]
    pub sensors: Table<Sensor>,
    /// Controllers, continuous or at sampled times.
    /// [table]
    pub controllers: Table<ControllerSpec>,
    /// Guesses of joint coordinates from which assembly starts.
    /// [table]
    pub assembly: Table<StartSpec>,
    /// Start values of joint coordinates and speeds that are met exactly.
    /// [table]
    pub initial: Table<StartSpec>,
    /// Clearance of joints, by joint, with the laws of contact.
    /// [table]
    pub clearance: Table<ClearanceSpec>,
    /// Wear of joints with clearance, by joint.
    /// [table]
    pub wear: Table<WearSpec>,
    /// Duty cycles: how the machine is used while it wears.
    /// [table]
    pub missions: Table<MissionSpec>,
    /// Functions given by rows, which formulas call by their names.
    /// [table]
    pub tables: Table<TableSpec>,
    /// Groups of points, bodies and joints made several times.
    /// [table]
    pub repeat: Table<RepeatSpec>,
    /// Mechanism files as parts of this one.
    /// [table]
    pub include: Table<IncludeSpec>,
    /// What `check` and every run leave unsaid.
    /// [table]
    pub check: CheckSpec,
}

tables! {
    /// Warnings that are known and meant.
    pub struct CheckSpec {
        /// Codes of warnings that are not to be given, for instance "W0112".
        /// [list of codes; warnings only; default none; e.g. ["W0112"]]
        pub allow: Option<At<Vec<Name>>>,
    }
}

tables! {
    /// A joint with clearance: the joint's first body is the bearing or socket, its second the journal or ball.
    #[cfg_attr(test, schemars(extend("required" = ["radial", "journal_radius"])))]
    pub struct ClearanceSpec {
        /// Radial clearance: radius of the bearing less that of the journal. May be tunable.
        /// [m; above 0, below the journal's radius; required; e.g. "20 um"]
        pub radial: Option<Quantity>,
        /// Radius of the journal or ball.
        /// [m; above 0; required; e.g. "10 mm"]
        pub journal_radius: Option<Quantity>,
        /// Length of the bearing.
        /// [m; above 0; required, of a ball twice its radius; e.g. "20 mm"]
        pub length: Option<Quantity>,
        /// The journal may tilt in its bearing, and touches with the two ends of `length`.
        /// [true or false; revolute, prismatic, cylindrical; default true of those that slide, else false; e.g. true]
        pub tilt: Option<At<bool>>,
        /// Which side has the ends of `length`; the other side is longer.
        /// [word; required of joints that slide and tilt; default of a revolute "bearing"; e.g. "journal"]
        pub ends: Option<At<Ends>>,
        /// Elastic modulus E* of the pair: 1/E* is the sum of (1 - nu^2)/E of both sides.
        /// [Pa; above 0; required; e.g. "115 GPa"]
        pub modulus: Option<Quantity>,
        /// Contact stiffness in SI, a bare number, instead of the one that follows from `modulus` and the radii.
        /// [1; above 0; default from modulus and radii; e.g. 5e9]
        pub stiffness: Option<Quantity>,
        /// Law of restitution.
        /// [word; default "lankarani_nikravesh"; e.g. "exact"]
        pub law: Option<At<Word<Restitution>>>,
        /// Coefficient of restitution.
        /// [1; above 0, up to 1; default 1; e.g. 0.9]
        pub restitution: Option<Quantity>,
        /// Exponent of penetration.
        /// [1; from 1; default 1.5; e.g. 1.5]
        pub exponent: Option<Quantity>,
        /// Least impact speed that damping is related to.
        /// [m/s; above 0; default 1 mm/s; e.g. "1 mm/s"]
        pub impact_speed_floor: Option<Quantity>,
        /// Coefficient of friction, at high speed.
        /// [1; from 0; default none; e.g. 0.05]
        pub friction: Option<Quantity>,
        /// Coefficient of friction at rest (Stribeck).
        /// [1; from 0; default that at high speed; e.g. 0.08]
        pub static_friction: Option<Quantity>,
        /// Stribeck speed, beside `static_friction`.
        /// [m/s; above 0; default 10 mm/s; e.g. "10 mm/s"]
        pub stribeck_speed: Option<Quantity>,
        /// Growth of the coefficient of friction with sliding speed.
        /// [s/m; any; default 0; e.g. "-0.1 s/m"]
        pub friction_slope: Option<Quantity>,
        /// Sliding speed below which friction is smoothed. Two speeds: Ambrosio's correction.
        /// [m/s; above 0, one or two; default 1 mm/s; e.g. ["1 mm/s"]]
        #[cfg_attr(test, schemars(extend("minItems" = 1, "maxItems" = 2)))]
        pub friction_speed: Option<At<Vec<Quantity>>>,
        /// Our own assumption.
        /// [mark]
        pub assumed: bool,
    }
}

tables! {
    /// How a joint with clearance wears, and when it has failed.
    #[cfg_attr(test, schemars(extend("required" = ["coefficient", "hardness", "threshold"])))]
    pub struct WearSpec {
        /// Dimensionless wear coefficient k of Archard's law.
        /// [1; above 0; required; e.g. 1e-8]
        pub coefficient: Option<Quantity>,
        /// Factor on `coefficient`, over `pressure`, `sliding_speed`, parameters, inputs and tables.
        /// [1; from 0; default 1; e.g. "1 + (pressure/20 MPa)^2"]
        pub coefficient_factor: Option<Quantity>,
        /// Hardness of the softer side: a pressure, or a number of Brinell, Vickers or Rockwell such as "120 HB", "400 HV", "58 HRC".
        /// [Pa; above 0; required; e.g. "3.5 GPa"]
        pub hardness: Option<Quantity>,
        /// Hardness of the bush over that of the journal: the journal wears too, so much of what the bush loses.
        /// [1; above 0; default none; e.g. 0.25]
        pub hardness_ratio: Option<Quantity>,
        /// Hardness of the journal, written as that of the softer side, in place of `hardness_ratio`: the journal wears too.
        /// [Pa; above 0; default none; e.g. "7 GPa"]
        pub journal_hardness: Option<Quantity>,
        /// Wear coefficient of the journal: the journal wears too.
        /// [1; above 0; default `coefficient`; e.g. 1e-8]
        pub journal_coefficient: Option<Quantity>,
        /// Area that carries the load.
        /// [word; default "hertz"; e.g. "conformal"]
        pub area: Option<At<Word<Area>>>,
        /// Wear depth at which the joint has failed.
        /// [m; above 0; required; e.g. "80 um"]
        pub threshold: Option<Quantity>,
        /// Growth of the clearance per wear; 0 for no feedback.
        /// [1; from 0; default 1; e.g. 1]
        pub feedback: Option<Quantity>,
        /// Feeds the worn profile back to the gap instead of the clearance.
        /// [true or false; default false; e.g. true]
        pub profile: Option<bool>,
        /// Bearing angles of the profile.
        /// [1; 8 to 10000; default 72; e.g. 144]
        pub bins: Option<At<i64>>,
        /// What of the depth by bearing angle counts as wear.
        /// [word; default the depth by the area, with `profile` "mean"; e.g. "maximum"]
        pub measure: Option<At<Word<Measure>>>,
        /// Revolutions that one cycle stands for.
        /// [1; above 0; default 1; e.g. 1e6]
        pub revolutions_per_cycle: Option<Quantity>,
        /// Limit of mean pressure times sliding speed.
        /// [Pa m/s; above 0; default none; e.g. "1 MPa m/s"]
        pub pressure_speed: Option<Quantity>,
        /// Gamma process: shape per mean wear. Without both the life is its mean.
        /// [1/m; above 0; default `beta`; e.g. "13.65 1/um"]
        pub alpha: Option<Quantity>,
        /// Gamma process: rate.
        /// [1/m; above 0; default `alpha`; e.g. "13.65 1/um"]
        pub beta: Option<Quantity>,
        /// Coefficient of variation of what the first cycle wears, from which `alpha` and `beta` follow: instead of them.
        /// [1; above 0; default none; e.g. "20 %"]
        pub cycle_variation: Option<Quantity>,
        /// Our own assumption.
        /// [mark]
        pub assumed: bool,
    }
}

/// Quantities of the cells of a group.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename = "$linkwear::ByForm")]
#[cfg_attr(test, derive(JsonSchema), schemars(rename = "CellValues", untagged))]
pub enum CellValues {
    /// One text for all, with the index in braces.
    #[serde(rename = "scalar", alias = "table")]
    Shared(Quantity),
    /// One for each cell.
    #[serde(rename = "list")]
    Each(At<Vec<Quantity>>),
}

/// Which of two sides that lie in each other is the shorter one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Ends {
    /// The bearing, a bush on a long rod: the joint's first body.
    Bearing,
    /// The journal, a piston in a long bore: the joint's second body.
    Journal,
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
        /// [any unit; required; e.g. "120 mm"]
        pub value: Option<Quantity>,
        /// Stays changeable in the generated code.
        /// [true or false; default false; e.g. true]
        pub tunable: bool,
        /// Our own assumption, not from the cited source.
        /// [mark]
        pub assumed: bool,
        /// What it is.
        /// [text]
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
    #[cfg_attr(test, schemars(extend("anyOf" = [{ "required": ["unit"] }, { "required": ["default"] }])))]
    pub struct InputTable {
        /// Unit of the default if that is a bare number, and of the same dimension if it is not.
        /// [text; default that of `default`; e.g. "N m"]
        pub unit: Option<Name>,
        /// Value unless something else is connected.
        /// [any unit; default 0; e.g. "2 N m"]
        pub default: Option<Quantity>,
        /// What it is.
        /// [text]
        pub doc: Option<Doc>,
    }
}

tables! {
    /// A group made `count` times; names and texts may contain `{i}`, `{i+1}` and the like.
    #[cfg_attr(test, schemars(extend("required" = ["count"])))]
    pub struct RepeatSpec {
        /// How many cells: a whole number or a formula over parameters.
        /// [1; 1 to 10000; required; e.g. "N"]
        pub count: Option<Quantity>,
        /// Name of the index in braces.
        /// [name; default "i"; e.g. "k"]
        pub index: Option<Name>,
        /// Value of the index in the first cell.
        /// [1; whole; default 1; e.g. 0]
        pub first: Option<At<i64>>,
        /// Quantities that differ from cell to cell: one for each cell, or a formula with braces. `{name}` stands for that of the cell.
        /// [table of quantities or lists; any; default none; e.g. { L = ["80 mm", "60 mm", "45 mm"] }]
        pub values: Table<CellValues>,
        /// Points of a cell.
        /// [table]
        pub points: Table<PointSpec>,
        /// Bodies of a cell.
        /// [table]
        pub bodies: Table<BodySpec>,
        /// Joints of a cell.
        /// [table]
        pub joints: Table<JointSpec>,
        /// Couplings of a cell.
        /// [table]
        pub couplings: Table<CouplingSpec>,
        /// End stops of a cell.
        /// [table]
        pub stops: Table<StopSpec>,
        /// Forces of a cell.
        /// [table]
        pub forces: Table<ForceSpec>,
        /// States of a cell.
        /// [table]
        pub states: Table<StateSpec>,
        /// Sensors of a cell; each may use those above it and those of the cells before.
        /// [table]
        pub sensors: Table<Sensor>,
        /// Controllers of a cell; they act behind those of the file, cell by cell.
        /// [table]
        pub controllers: Table<ControllerSpec>,
        /// Guesses of a cell.
        /// [table]
        pub assembly: Table<StartSpec>,
        /// Start values of a cell.
        /// [table]
        pub initial: Table<StartSpec>,
    }
}

without_texts!(Ends);

texts_of! {
    enum Parameter { Plain, Marked }
    enum Input { Plain, Table }
    enum CellValues { Shared, Each }
}
