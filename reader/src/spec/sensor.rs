//! Named values of a run: `[sensors]`.

#[cfg(test)]
use schemars::JsonSchema;
use serde::Deserialize;

use super::doc::Doc;
use super::texts::{tables, texts_of};
use super::written::Quantity;

/// A formula with a column of its own, which other formulas may use by its name.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename = "$linkwear::ByForm")]
#[cfg_attr(test, derive(JsonSchema), schemars(rename = "Sensor", untagged))]
pub enum Sensor {
    /// Without a sentence.
    #[serde(rename = "scalar", alias = "list")]
    Plain(Quantity),
    /// With a sentence.
    #[serde(rename = "table")]
    Told(SensorTable),
}

texts_of! { enum Sensor { Plain, Told } }

tables! {
    /// A sensor with a sentence about it.
    #[cfg_attr(test, schemars(extend("required" = ["value"])))]
    pub struct SensorTable {
        /// Formula over all that a force may depend on, sensors above it included.
        /// [any unit; required; e.g. "sqrt(R1.Fx^2 + R1.Fy^2)"]
        pub value: Option<Quantity>,
        /// What it is.
        /// [text]
        pub doc: Option<Doc>,
    }
}

impl Sensor {
    /// Its formula.
    pub fn value(&self) -> Option<&Quantity> {
        match self {
            Self::Plain(value) => Some(value),
            Self::Told(table) => table.value.as_ref(),
        }
    }
}
