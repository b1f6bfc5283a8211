//! The tables of a mechanism file, as types: the parser and the JSON Schema are both made from them.
//! Every field is optional here; what must be present is said by the resolver, which can explain why.

use linkwear_runtime::contact::Restitution;
use linkwear_runtime::wear::{Area, Measure};
use schemars::JsonSchema;
use serde::Deserialize;

use super::written::{At, Name, Pair, PerBody, Quantity, Table, Triple};

/// A mechanism file.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(extend("required" = ["spec", "name", "bodies"]))]
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
    pub closure: Option<ClosureSpec>,
    /// Named quantities.
    pub parameters: Table<Parameter>,
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
}

/// A joint with clearance: the joint's first body is the bearing or socket, its second the journal or ball.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(extend("required" = ["radial", "journal_radius"]))]
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

/// How a joint with clearance wears, and when it has failed.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(extend("required" = ["coefficient", "hardness", "threshold"]))]
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

/// How loops are closed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum ClosureSpec {
    /// Cut one joint and keep the rows it takes away.
    #[default]
    Joint,
    /// Six rows: the logarithm of the gap between two branches.
    Log,
}

/// A parameter with its marks.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(extend("required" = ["value"]))]
pub(super) struct ParameterTable {
    /// Quantity or formula over other parameters.
    pub value: Option<Quantity>,
    /// Stays changeable in the generated code.
    pub tunable: bool,
    /// Our own assumption, not from the cited source.
    pub assumed: bool,
    /// What it is.
    pub doc: Option<String>,
}

/// A named quantity.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Value.
    pub value: Option<Quantity>,
    /// Stays changeable in the generated code.
    pub tunable: bool,
    /// Our own assumption, not from the cited source.
    pub assumed: bool,
}

/// Where a point is.
#[derive(Clone, Debug, Default)]
pub struct PointSpec {
    /// Coordinates, for all or by body.
    pub at: Option<PerBody>,
    /// Coordinates by body, written without `at`.
    pub by_body: Table<Triple>,
    /// Body that carries the point.
    pub on: Option<Name>,
    /// Our own assumption.
    pub assumed: bool,
}

/// A moving body: exactly one of `rod`, `tube`, `box`, or `mass` with `centre`.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(extend("anyOf" = [
    { "required": ["rod"] }, { "required": ["tube"] }, { "required": ["box"] }, { "required": ["centre", "mass"] }
]))]
pub struct BodySpec {
    /// Solid cylinder between two points.
    pub rod: Option<Pair>,
    /// Hollow cylinder between two points.
    pub tube: Option<Pair>,
    /// Cuboid between two points.
    #[serde(rename = "box")]
    pub cuboid: Option<Pair>,
    /// Outer radius of a rod or tube.
    pub radius: Option<Quantity>,
    /// Inner radius of a tube.
    pub inner_radius: Option<Quantity>,
    /// Edge of a square box, or the two edges of a rectangular one.
    pub width: Option<Widths>,
    /// Direction of the first of `width`.
    pub width_axis: Option<Triple>,
    /// Density, instead of `mass`.
    pub density: Option<Quantity>,
    /// Total mass.
    pub mass: Option<Quantity>,
    /// Centre of mass: a point's name or coordinates.
    pub centre: Option<Centre>,
    /// Inertia about the centre: xx, yy, zz or xx, yy, zz, xy, xz, yz.
    pub inertia: Option<At<Vec<Quantity>>>,
    /// Axes of `inertia`: two or three directions at right angles.
    pub axes: Option<At<Vec<Triple>>>,
    /// How the body bends; rigid without.
    pub flexible: Option<At<FlexibleSpec>>,
    /// Our own assumption.
    pub assumed: bool,
    /// What it is.
    pub doc: Option<String>,
}

/// How a body bends: as a beam along its rod, tube or box, or by modal data from a file.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(extend("anyOf" = [{ "required": ["modes", "young"] }, { "required": ["data"] }]))]
pub struct FlexibleSpec {
    /// Number of bending modes kept, the lowest of both planes; 0 makes the body rigid.
    pub modes: Option<Quantity>,
    /// Number of axial modes; with a chord frame the first is the static stretch. 0 by default.
    pub axial: Option<Quantity>,
    /// Number of torsional modes; 0 by default.
    pub torsion: Option<Quantity>,
    /// Young's modulus.
    pub young: Option<Quantity>,
    /// Poisson's ratio; 0.3 by default.
    pub poisson: Option<Quantity>,
    /// Modal damping ratio, for instance 0.01; 0 by default.
    pub damping: Option<Quantity>,
    /// What the bending elements know: "timoshenko" (default), "rayleigh" or "euler_bernoulli".
    pub theory: Option<At<TheorySpec>>,
    /// How the link is held, which decides the modes; by default by the number of joints.
    pub held: Option<At<HeldSpec>>,
    /// 1: linear (default). 2: with foreshortening and geometric stiffness.
    pub order: Option<At<i64>>,
    /// Frequencies to use instead of the computed ones, in the order of the modes.
    pub frequencies: Option<At<Vec<Quantity>>>,
    /// Shear coefficient of the section; by default Cowper's.
    pub shear_coefficient: Option<Quantity>,
    /// The section, instead of that of the rod, tube or box.
    pub section: Option<At<SectionSpec>>,
    /// Pieces with another section, from the first end to the second.
    pub steps: Option<At<Vec<At<StepSpec>>>>,
    /// Concentrated masses.
    pub masses: Option<At<Vec<At<PointMassSpec>>>>,
    /// Places along the link, as shares of its length, whose displacement and stress become columns.
    pub stations: Option<At<Vec<Quantity>>>,
    /// Modal data file, beside this file, instead of a beam.
    pub data: Option<Name>,
    /// Origin of the floating frame of modal data.
    pub origin: Option<Name>,
    /// x and y axis of the floating frame of modal data in the ground frame at the reference pose.
    pub axes: Option<At<Vec<Triple>>>,
}

/// Bending theory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum TheorySpec {
    /// Sections turn with the slope and have no rotary inertia.
    EulerBernoulli,
    /// With rotary inertia.
    Rayleigh,
    /// With rotary inertia and shear.
    #[default]
    Timoshenko,
}

/// How a link is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum HeldSpec {
    /// Frame through both ends, which do not move in it.
    Pinned,
    /// Frame on the first end.
    Clamped,
    /// Frame on the mean axes.
    Free,
    /// Pinned, with the places between where something is attached as further modes.
    CraigBampton,
}

/// A section by its numbers.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(extend("required" = ["area", "Iy", "Iz"]))]
pub struct SectionSpec {
    /// Area.
    pub area: Option<Quantity>,
    /// Second moment of area about y.
    #[serde(rename = "Iy")]
    pub iy: Option<Quantity>,
    /// Second moment of area about z.
    #[serde(rename = "Iz")]
    pub iz: Option<Quantity>,
    /// Torsion constant; Iy + Iz by default.
    #[serde(rename = "J")]
    pub j: Option<Quantity>,
    /// Distance of the outer fibres in y and z, for stresses.
    pub fibres: Option<At<Vec<Quantity>>>,
    /// Direction of y in the ground frame at the reference pose.
    pub y_axis: Option<Triple>,
}

/// A piece of a stepped link.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(extend("required" = ["to"]))]
pub struct StepSpec {
    /// Where the piece ends, from the first end of the link.
    pub to: Option<Quantity>,
    /// Radius of a round piece.
    pub radius: Option<Quantity>,
    /// Inner radius of a round piece.
    pub inner_radius: Option<Quantity>,
    /// Edge or edges of a rectangular piece.
    pub width: Option<Widths>,
}

/// A mass fixed to the link's axis.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(extend("required" = ["at", "mass"]))]
pub struct PointMassSpec {
    /// Distance from the first end.
    pub at: Option<Quantity>,
    /// Mass.
    pub mass: Option<Quantity>,
}

/// A body's centre: a name or coordinates.
#[derive(Clone, Debug)]
pub enum Centre {
    /// A named point.
    Point(Name),
    /// Coordinates.
    At(Triple),
}

/// Edges of a box's section.
#[derive(Clone, Debug)]
pub enum Widths {
    /// A square.
    Square(Quantity),
    /// A rectangle: along `width_axis`, and the other edge.
    Rectangle(At<Vec<Quantity>>),
}

/// A joint: exactly one of the kinds, with the parent and the child.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(extend("oneOf" = [
    { "required": ["revolute"] }, { "required": ["prismatic"] }, { "required": ["cylindrical"] },
    { "required": ["screw"] }, { "required": ["universal"] }, { "required": ["spherical"] },
    { "required": ["planar"] }, { "required": ["fixed"] }, { "required": ["free"] }
], "required" = ["at"]))]
pub struct JointSpec {
    /// Rotation about `axis`.
    pub revolute: Option<Pair>,
    /// Translation along `axis`.
    pub prismatic: Option<Pair>,
    /// Rotation about and translation along `axis`.
    pub cylindrical: Option<Pair>,
    /// Rotation with translation by `lead` per turn.
    pub screw: Option<Pair>,
    /// Rotation about the two `axes`.
    pub universal: Option<Pair>,
    /// Rotation about a point.
    pub spherical: Option<Pair>,
    /// Motion in the plane with normal `axis`.
    pub planar: Option<Pair>,
    /// No relative motion.
    pub fixed: Option<Pair>,
    /// No constraint.
    pub free: Option<Pair>,
    /// Point where the joint is.
    pub at: Option<Name>,
    /// Direction at the reference pose, for all or by body; any length.
    pub axis: Option<PerBody>,
    /// The two axes of a universal joint: on the parent, on the child.
    pub axes: Option<At<Vec<PerBody>>>,
    /// Direction of `q1` of a planar joint.
    pub first: Option<PerBody>,
    /// Advance of a screw per turn.
    pub lead: Option<Quantity>,
    /// Prescribed motion over parameters and t.
    pub drive: Option<ByCoordinate>,
    /// Viscous damping.
    pub damping: Option<ByCoordinate>,
    /// Viscous friction; the same law as `damping`.
    pub friction: Option<ByCoordinate>,
    /// Linear spring.
    pub spring: Option<SpringSpec>,
    /// Force or torque by formula, positive along the coordinate.
    pub force: Option<ByCoordinate>,
    /// Cut the loop here.
    pub cut: Option<At<bool>>,
    /// Our own assumption.
    pub assumed: bool,
    /// What it is.
    pub doc: Option<String>,
}

/// A quantity for the only coordinate of a joint, or one by coordinate.
#[derive(Clone, Debug)]
pub enum ByCoordinate {
    /// For the only coordinate.
    One(Quantity),
    /// By coordinate.
    Each(Box<At<EachCoordinate>>),
}

/// Quantities by coordinate of a joint.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct EachCoordinate {
    /// The only coordinate.
    pub q: Option<Quantity>,
    /// First coordinate.
    pub q1: Option<Quantity>,
    /// Second coordinate.
    pub q2: Option<Quantity>,
    /// Third coordinate.
    pub q3: Option<Quantity>,
}

/// A joint spring: for the only coordinate, or by coordinate.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SpringSpec {
    /// Stiffness.
    pub stiffness: Option<Quantity>,
    /// Unloaded position; 0 by default.
    pub rest: Option<Quantity>,
    /// The only coordinate.
    pub q: Option<At<SpringPart>>,
    /// First coordinate.
    pub q1: Option<At<SpringPart>>,
    /// Second coordinate.
    pub q2: Option<At<SpringPart>>,
    /// Third coordinate.
    pub q3: Option<At<SpringPart>>,
}

/// A spring of one coordinate.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(extend("required" = ["stiffness"]))]
pub struct SpringPart {
    /// Stiffness.
    pub stiffness: Option<Quantity>,
    /// Unloaded position; 0 by default.
    pub rest: Option<Quantity>,
}

/// A force element: exactly one of `spring`, `force`, `torque`.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(extend("oneOf" = [
    { "required": ["spring", "at"] }, { "required": ["force", "at", "components"] },
    { "required": ["torque", "components"] }
]))]
pub struct ForceSpec {
    /// Spring and damper between two bodies.
    pub spring: Option<Pair>,
    /// Body that is pushed.
    pub force: Option<Name>,
    /// Body that is turned.
    pub torque: Option<Name>,
    /// Point of a force, or the two points of a spring.
    pub at: Option<Places>,
    /// Stiffness of a spring.
    pub stiffness: Option<Quantity>,
    /// Unloaded length of a spring.
    pub length: Option<Quantity>,
    /// Damping of a spring along its line.
    pub damping: Option<Quantity>,
    /// Constant pull of a spring.
    pub preload: Option<Quantity>,
    /// Components of a force or torque.
    pub components: Option<Triple>,
    /// Axes of the components: "ground" (default) or a body they turn with.
    pub axes: Option<Name>,
    /// Body that takes the reaction; "ground" by default.
    pub reaction: Option<Name>,
    /// Our own assumption.
    pub assumed: bool,
    /// What it is.
    pub doc: Option<String>,
}

/// One point or several.
#[derive(Clone, Debug)]
pub struct Places(pub At<Vec<Name>>);

/// Start values of a joint.
#[derive(Clone, Debug)]
pub enum StartSpec {
    /// Position of the only coordinate.
    One(Quantity),
    /// Positions in order.
    List(At<Vec<Quantity>>),
    /// Positions and speeds by name.
    Table(Box<At<StartTable>>),
}

/// Start positions (`q`, or `q1`, `q2` ...) and speeds (`v`, or `v1`, `v2` ...).
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[allow(missing_docs, reason = "one line above says all")]
pub struct StartTable {
    pub q: Option<Quantity>,
    pub q1: Option<Quantity>,
    pub q2: Option<Quantity>,
    pub q3: Option<Quantity>,
    pub q4: Option<Quantity>,
    pub q5: Option<Quantity>,
    pub q6: Option<Quantity>,
    pub v: Option<Quantity>,
    pub v1: Option<Quantity>,
    pub v2: Option<Quantity>,
    pub v3: Option<Quantity>,
    pub v4: Option<Quantity>,
    pub v5: Option<Quantity>,
    pub v6: Option<Quantity>,
    /// Modal coordinates of a flexible body.
    pub eta: Option<At<Vec<Quantity>>>,
    /// Modal speeds of a flexible body.
    pub eta_v: Option<At<Vec<Quantity>>>,
}

/// A group made `count` times; names and texts may contain `{i}`, `{i+1}` and the like.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(extend("required" = ["count"]))]
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
