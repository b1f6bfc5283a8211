//! Joints as written.

#[cfg(test)]
use schemars::JsonSchema;
use serde::Deserialize;

use super::doc::Doc;
use super::texts::{tables, texts_of};
use super::written::{At, Name, Pair, PerBody, Quantity};

/// Kinds, and the keys that each needs besides, for the schema.
#[cfg(test)]
pub(super) const NEEDS_OF_KINDS: [(&str, &[&str]); 11] = [
    ("cylindrical", &["axis"]),
    ("distance", &["origin"]),
    ("inline", &["axis"]),
    ("inplane", &["axis"]),
    ("on_surface", &["origin", "equation"]),
    ("planar", &["axis"]),
    ("prismatic", &["axis"]),
    ("revolute", &["axis"]),
    ("screw", &["axis", "lead"]),
    ("slot", &["axis", "first"]),
    ("universal", &["axes"]),
];

tables! {
    /// A joint: exactly one of the kinds, with the parent and the child.
    #[cfg_attr(test, schemars(extend("oneOf" = [
        { "required": ["revolute"] }, { "required": ["prismatic"] }, { "required": ["cylindrical"] },
        { "required": ["screw"] }, { "required": ["universal"] }, { "required": ["spherical"] },
        { "required": ["inline"] }, { "required": ["planar"] }, { "required": ["slot"] },
        { "required": ["inplane"] }, { "required": ["distance"] }, { "required": ["on_surface"] },
        { "required": ["fixed"] }, { "required": ["free"] }
    ], "required" = ["at"])))]
    pub struct JointSpec {
        /// Rotation about `axis`.
        /// [parent and child; e.g. ["ground", "crank"]]
        pub revolute: Option<Pair>,
        /// Translation along `axis`.
        /// [parent and child; e.g. ["ground", "crank"]]
        pub prismatic: Option<Pair>,
        /// Rotation about and translation along `axis`.
        /// [parent and child; e.g. ["ground", "crank"]]
        pub cylindrical: Option<Pair>,
        /// Rotation with translation by `lead` per turn.
        /// [parent and child; e.g. ["ground", "crank"]]
        pub screw: Option<Pair>,
        /// Rotation about the two `axes`.
        /// [parent and child; e.g. ["ground", "crank"]]
        pub universal: Option<Pair>,
        /// Rotation about a point.
        /// [parent and child; e.g. ["ground", "crank"]]
        pub spherical: Option<Pair>,
        /// Rotation about a point that slides along `axis`.
        /// [parent and child; e.g. ["ground", "crank"]]
        pub inline: Option<Pair>,
        /// Motion in the plane with normal `axis`.
        /// [parent and child; e.g. ["ground", "crank"]]
        pub planar: Option<Pair>,
        /// Rotation about `axis` of a pin that slides along `first` in a slot of the parent.
        /// [parent and child; e.g. ["wheel", "crank"]]
        pub slot: Option<Pair>,
        /// Rotation about a point that slides in the plane with normal `axis`.
        /// [parent and child; e.g. ["ground", "foot"]]
        pub inplane: Option<Pair>,
        /// Constant distance of the child's point `at` from the parent's point `origin`: a rod without mass.
        /// [parent and child; e.g. ["crank", "rocker"]]
        pub distance: Option<Pair>,
        /// The child's point `at` stays where `equation` is zero.
        /// [parent and child; e.g. ["cam", "follower"]]
        pub on_surface: Option<Pair>,
        /// No relative motion.
        /// [parent and child; e.g. ["ground", "crank"]]
        pub fixed: Option<Pair>,
        /// No constraint.
        /// [parent and child; e.g. ["ground", "crank"]]
        pub free: Option<Pair>,
        /// Point where the joint is.
        /// [point; required; e.g. "O"]
        pub at: Option<Name>,
        /// Direction at the reference pose, for all or by body; any length.
        /// [direction; required but of spherical, universal, fixed and free; e.g. [0, 0, 1]]
        pub axis: Option<PerBody>,
        /// The two axes of a universal joint: on the parent, on the child.
        /// [two directions; required of universal; e.g. [[1, 0, 0], [0, 1, 0]]]
        #[cfg_attr(test, schemars(extend("minItems" = 2, "maxItems" = 2)))]
        pub axes: Option<At<Vec<PerBody>>>,
        /// Direction of `q1` of a planar or inplane joint, and of a slot.
        /// [direction; required of a slot; default near an axis of the ground; e.g. [1, 0, 0]]
        pub first: Option<PerBody>,
        /// The parent's point from which `distance` and `on_surface` see the child's.
        /// [point; required of distance and on_surface; e.g. "O"]
        pub origin: Option<Name>,
        /// Distance of a distance joint.
        /// [m; above 0; default as drawn; e.g. "120 mm"]
        pub length: Option<Quantity>,
        /// Zero on the surface: a length over parameters and the place `x`, `y`, `z` of the child's point seen from `origin`,
        /// along axes that turn with the parent and are those of the ground at the reference pose.
        /// [m; required of on_surface; e.g. "sqrt(x^2 + y^2) - 30 mm"]
        pub equation: Option<Quantity>,
        /// Advance of a screw per turn.
        /// [m; not 0; required of a screw; e.g. "5 mm"]
        pub lead: Option<Quantity>,
        /// Prescribed motion over parameters, inputs and t; of a spherical joint three angles that follow each other, about x, y and z.
        /// [rad or m; twice differentiable; default none; e.g. "2*pi*speed*t"]
        pub drive: Option<ByCoordinate>,
        /// Viscous damping.
        /// [N m s or N s/m; from 0; default 0; e.g. "0.1 N m s/rad"]
        pub damping: Option<ByCoordinate>,
        /// Viscous friction; the same law as `damping`.
        /// [N m s or N s/m; from 0; default 0; e.g. "1e-4 N m s/rad"]
        pub friction: Option<ByCoordinate>,
        /// Linear spring.
        /// [table; default none]
        pub spring: Option<SpringSpec>,
        /// Dry friction that follows the joint's own force; of revolute and prismatic joints.
        /// [table; default none]
        pub dry_friction: Option<Box<At<DryFrictionSpec>>>,
        /// Force or torque by formula, positive along the coordinate.
        /// [N m or N; any; default none; e.g. "-2 N m"]
        pub force: Option<ByCoordinate>,
        /// Cut the loop here.
        /// [true or false; default chosen; e.g. true]
        pub cut: Option<At<bool>>,
        /// Our own assumption.
        /// [mark]
        pub assumed: bool,
        /// What it is.
        /// [text]
        pub doc: Option<Doc>,
    }

    /// Quantities by coordinate of a joint.
    pub struct EachCoordinate {
        /// The only coordinate.
        /// [as of one coordinate]
        pub q: Option<Quantity>,
        /// First coordinate.
        /// [as of one coordinate]
        pub q1: Option<Quantity>,
        /// Second coordinate.
        /// [as of one coordinate]
        pub q2: Option<Quantity>,
        /// Third coordinate.
        /// [as of one coordinate]
        pub q3: Option<Quantity>,
    }

    /// A joint spring: for the only coordinate, or by coordinate.
    #[cfg_attr(test, schemars(extend("anyOf" = [
        { "required": ["stiffness"] }, { "required": ["q"] }, { "required": ["q1"] }, { "required": ["q2"] },
        { "required": ["q3"] }
    ])))]
    pub struct SpringSpec {
        /// Stiffness.
        /// [N m or N/m; any; required; e.g. "500 N/m"]
        pub stiffness: Option<Quantity>,
        /// Unloaded position.
        /// [rad or m; any; default 0; e.g. "10 deg"]
        pub rest: Option<Quantity>,
        /// Force or torque at `rest`, against the coordinate.
        /// [N m or N; any; default 0; e.g. "2 N m"]
        pub preload: Option<Quantity>,
        /// The only coordinate.
        /// [table]
        pub q: Option<At<SpringPart>>,
        /// First coordinate.
        /// [table]
        pub q1: Option<At<SpringPart>>,
        /// Second coordinate.
        /// [table]
        pub q2: Option<At<SpringPart>>,
        /// Third coordinate.
        /// [table]
        pub q3: Option<At<SpringPart>>,
    }

    /// Coulomb friction under the force that the joint carries across its axis.
    #[cfg_attr(test, schemars(extend("required" = ["coefficient"])))]
    pub struct DryFrictionSpec {
        /// Coefficient of friction of sliding at speed.
        /// [1; from 0; required; e.g. 0.1]
        pub coefficient: Option<Quantity>,
        /// Coefficient of friction just after sliding begins (Stribeck).
        /// [1; from 0; default `coefficient`; e.g. 0.15]
        pub at_rest: Option<Quantity>,
        /// Speed by which the coefficient has fallen from the one to the other.
        /// [rad/s or m/s; above 0; required with `at_rest`; e.g. "10 mm/s"]
        pub stribeck_speed: Option<Quantity>,
        /// Speed within which friction changes its sign: below it the joint creeps.
        /// [rad/s or m/s; above 0; default 0.01 rad/s or 1 mm/s; e.g. "0.1 mm/s"]
        pub onset: Option<Quantity>,
        /// Radius of the bearing of a revolute joint.
        /// [m; above 0; required of a revolute joint; e.g. "10 mm"]
        pub radius: Option<Quantity>,
        /// Distance of the two places that carry moments across the axis, on the second body.
        /// [m; above 0; default one place, which carries the force alone; e.g. "80 mm"]
        pub length: Option<Quantity>,
    }

    /// A spring of one coordinate.
    #[cfg_attr(test, schemars(extend("required" = ["stiffness"])))]
    pub struct SpringPart {
        /// Stiffness.
        /// [N m or N/m; any; required; e.g. "500 N/m"]
        pub stiffness: Option<Quantity>,
        /// Unloaded position.
        /// [rad or m; any; default 0; e.g. "10 deg"]
        pub rest: Option<Quantity>,
        /// Force or torque at `rest`, against the coordinate.
        /// [N m or N; any; default 0; e.g. "2 N m"]
        pub preload: Option<Quantity>,
    }
}

impl JointSpec {
    /// The keys of kinds that are written, and what is written there.
    pub fn kinds(&self) -> impl Iterator<Item = (&'static str, &Pair)> {
        let kinds = [
            ("revolute", &self.revolute),
            ("prismatic", &self.prismatic),
            ("cylindrical", &self.cylindrical),
            ("screw", &self.screw),
            ("universal", &self.universal),
            ("spherical", &self.spherical),
            ("inline", &self.inline),
            ("planar", &self.planar),
            ("slot", &self.slot),
            ("inplane", &self.inplane),
            ("distance", &self.distance),
            ("on_surface", &self.on_surface),
            ("fixed", &self.fixed),
            ("free", &self.free),
        ];
        kinds.into_iter().filter_map(|(key, pair)| pair.as_ref().map(|pair| (key, pair)))
    }
}

/// A quantity for the only coordinate of a joint, or one by coordinate.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename = "$linkwear::ByForm")]
#[cfg_attr(test, derive(JsonSchema), schemars(rename = "ByCoordinate", untagged))]
pub enum ByCoordinate {
    /// For the only coordinate.
    #[serde(rename = "scalar", alias = "list")]
    One(Quantity),
    /// By coordinate.
    #[serde(rename = "table")]
    Each(Box<At<EachCoordinate>>),
}

texts_of! { enum ByCoordinate { One, Each } }
