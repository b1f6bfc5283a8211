//! What the life of a joint and that of a machine have alike in their answers.

#[cfg(test)]
use schemars::JsonSchema;
use serde::Serialize;

use super::super::common::{Ends, Quantiles};

/// A number, null where it has no bound.
pub fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

/// Where 95 % of such lives end.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct PredictiveInterval {
    /// Lower end [time]; null where it is open.
    pub lower: Option<f64>,
    /// Upper end [time]; null where it is open: more lives than it leaves out never end.
    pub upper: Option<f64>,
    /// What it takes into account of the parameters: `predictive`, all that the data leave open; `normal`, what the covariance leaves
    /// open; `plug-in`, nothing.
    pub kind: &'static str,
}

/// How far the parameters leave numbers open, at 95 %.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct BandsAnswer {
    /// The mean [time]; null where it is not finite.
    pub mean: Option<Ends>,
    /// The quantiles [time].
    pub quantiles: Quantiles<Ends>,
}
