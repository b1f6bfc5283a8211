//! Bodies as written: shape and mass, how they bend.

#[cfg(test)]
use schemars::JsonSchema;
use serde::Deserialize;

use super::doc::Doc;
use super::texts::{tables, texts_of, without_texts};
use super::written::{At, Name, Pair, Quantity, Triple};

tables! {
    /// A moving body: exactly one of `rod`, `tube`, `box`, or `mass` with `centre`.
    #[cfg_attr(test, schemars(extend("anyOf" = [
        { "required": ["rod"] }, { "required": ["tube"] }, { "required": ["box"] }, { "required": ["centre", "mass"] }
    ])))]
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
        pub doc: Option<Doc>,
    }

    /// How a body bends: as a beam along its rod, tube or box, or by modal data from a file.
    #[cfg_attr(test, schemars(extend("anyOf" = [{ "required": ["modes", "young"] }, { "required": ["data"] }])))]
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

    /// A section by its numbers.
    #[cfg_attr(test, schemars(extend("required" = ["area", "Iy", "Iz"])))]
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
    #[cfg_attr(test, schemars(extend("required" = ["to"])))]
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
    #[cfg_attr(test, schemars(extend("required" = ["at", "mass"])))]
    pub struct PointMassSpec {
        /// Distance from the first end.
        pub at: Option<Quantity>,
        /// Mass.
        pub mass: Option<Quantity>,
    }
}

/// Bending theory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
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
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
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

/// A body's centre: a name or coordinates.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename = "$linkwear::ByForm")]
#[cfg_attr(test, derive(JsonSchema), schemars(rename = "Centre", untagged))]
pub enum Centre {
    /// A named point.
    #[serde(rename = "scalar", alias = "table")]
    Point(Name),
    /// Coordinates.
    #[serde(rename = "list")]
    At(Triple),
}

/// Edges of a box's section.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename = "$linkwear::ByForm")]
#[cfg_attr(test, derive(JsonSchema), schemars(rename = "Widths", untagged))]
pub enum Widths {
    /// A square.
    #[serde(rename = "scalar", alias = "table")]
    Square(Quantity),
    /// A rectangle: along `width_axis`, and the other edge.
    #[serde(rename = "list")]
    Rectangle(#[cfg_attr(test, schemars(length(equal = 2)))] At<Vec<Quantity>>),
}

without_texts!(TheorySpec, HeldSpec);

texts_of! {
    enum Centre { Point, At }
    enum Widths { Square, Rectangle }
}
