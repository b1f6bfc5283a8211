//! Duty cycles: `[missions.<name>]`, with a table for each of their segments.

#[cfg(test)]
use schemars::JsonSchema;
use serde::Deserialize;

use super::doc::Doc;
use super::texts::{tables, texts_of};
use super::written::{At, Name, Quantity, Table};

tables! {
    /// A duty cycle: how a machine that wears is used, by segments or by a measured series.
    #[cfg_attr(test, schemars(extend("anyOf" = [{ "required": ["segments"] }, { "required": ["series"] }])))]
    pub struct MissionSpec {
        /// What it is.
        /// [text]
        pub doc: Option<Doc>,
        /// Its segments, each with its share of the operating time or its duration.
        /// [table; default those of `series`]
        pub segments: Table<SegmentSpec>,
        /// Measured series instead of segments: a CSV file with a column of time and columns of parameters or inputs.
        /// [text; a file below the folder of the mechanism; e.g. "shift.csv"]
        pub series: Option<Name>,
        /// Bins of every column of the series.
        /// [1; 1 to 64; default 8; e.g. 12]
        pub bins: Option<At<i64>>,
    }

    /// A segment of a duty cycle.
    #[cfg_attr(test, schemars(extend("oneOf" = [{ "required": ["share"] }, { "required": ["duration"] }])))]
    pub struct SegmentSpec {
        /// Share of the operating time, or "rest".
        /// [1; above 0; default `duration`; e.g. "60 %"]
        pub share: Option<Quantity>,
        /// How long it lasts, in the order of the file.
        /// [s; above 0; default `share`; e.g. "2 h"]
        pub duration: Option<Quantity>,
        /// Values of tunable parameters and inputs.
        /// [table of quantities; default those of the mechanism; e.g. { speed = "2 Hz" }]
        pub set: Table<Quantity>,
        /// Factor on the friction of all joints with clearance.
        /// [1; from 0; default 1; e.g. 1.2]
        pub friction: Option<Quantity>,
        /// Factor on the wear coefficient of all joints that wear.
        /// [1; above 0; default 1; e.g. 2]
        pub wear: Option<Quantity>,
        /// Factors of single joints, in the place of those of the segment.
        /// [table]
        pub joints: Table<SegmentJointSpec>,
        /// Our own assumption.
        /// [mark]
        pub assumed: bool,
    }

    /// A joint in a segment.
    pub struct SegmentJointSpec {
        /// Factor on its friction.
        /// [1; from 0; default that of the segment; e.g. 1.2]
        pub friction: Option<Quantity>,
        /// Factor on its wear coefficient.
        /// [1; above 0; default that of the segment; e.g. 2]
        pub wear: Option<Quantity>,
    }
}
