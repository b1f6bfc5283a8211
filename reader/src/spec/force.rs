//! Force elements as written, and their kinds as data: each is one row of [`FORCE_KINDS`], which says what its keys are
//! and which numbers it consists of. All else but its equations follows by rule.

#[cfg(test)]
use schemars::JsonSchema;
use serde::Deserialize;

use super::dimension::Dimension;
use super::doc::Doc;
use super::texts::{tables, texts_of};
use super::told::Told;
use super::written::{At, Name, Pair, Quantity, Triple};
use crate::source::Span;

tables! {
    /// A force element: exactly one of `spring`, `cable`, `bushing`, `force`, `torque`.
    #[cfg_attr(test, schemars(extend("oneOf" = [
        {
            "required": ["spring", "at"],
            "anyOf": [
                { "required": ["stiffness", "length"] },
                { "anyOf": [{ "required": ["damping"] }, { "required": ["preload"] }], "not": { "required": ["stiffness"] } }
            ]
        },
        { "required": ["cable", "at", "stiffness"] },
        {
            "required": ["bushing", "at"],
            "anyOf": [
                { "required": ["translation"] }, { "required": ["rotation"] }, { "required": ["stiffness_matrix"] },
                { "required": ["damping_matrix"] }
            ]
        },
        { "required": ["force", "at", "components"] },
        { "required": ["torque", "components"] }
    ], "allOf" = [{
        "if": { "anyOf": [{ "required": ["spring"] }, { "required": ["cable"] }] },
        "then": { "properties": { "at": { "type": "array", "minItems": 2, "maxItems": 2 } } },
        "else": { "properties": { "at": { "minItems": 1, "maxItems": 1 } } }
    }])))]
    pub struct ForceSpec {
        /// Spring and damper between two bodies.
        /// [two bodies; e.g. ["ground", "rocker"]]
        pub spring: Option<Pair>,
        /// Rope, chain or belt between two bodies, which pulls and never pushes.
        /// [two bodies; e.g. ["ground", "load"]]
        pub cable: Option<Pair>,
        /// Elastic mount between two bodies.
        /// [two bodies; e.g. ["ground", "engine"]]
        pub bushing: Option<Pair>,
        /// Body that is pushed.
        /// [body; e.g. "ram"]
        pub force: Option<Name>,
        /// Body that is turned.
        /// [body; e.g. "crank"]
        pub torque: Option<Name>,
        /// Point of a force or bushing, or the two points of a spring or cable.
        /// [points; required but of a torque; e.g. ["P", "Q"]]
        pub at: Option<Places>,
        /// Stiffness of a spring or cable; of a cable above 0.
        /// [N/m; any; default 0, required of a cable; e.g. "500 N/m"]
        pub stiffness: Option<Quantity>,
        /// Unloaded length of a spring or cable.
        /// [m; from 0; required with `stiffness`, of a cable default as drawn; e.g. "100 mm"]
        pub length: Option<Quantity>,
        /// Damping of a spring or cable along its line.
        /// [N s/m; from 0; default 0; e.g. "20 N s/m"]
        pub damping: Option<Quantity>,
        /// Constant pull of a spring; pull of a cable at its `length`.
        /// [N; any; default 0; e.g. "50 N"]
        pub preload: Option<Quantity>,
        /// Stiffness and damping of a bushing along its axes.
        /// [table of N/m and N s/m; default 0]
        pub translation: Option<At<ByAxis>>,
        /// Stiffness and damping of a bushing about its axes.
        /// [table of N m and N m s; default 0]
        pub rotation: Option<At<ByAxis>>,
        /// Full stiffness matrix of a bushing, by displacements along and rotations about its axes: symmetric, six rows.
        /// [six rows of N/m, N and N m; symmetric, positive semidefinite; default none]
        pub stiffness_matrix: Option<At<Vec<SixNumbers>>>,
        /// Full damping matrix of a bushing, likewise.
        /// [six rows of N s/m, N s and N m s; symmetric, positive semidefinite; default none]
        pub damping_matrix: Option<At<Vec<SixNumbers>>>,
        /// Axes of a bushing at the reference pose: two or three directions at right angles.
        /// [directions; at right angles; default those of the ground; e.g. [[1, 0, 0], [0, 1, 0]]]
        pub directions: Option<At<Vec<Triple>>>,
        /// Components of a force or torque.
        /// [N or N m; any; required of a force or torque; e.g. [0, 0, "-10 N"]]
        pub components: Option<Triple>,
        /// Axes of the components: "ground" or a body they turn with.
        /// [body; default "ground"; e.g. "ram"]
        pub axes: Option<Name>,
        /// Body that takes the reaction.
        /// [body; default "ground"; e.g. "frame"]
        pub reaction: Option<Name>,
        /// Our own assumption.
        /// [mark]
        pub assumed: bool,
        /// What it is.
        /// [text]
        pub doc: Option<Doc>,
    }

    /// Stiffness and damping, axis by axis.
    pub struct ByAxis {
        /// Stiffness.
        /// [N/m or N m; from 0; default 0; e.g. ["1 kN/mm", "1 kN/mm", "2 kN/mm"]]
        pub stiffness: Option<Triple>,
        /// Damping.
        /// [N s/m or N m s; from 0; default 0; e.g. ["10 N s/m", "10 N s/m", "20 N s/m"]]
        pub damping: Option<Triple>,
        /// Force or moment in the reference pose, against a displacement or rotation along its axes.
        /// [N or N m; any; default 0; e.g. [0, 0, "500 N"]]
        pub preload: Option<Triple>,
    }
}

/// A row of a matrix of a bushing.
// The count is checked later, so that the message can teach.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema), schemars(extend("minItems" = 6, "maxItems" = 6)))]
pub struct SixNumbers(pub At<Vec<Quantity>>);

texts_of! { struct SixNumbers { 0 } }

/// One point or several.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename = "$linkwear::ByForm")]
#[cfg_attr(test, derive(JsonSchema), schemars(rename = "Places", untagged))]
pub enum Places {
    /// One.
    #[serde(rename = "scalar", alias = "table")]
    One(Name),
    /// A list.
    #[serde(rename = "list")]
    List(At<Vec<Name>>),
}

impl Places {
    /// Their names, and where they are written.
    pub fn names(&self) -> (&[Name], Span) {
        match self {
            Self::One(name) => (std::slice::from_ref(name), name.span),
            Self::List(list) => (&list.value, list.span),
        }
    }
}

texts_of! { enum Places { One, List } }

/// A kind of force element.
#[derive(Debug)]
pub struct ForceKind {
    /// Key in a file; its value names the bodies.
    pub name: &'static str,
    /// The key with bodies, for advice.
    pub example: &'static str,
    /// Which bodies.
    pub bodies: Bodies,
    /// How many points `at` names: two, one on each body; one, which both bodies have; none.
    pub points: usize,
    /// Whether bodies are turned at these points, not only pushed.
    pub turns: bool,
    /// Whether it pushes as well as it pulls along the line between two points: a coil in pictures.
    pub coiled: bool,
    /// Keys that it takes besides its own.
    pub keys: &'static [&'static str],
    /// The numbers that it consists of, in the order in which its equations take them.
    pub values: &'static [ForceValue],
    /// What must not be missing.
    pub needs: &'static [Need],
    /// What it tells of itself.
    pub told: Told,
}

/// Whether something is missing, words that say so, advice.
pub type Need = (fn(&ForceSpec) -> bool, &'static str, &'static str);

/// Between which bodies a kind of force element acts.
#[derive(Clone, Copy, Debug)]
pub enum Bodies {
    /// Two of equal rank. The numbers are over parameters.
    Two(fn(&ForceSpec) -> Option<&Pair>),
    /// One, and the one of `reaction`. The numbers are components, in `axes`, over the state.
    One(fn(&ForceSpec) -> Option<&Name>),
}

/// A number of a kind of force element, or three by axis; 0 where nothing is written.
#[derive(Debug)]
pub struct ForceValue {
    /// Key in a file.
    pub key: &'static str,
    /// Dimension.
    pub dimension: Dimension,
    /// Whether it may be negative.
    pub signed: bool,
    /// Whether it may be zero.
    pub zero: bool,
    /// Whether it is the distance of both points at the reference pose where nothing is written.
    pub drawn: bool,
    /// What is written.
    pub written: Written,
}

impl ForceValue {
    /// Whether nothing is written.
    pub fn is_missing(&self, spec: &ForceSpec) -> bool {
        match self.written {
            Written::One(of) => of(spec).is_none(),
            Written::Three(of) => of(spec).is_none(),
            Written::Matrix(of, _) => of(spec).is_none(),
        }
    }
}

/// How to find a value.
#[derive(Clone, Copy, Debug)]
pub enum Written {
    /// One number.
    One(fn(&ForceSpec) -> Option<&Quantity>),
    /// Three by axis.
    Three(fn(&ForceSpec) -> Option<&Triple>),
    /// Six rows of six; displacements come first. Dimensions of the blocks beside the first: one of each kind, rotations.
    Matrix(fn(&ForceSpec) -> Option<&At<Vec<SixNumbers>>>, [Dimension; 2]),
}

const fn one(
    key: &'static str,
    dimension: Dimension,
    signed: bool,
    of: fn(&ForceSpec) -> Option<&Quantity>,
) -> ForceValue {
    ForceValue { key, dimension, signed, zero: true, drawn: false, written: Written::One(of) }
}

const fn three(
    key: &'static str,
    dimension: Dimension,
    signed: bool,
    of: fn(&ForceSpec) -> Option<&Triple>,
) -> ForceValue {
    ForceValue { key, dimension, signed, zero: true, drawn: false, written: Written::Three(of) }
}

const fn matrix(
    key: &'static str,
    [first, mixed, last]: [Dimension; 3],
    of: fn(&ForceSpec) -> Option<&At<Vec<SixNumbers>>>,
) -> ForceValue {
    ForceValue {
        key,
        dimension: first,
        signed: true,
        zero: true,
        drawn: false,
        written: Written::Matrix(of, [mixed, last]),
    }
}

const STIFFNESS: Dimension = Dimension::of(0, 1, -2);
const DAMPING: Dimension = Dimension::of(0, 1, -1);
const MIXED_DAMPING: Dimension = Dimension::of(1, 1, -1);
const TURNING_DAMPING: Dimension = Dimension::of(2, 1, -1);

/// The kind that springs of spherical joints are of.
pub const ELASTIC: &str = "bushing";

/// Every kind of force element.
pub static FORCE_KINDS: &[ForceKind] = &[
    ForceKind {
        name: "spring",
        example: r#"spring = ["ground", "rocker"]"#,
        bodies: Bodies::Two(|spec| spec.spring.as_ref()),
        points: 2,
        turns: false,
        coiled: true,
        keys: &["at", "stiffness", "length", "damping", "preload"],
        values: &[
            one("stiffness", STIFFNESS, true, |spec| spec.stiffness.as_ref()),
            one("length", Dimension::LENGTH, false, |spec| spec.length.as_ref()),
            one("damping", DAMPING, false, |spec| spec.damping.as_ref()),
            one("preload", Dimension::FORCE, true, |spec| spec.preload.as_ref()),
        ],
        needs: &[
            (
                |spec| spec.stiffness.is_some() && spec.length.is_none(),
                "has no unloaded `length`",
                r#"add `length = "100 mm"`, or `length = 0` if it always pulls"#,
            ),
            (
                |spec| spec.stiffness.is_none() && spec.damping.is_none() && spec.preload.is_none(),
                "has neither stiffness, damping nor preload",
                r#"add for example `stiffness = "500 N/m", length = "100 mm"`"#,
            ),
        ],
        told: Told::Nothing,
    },
    ForceKind {
        name: "cable",
        example: r#"cable = ["ground", "load"]"#,
        bodies: Bodies::Two(|spec| spec.cable.as_ref()),
        points: 2,
        turns: false,
        coiled: false,
        keys: &["at", "stiffness", "length", "damping", "preload"],
        values: &[
            ForceValue { zero: false, ..one("stiffness", STIFFNESS, false, |spec| spec.stiffness.as_ref()) },
            ForceValue {
                drawn: true,
                ..one("length", Dimension::LENGTH, false, |spec| spec.length.as_ref())
            },
            one("damping", DAMPING, false, |spec| spec.damping.as_ref()),
            one("preload", Dimension::FORCE, true, |spec| spec.preload.as_ref()),
        ],
        needs: &[(
            |spec| spec.stiffness.is_none(),
            "has no `stiffness`",
            r#"add `stiffness = "50 kN/m"`: modulus times cross-section over length"#,
        )],
        told: Told::Pull,
    },
    ForceKind {
        name: ELASTIC,
        example: r#"bushing = ["ground", "engine"]"#,
        bodies: Bodies::Two(|spec| spec.bushing.as_ref()),
        points: 1,
        turns: true,
        coiled: false,
        keys: &["at", "translation", "rotation", "stiffness_matrix", "damping_matrix", "directions"],
        values: &[
            three("stiffness", STIFFNESS, false, |spec| spec.translation.as_ref()?.value.stiffness.as_ref()),
            three("damping", DAMPING, false, |spec| spec.translation.as_ref()?.value.damping.as_ref()),
            three("stiffness", Dimension::TORQUE, false, |spec| {
                spec.rotation.as_ref()?.value.stiffness.as_ref()
            }),
            three("damping", TURNING_DAMPING, false, |spec| spec.rotation.as_ref()?.value.damping.as_ref()),
            three("preload", Dimension::FORCE, true, |spec| {
                spec.translation.as_ref()?.value.preload.as_ref()
            }),
            three("preload", Dimension::TORQUE, true, |spec| spec.rotation.as_ref()?.value.preload.as_ref()),
            matrix("stiffness_matrix", [STIFFNESS, Dimension::FORCE, Dimension::TORQUE], |spec| {
                spec.stiffness_matrix.as_ref()
            }),
            matrix("damping_matrix", [DAMPING, MIXED_DAMPING, TURNING_DAMPING], |spec| {
                spec.damping_matrix.as_ref()
            }),
        ],
        needs: &[(
            |spec| {
                let matrices = [&spec.stiffness_matrix, &spec.damping_matrix];
                spec.translation.is_none()
                    && spec.rotation.is_none()
                    && matrices.iter().all(|one| one.is_none())
            },
            "has neither stiffness nor damping",
            r#"add for example `translation = { stiffness = ["1 kN/mm", "1 kN/mm", "2 kN/mm"] }`"#,
        )],
        told: Told::Wrench,
    },
    ForceKind {
        name: "force",
        example: r#"force = "crank""#,
        bodies: Bodies::One(|spec| spec.force.as_ref()),
        points: 1,
        turns: false,
        coiled: false,
        keys: &["at", "components", "axes", "reaction"],
        values: &[three("components", Dimension::FORCE, true, |spec| spec.components.as_ref())],
        needs: &[(
            |spec| spec.components.is_none(),
            "has no `components`",
            r#"add `components = [0, 0, "-10 N"]`"#,
        )],
        told: Told::Nothing,
    },
    ForceKind {
        name: "torque",
        example: r#"torque = "crank""#,
        bodies: Bodies::One(|spec| spec.torque.as_ref()),
        points: 0,
        turns: false,
        coiled: false,
        keys: &["components", "axes", "reaction"],
        values: &[three("components", Dimension::TORQUE, true, |spec| spec.components.as_ref())],
        needs: &[(
            |spec| spec.components.is_none(),
            "has no `components`",
            r#"add `components = [0, 0, "-10 N m"]`"#,
        )],
        told: Told::Nothing,
    },
];

impl ForceKind {
    /// The kind with this key.
    pub fn named(name: &str) -> Option<&'static Self> {
        FORCE_KINDS.iter().find(|kind| kind.name == name)
    }

    /// The kind of what is written, if it is one.
    pub fn of(spec: &ForceSpec) -> Option<&'static Self> {
        let mut kinds = FORCE_KINDS.iter().filter(|kind| kind.is_written(spec));
        kinds.next().filter(|_| kinds.next().is_none())
    }

    /// Whether this key is written.
    pub fn is_written(&self, spec: &ForceSpec) -> bool {
        match self.bodies {
            Bodies::Two(pair) => pair(spec).is_some(),
            Bodies::One(body) => body(spec).is_some(),
        }
    }
}
