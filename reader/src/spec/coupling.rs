//! Couplings of joint coordinates as written, and their kinds as data: each is one row of [`COUPLING_KINDS`], which says
//! what its keys are.

#[cfg(test)]
use schemars::JsonSchema;
use serde::Deserialize;

use super::doc::Doc;
use super::texts::{tables, texts_of, without_texts};
use super::written::{At, Literal, Name, Quantity, Table};

tables! {
    /// A coupling of joint coordinates: exactly one of `gears`, `bevel`, `worm`, `rack`, `belt`, `planetary`,
    /// `differential`, `relation`. It holds at the reference pose.
    #[cfg_attr(test, schemars(extend("oneOf" = [
        { "required": ["gears", "teeth"] }, { "required": ["bevel", "teeth", "at"] },
        { "required": ["worm", "teeth"] }, { "required": ["rack", "at"] },
        { "required": ["belt", "radii"] }, { "required": ["planetary", "teeth"] },
        { "required": ["differential"] }, { "required": ["relation"] }
    ], "allOf" = [{
        "if": { "required": ["rack"] },
        "then": { "properties": { "teeth": { "minItems": 1, "maxItems": 1 } } },
        "else": { "properties": { "teeth": { "minItems": 2, "maxItems": 2 } } }
    }])))]
    pub struct CouplingSpec {
        /// Two wheels with parallel axes, spur or helical, external or internal.
        /// [two bodies; e.g. ["pinion", "wheel"]]
        #[cfg_attr(test, schemars(extend("minItems" = 2, "maxItems" = 2)))]
        pub gears: Option<At<Vec<Name>>>,
        /// Two bevel wheels, whose axes meet.
        /// [two bodies; e.g. ["pinion", "crown"]]
        #[cfg_attr(test, schemars(extend("minItems" = 2, "maxItems" = 2)))]
        pub bevel: Option<At<Vec<Name>>>,
        /// A worm and its wheel, with axes at right angles.
        /// [two bodies; e.g. ["worm", "wheel"]]
        #[cfg_attr(test, schemars(extend("minItems" = 2, "maxItems" = 2)))]
        pub worm: Option<At<Vec<Name>>>,
        /// A pinion and a rack.
        /// [two bodies; e.g. ["pinion", "rack"]]
        #[cfg_attr(test, schemars(extend("minItems" = 2, "maxItems" = 2)))]
        pub rack: Option<At<Vec<Name>>>,
        /// Two pulleys or sprockets of a belt or chain, with parallel axes.
        /// [two bodies; e.g. ["motor", "fan"]]
        #[cfg_attr(test, schemars(extend("minItems" = 2, "maxItems" = 2)))]
        pub belt: Option<At<Vec<Name>>>,
        /// Sun, ring and carrier of a planetary set, whose planets are no bodies of the file.
        /// [three bodies; e.g. ["sun", "ring", "arm"]]
        #[cfg_attr(test, schemars(extend("minItems" = 3, "maxItems" = 3)))]
        pub planetary: Option<At<Vec<Name>>>,
        /// The two side shafts of a differential and its cage.
        /// [three bodies; e.g. ["left", "right", "cage"]]
        #[cfg_attr(test, schemars(extend("minItems" = 3, "maxItems" = 3)))]
        pub differential: Option<At<Vec<Name>>>,
        /// Factors of joint coordinates whose sum stays the same; a joint with several is written as `"C.q2"`.
        /// [table of factors; e.g. { R1 = 1, P1 = "-400 1/m" }]
        pub relation: Option<Table<Literal>>,
        /// Numbers of teeth, of a worm its starts; of a planetary set those of sun and ring.
        /// [1; whole, above 0; required of gears, bevel, worm and planetary; e.g. [20, 60]]
        pub teeth: Option<At<Vec<Quantity>>>,
        /// Pitch radii of pulleys or sprockets.
        /// [m; above 0; required of a belt; e.g. ["40 mm", "80 mm"]]
        #[cfg_attr(test, schemars(extend("minItems" = 2, "maxItems" = 2)))]
        pub radii: Option<At<Vec<Quantity>>>,
        /// Module in the normal plane, against which the drawing is held; of a worm its axial module.
        /// [m; above 0; default from the drawing, of a worm required; e.g. "2 mm"]
        pub module: Option<Quantity>,
        /// Pitch point: where teeth mesh, in the middle of the face width.
        /// [point; required of bevel and rack, default beside the first wheel's joint; e.g. "P"]
        pub at: Option<Name>,
        /// Body that carries the axes of both wheels.
        /// [body; default found; e.g. "arm"]
        pub carrier: Option<Name>,
        /// The larger wheel has its teeth inside.
        /// [true or false; default false; e.g. true]
        pub internal: Option<At<bool>>,
        /// The belt is crossed: the wheels turn against each other.
        /// [true or false; default false; e.g. true]
        pub crossed: Option<At<bool>>,
        /// Pressure angle in the normal plane.
        /// [rad; from 0, below 45 deg; default 20 deg; e.g. "14.5 deg"]
        pub pressure_angle: Option<Quantity>,
        /// Helix angle of the first wheel's teeth at the pitch circle.
        /// [rad; from 0, below 60 deg; default 0; e.g. "15 deg"]
        pub helix_angle: Option<Quantity>,
        /// Hand of the first wheel's teeth or of the worm's thread.
        /// [word; default "right"; e.g. "left"]
        pub hand: Option<At<Hand>>,
        /// Tension of each strand of a belt at rest.
        /// [N; from 0; default 0: the slack strand carries nothing; e.g. "200 N"]
        pub tension: Option<Quantity>,
        /// Stiffness of the teeth or of the belt along the pitch line, of `planetary` and `differential` about their line;
        /// without it the coupling is rigid.
        /// [N/m or N m; above 0; default rigid; e.g. "2e8 N/m"]
        pub stiffness: Option<Quantity>,
        /// Damping beside it.
        /// [N s/m or N m s; from 0; default 0; e.g. "500 N s/m"]
        pub damping: Option<Quantity>,
        /// Backlash: how far one side moves along the pitch line before the other flank touches.
        /// [m or rad; from 0; default 0; e.g. "0.1 mm"]
        pub backlash: Option<Quantity>,
        /// What the sum of a relation is.
        /// [rad or m; any; default 0; e.g. "30 deg"]
        pub offset: Option<Quantity>,
        /// Our own assumption.
        /// [mark]
        pub assumed: bool,
        /// What it is.
        /// [text]
        pub doc: Option<Doc>,
    }
}

/// Hand of a helix.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Hand {
    /// Turned about its axis as seen along it, clockwise, it advances.
    #[default]
    Right,
    /// The other.
    Left,
}

without_texts!(Hand);

/// The bodies that a kind names.
pub type NamedBodies = fn(&CouplingSpec) -> Option<&At<Vec<Name>>>;

/// A kind of coupling.
#[derive(Debug)]
pub struct CouplingKind {
    /// Key in a file.
    pub name: &'static str,
    /// The key with what it names, for advice.
    pub example: &'static str,
    /// The bodies that it names; nothing for a relation, which names joints.
    pub bodies: Option<NamedBodies>,
    /// How many bodies.
    pub count: usize,
    /// Keys that it takes besides its own and [`COMPLIANCE_KEYS`].
    pub keys: &'static [&'static str],
    /// Of these, what must not be missing, with advice.
    pub needs: &'static [(&'static str, &'static str)],
}

/// Keys that every kind takes.
pub const COMPLIANCE_KEYS: [&str; 3] = ["stiffness", "damping", "backlash"];

const TEETH: (&str, &str) = ("teeth", "add `teeth = [20, 60]`");

/// Every kind of coupling.
pub static COUPLING_KINDS: &[CouplingKind] = &[
    CouplingKind {
        name: "gears",
        example: r#"gears = ["pinion", "wheel"]"#,
        bodies: Some(|spec| spec.gears.as_ref()),
        count: 2,
        keys: &["teeth", "module", "at", "carrier", "internal", "pressure_angle", "helix_angle", "hand"],
        needs: &[TEETH],
    },
    CouplingKind {
        name: "bevel",
        example: r#"bevel = ["pinion", "crown"]"#,
        bodies: Some(|spec| spec.bevel.as_ref()),
        count: 2,
        keys: &["teeth", "module", "at", "carrier", "pressure_angle"],
        needs: &[
            TEETH,
            ("at", "add `at = \"P\"`, the point where the pitch cones touch in the middle of the face"),
        ],
    },
    CouplingKind {
        name: "worm",
        example: r#"worm = ["worm", "wheel"]"#,
        bodies: Some(|spec| spec.worm.as_ref()),
        count: 2,
        keys: &["teeth", "module", "carrier", "pressure_angle", "hand"],
        needs: &[
            ("teeth", "add `teeth = [1, 40]`, the starts of the worm first"),
            ("module", "add `module = \"2 mm\"`, that of the wheel"),
        ],
    },
    CouplingKind {
        name: "rack",
        example: r#"rack = ["pinion", "rack"]"#,
        bodies: Some(|spec| spec.rack.as_ref()),
        count: 2,
        keys: &["teeth", "module", "at", "carrier", "pressure_angle"],
        needs: &[("at", "add `at = \"P\"`, where the rack's pitch line touches the pitch circle")],
    },
    CouplingKind {
        name: "belt",
        example: r#"belt = ["motor", "fan"]"#,
        bodies: Some(|spec| spec.belt.as_ref()),
        count: 2,
        keys: &["radii", "teeth", "carrier", "crossed", "tension"],
        needs: &[("radii", r#"add `radii = ["40 mm", "80 mm"]`"#)],
    },
    CouplingKind {
        name: "planetary",
        example: r#"planetary = ["sun", "ring", "arm"]"#,
        bodies: Some(|spec| spec.planetary.as_ref()),
        count: 3,
        keys: &["teeth"],
        needs: &[("teeth", "add `teeth = [30, 90]`, those of the sun first")],
    },
    CouplingKind {
        name: "differential",
        example: r#"differential = ["left", "right", "cage"]"#,
        bodies: Some(|spec| spec.differential.as_ref()),
        count: 3,
        keys: &[],
        needs: &[],
    },
    CouplingKind {
        name: "relation",
        example: r#"relation = { R1 = 1, R2 = -2.5 }"#,
        bodies: None,
        count: 0,
        keys: &["offset"],
        needs: &[],
    },
];

impl CouplingKind {
    /// Whether this key is written.
    pub fn is_written(&self, spec: &CouplingSpec) -> bool {
        match self.bodies {
            Some(bodies) => bodies(spec).is_some(),
            None => spec.relation.is_some(),
        }
    }
}
