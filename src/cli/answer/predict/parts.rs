//! What the life of a joint and that of a machine have alike in their answers.

#[cfg(test)]
use schemars::JsonSchema;
use serde::Serialize;

use super::super::common::{Ends, Quantiles};

/// Where 95 % of such lives end.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct PredictiveInterval {
    /// Lower end [time].
    pub lower: f64,
    /// Upper end [time].
    pub upper: f64,
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
