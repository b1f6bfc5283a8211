//! State variables of a file's own: `[states.<name>]`.

#[cfg(test)]
use schemars::JsonSchema;
use serde::Deserialize;

use super::doc::Doc;
use super::texts::{tables, texts_of};
use super::written::Quantity;

tables! {
    /// A quantity that the run integrates along with the motion.
    #[cfg_attr(test, schemars(extend("required" = ["rate"])))]
    pub struct StateSpec {
        /// Value at the start; its unit is that of the state.
        /// [any unit; over parameters; default 0; e.g. "20 degC"]
        pub initial: Option<Quantity>,
        /// Rate in time, over all that a force may depend on, states included.
        /// [unit of the state per second; required; e.g. "(target - x)/(50 ms)"]
        pub rate: Option<Quantity>,
        /// Our own assumption.
        /// [mark]
        pub assumed: bool,
        /// What it is.
        /// [text]
        pub doc: Option<Doc>,
    }
}
