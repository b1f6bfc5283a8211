//! Joints as written.

#[cfg(test)]
use schemars::JsonSchema;
use serde::Deserialize;

use super::doc::Doc;
use super::texts::{tables, texts_of};
use super::written::{At, Name, Pair, PerBody, Quantity};

tables! {
    /// A joint: exactly one of the kinds, with the parent and the child.
    #[cfg_attr(test, schemars(extend("oneOf" = [
        { "required": ["revolute"] }, { "required": ["prismatic"] }, { "required": ["cylindrical"] },
        { "required": ["screw"] }, { "required": ["universal"] }, { "required": ["spherical"] },
        { "required": ["inline"] }, { "required": ["planar"] }, { "required": ["fixed"] }, { "required": ["free"] }
    ], "required" = ["at"])))]
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
        /// Rotation about a point that slides along `axis`.
        pub inline: Option<Pair>,
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
        /// Prescribed motion over parameters, inputs and t.
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
        pub doc: Option<Doc>,
    }

    /// Quantities by coordinate of a joint.
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
    #[cfg_attr(test, schemars(extend("required" = ["stiffness"])))]
    pub struct SpringPart {
        /// Stiffness.
        pub stiffness: Option<Quantity>,
        /// Unloaded position; 0 by default.
        pub rest: Option<Quantity>,
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
