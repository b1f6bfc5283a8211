//! Functions given by rows: `[tables.<name>]`.

#[cfg(test)]
use schemars::JsonSchema;
use serde::Deserialize;

use super::doc::Doc;
use super::texts::{tables, texts_of, without_texts};
use super::written::{At, Name, Quantity};

/// How values between the rows are found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Interpolation {
    /// Straight lines.
    Linear,
    /// Cubics that rise only where the rows do.
    #[default]
    Monotone,
    /// Cubics with continuous second derivatives.
    Spline,
}

/// What holds outside the rows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Outside {
    /// Nothing: a run ends there.
    #[default]
    Refuse,
    /// The nearest row.
    Hold,
    /// The rows again and again.
    Periodic,
}

without_texts!(Interpolation, Outside);

tables! {
    /// A function given by rows, called in formulas by its name.
    #[cfg_attr(test, schemars(extend("oneOf" = [{ "required": ["data"] }, { "required": ["argument", "value"] }])))]
    pub struct TableSpec {
        /// What it is.
        /// [text]
        pub doc: Option<Doc>,
        /// CSV file with two columns, the argument first, and their units in its header: `angle [deg], torque [N m]`.
        /// [text; a file below the folder of the mechanism; default `argument` and `value`; e.g. "torque.csv"]
        pub data: Option<Name>,
        /// Arguments, rising.
        /// [any; 2 to 256; default those of `data`; e.g. ["0 mm", "5 mm", "8 mm"]]
        pub argument: Option<At<Vec<Quantity>>>,
        /// A value for each argument.
        /// [any; as many; default those of `data`; e.g. ["0 N", "120 N", "300 N"]]
        pub value: Option<At<Vec<Quantity>>>,
        /// How values between the rows are found. A drive needs "spline" or "monotone".
        /// [word; default "monotone"; e.g. "spline"]
        pub interpolation: Option<At<Interpolation>>,
        /// What holds outside the rows.
        /// [word; default "refuse"; e.g. "periodic"]
        pub outside: Option<At<Outside>>,
        /// Our own assumption.
        /// [mark]
        pub assumed: bool,
    }
}
