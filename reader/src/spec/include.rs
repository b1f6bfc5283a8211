//! Files that a mechanism is put together of: `[include.<name>]`.

#[cfg(test)]
use schemars::JsonSchema;
use serde::Deserialize;

use super::doc::Doc;
use super::texts::{tables, texts_of};
use super::written::{At, Name, Quantity, Table, Triple};

tables! {
    /// A mechanism file as a part of this one. Its names get that of the part before them: `left.R1`.
    #[cfg_attr(test, schemars(extend("required" = ["file"])))]
    pub struct IncludeSpec {
        /// The part's file, a mechanism file of its own.
        /// [text; a file below the folder of this one; required; e.g. "leg.toml"]
        pub file: Option<Name>,
        /// Values of the part's parameters instead of those in its file, over parameters of this file.
        /// [table of quantities; default those of the file; e.g. { L = "80 mm" }]
        pub parameters: Table<Quantity>,
        /// Bodies of the part, or its "ground", that are bodies of this file: the part's own are left out.
        /// [table of bodies; default none; e.g. { base = "frame" }]
        pub bodies: Table<Name>,
        /// Where the origin of the part's drawing is.
        /// [m; any; default the origin of this file; e.g. ["200 mm", 0, 0]]
        pub origin: Option<Triple>,
        /// How the part's drawing is turned about that origin.
        /// [table; default not at all]
        pub rotation: Option<At<RotationSpec>>,
        /// What it is.
        /// [text]
        pub doc: Option<Doc>,
    }

    /// A turn about an axis, in numbers.
    #[cfg_attr(test, schemars(extend("required" = ["axis", "angle"])))]
    pub struct RotationSpec {
        /// Axis, of any length.
        /// [direction; numbers; required; e.g. [0, 0, 1]]
        pub axis: Option<Triple>,
        /// Angle by the right-hand rule.
        /// [rad; a quantity; required; e.g. "90 deg"]
        pub angle: Option<Quantity>,
    }
}
