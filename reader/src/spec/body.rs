//! Bodies as written: shape and mass, how they bend.

#[cfg(test)]
use schemars::JsonSchema;
use serde::Deserialize;

use super::doc::Doc;
use super::drawn::Drawn;
use super::texts::{tables, texts_of, without_texts};
use super::written::{At, Name, Pair, Quantity, Triple};

tables! {
    /// A moving body: exactly one of `rod`, `tube`, `box`, or `mass` or `massless` with `centre`.
    #[cfg_attr(test, schemars(extend("anyOf" = [
        { "required": ["rod"] }, { "required": ["tube"] }, { "required": ["box"] }, { "required": ["centre", "mass"] },
        { "required": ["centre", "massless"] }
    ], "allOf" = [
        {
            "if": { "anyOf": [{ "required": ["rod"] }, { "required": ["tube"] }, { "required": ["box"] }] },
            "then": { "oneOf": [{ "required": ["density"] }, { "required": ["mass"] }] }
        },
        {
            "if": { "required": ["width"], "properties": { "width": { "type": "array" } } },
            "then": { "required": ["width_axis"] }
        }
    ])))]
    pub struct BodySpec {
        /// Solid cylinder between two points.
        /// [two points; e.g. ["O", "A"]]
        pub rod: Option<Pair>,
        /// Hollow cylinder between two points.
        /// [two points; e.g. ["O", "A"]]
        pub tube: Option<Pair>,
        /// Cuboid between two points.
        /// [two points; e.g. ["O", "A"]]
        #[serde(rename = "box")]
        pub cuboid: Option<Pair>,
        /// Outer radius of a rod or tube.
        /// [m; above 0; required of rod and tube; e.g. "6 mm"]
        pub radius: Option<Quantity>,
        /// Inner radius of a tube.
        /// [m; from 0, below `radius`; required of a tube; e.g. "4 mm"]
        pub inner_radius: Option<Quantity>,
        /// Edge of a square box, or the two edges of a rectangular one.
        /// [m; above 0; required of a box; e.g. ["4 mm", "20 mm"]]
        pub width: Option<Widths>,
        /// Direction of the first of `width`.
        /// [direction; required for two edges; e.g. [0, 0, 1]]
        pub width_axis: Option<Triple>,
        /// Density, instead of `mass`.
        /// [kg/m^3; above 0; required without `mass`; e.g. "7850 kg/m^3"]
        pub density: Option<Quantity>,
        /// Total mass.
        /// [kg; above 0; required without `density`; e.g. "0.35 kg"]
        pub mass: Option<Quantity>,
        /// A part whose mass is neglected, between joints: the cross of a universal joint. Stands with `centre`, a point of it.
        /// [mark]
        pub massless: bool,
        /// Centre of mass: a point's name or coordinates.
        /// [point or coordinates; required without a shape; e.g. "A"]
        pub centre: Option<Centre>,
        /// Inertia about the centre: xx, yy, zz or xx, yy, zz, xy, xz, yz.
        /// [kg m^2; of a real body; default zero; e.g. ["4e-4 kg m^2", "5e-4 kg m^2", "9e-4 kg m^2"]]
        #[cfg_attr(test, schemars(extend("anyOf" = [
            { "minItems": 3, "maxItems": 3 }, { "minItems": 6, "maxItems": 6 }
        ])))]
        pub inertia: Option<At<Vec<Quantity>>>,
        /// Axes of `inertia`: two or three directions at right angles.
        /// [directions; at right angles; default those of the ground; e.g. [[1, 0, 0], [0, 1, 0]]]
        #[cfg_attr(test, schemars(extend("minItems" = 2, "maxItems" = 3)))]
        pub axes: Option<At<Vec<Triple>>>,
        /// How the body bends; rigid without.
        /// [table; default rigid]
        pub flexible: Option<At<FlexibleSpec>>,
        /// Our own assumption.
        /// [mark]
        pub assumed: bool,
        /// What it is.
        /// [text]
        pub doc: Option<Doc>,
    }

    /// How a body bends: as a beam along its rod, tube or box, or by modal data from a file.
    #[cfg_attr(test, schemars(extend("anyOf" = [{ "required": ["modes", "young"] }, { "required": ["data"] }])))]
    pub struct FlexibleSpec {
        /// Number of bending modes kept, the lowest of both planes; 0 makes the body rigid.
        /// [1; 0 to 40; required of a beam; e.g. 6]
        pub modes: Option<Quantity>,
        /// Number of axial modes; of a link held at both ends the first is the static stretch.
        /// [1; 0 to 40; default 0; e.g. 1]
        pub axial: Option<Quantity>,
        /// Number of torsional modes.
        /// [1; 0 to 40; default 0; e.g. 1]
        pub torsion: Option<Quantity>,
        /// Young's modulus.
        /// [Pa; above 0; required of a beam; e.g. "210 GPa"]
        pub young: Option<Quantity>,
        /// Poisson's ratio.
        /// [1; above -1, up to 0.5; default 0.3; e.g. 0.3]
        pub poisson: Option<Quantity>,
        /// Modal damping ratio, for instance 0.01.
        /// [1; from 0; default 0; e.g. 0.01]
        pub damping: Option<Quantity>,
        /// What the bending elements know: "timoshenko", "rayleigh" or "euler_bernoulli".
        /// [word; default "timoshenko"; e.g. "rayleigh"]
        pub theory: Option<At<TheorySpec>>,
        /// How the link is held, which decides the modes.
        /// [word; default by the joints; e.g. "pinned"]
        pub held: Option<At<HeldSpec>>,
        /// 1: linear. 2: with foreshortening and geometric stiffness.
        /// [1; 1 or 2; default 1; e.g. 2]
        pub order: Option<At<i64>>,
        /// Frequencies to use instead of the computed ones, in the order of the modes.
        /// [Hz; above 0; default computed; e.g. ["138 Hz", "552 Hz"]]
        pub frequencies: Option<At<Vec<Quantity>>>,
        /// Shear coefficient of the section.
        /// [1; above 0; default Cowper's; e.g. 0.886]
        pub shear_coefficient: Option<Quantity>,
        /// The section, instead of that of the rod, tube or box.
        /// [table; default that of the shape]
        pub section: Option<At<SectionSpec>>,
        /// Pieces with another section, from the first end to the second.
        /// [list of tables; default none]
        pub steps: Option<At<Vec<At<StepSpec>>>>,
        /// Concentrated masses.
        /// [list of tables; default none]
        pub masses: Option<At<Vec<At<PointMassSpec>>>>,
        /// Places along the link, as shares of its length, whose displacement and stress become columns.
        /// [1; 0 to 1; default 0.25 and 0.75; e.g. [0.1, 0.9]]
        pub stations: Option<At<Vec<Quantity>>>,
        /// Modal data file, beside this file, instead of a beam.
        /// [name of a file; e.g. "coupler.toml"]
        pub data: Option<Name>,
        /// Origin of the floating frame of modal data.
        /// [point; required with `data`; e.g. "A"]
        pub origin: Option<Name>,
        /// x and y axis of the floating frame of modal data in the ground frame at the reference pose.
        /// [directions; at right angles; default those of the ground; e.g. [[1, 0, 0], [0, 1, 0]]]
        pub axes: Option<At<Vec<Triple>>>,
        /// How the drawing is turned; no key.
        #[serde(skip)]
        pub drawn: Drawn,
    }

    /// A section by its numbers.
    #[cfg_attr(test, schemars(extend("required" = ["area", "Iy", "Iz"])))]
    pub struct SectionSpec {
        /// Area.
        /// [m^2; above 0; required; e.g. "113 mm^2"]
        pub area: Option<Quantity>,
        /// Second moment of area about y.
        /// [m^4; above 0; required; e.g. "1018 mm^4"]
        #[serde(rename = "Iy")]
        pub iy: Option<Quantity>,
        /// Second moment of area about z.
        /// [m^4; above 0; required; e.g. "1018 mm^4"]
        #[serde(rename = "Iz")]
        pub iz: Option<Quantity>,
        /// Torsion constant.
        /// [m^4; above 0; default Iy + Iz; e.g. "2036 mm^4"]
        #[serde(rename = "J")]
        pub j: Option<Quantity>,
        /// Distance of the outer fibres in y and z, for stresses.
        /// [m; above 0; default none, and no stress columns; e.g. ["6 mm", "6 mm"]]
        pub fibres: Option<At<Vec<Quantity>>>,
        /// Direction of y in the ground frame at the reference pose.
        /// [direction; default along joints or ground; e.g. [0, 0, 1]]
        pub y_axis: Option<Triple>,
    }

    /// A piece of a stepped link.
    #[cfg_attr(test, schemars(extend("required" = ["to"])))]
    pub struct StepSpec {
        /// Where the piece ends, from the first end of the link.
        /// [m; above the last, up to the length; required; e.g. "150 mm"]
        pub to: Option<Quantity>,
        /// Radius of a round piece.
        /// [m; above 0; default the link's section; e.g. "8 mm"]
        pub radius: Option<Quantity>,
        /// Inner radius of a round piece.
        /// [m; from 0, below `radius`; default 0; e.g. "4 mm"]
        pub inner_radius: Option<Quantity>,
        /// Edge or edges of a rectangular piece.
        /// [m; above 0; default the link's section; e.g. "12 mm"]
        pub width: Option<Widths>,
    }

    /// A mass fixed to the link's axis.
    #[cfg_attr(test, schemars(extend("required" = ["at", "mass"])))]
    pub struct PointMassSpec {
        /// Distance from the first end.
        /// [m; 0 to the length; required; e.g. "210 mm"]
        pub at: Option<Quantity>,
        /// Mass.
        /// [kg; above 0; required; e.g. "50 g"]
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
    /// Frame on the first end, by default on that which joints clamp.
    Clamped,
    /// Frame on the mean axes.
    Free,
    /// Pinned, with the places between where something is attached, and the turns of ends that joints hold, as further modes.
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

without_texts!(TheorySpec, HeldSpec, Drawn);

texts_of! {
    enum Centre { Point, At }
    enum Widths { Square, Rectangle }
}
