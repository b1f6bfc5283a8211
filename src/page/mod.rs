//! Pages and pictures of a mechanism: what it looks like, how it moves, what becomes of it. In: a compiled mechanism, its run,
//! its life. Out: text of HTML and SVG that names no other file. Never runs anything, and never writes a file.

mod chart;
mod curves;
pub mod document;
pub mod drawing;
mod escape;
mod fits;
mod identified;
mod links;
mod lives;
mod motion;
mod plans;
#[cfg(feature = "png")]
pub mod png;
mod predictions;
mod scene;
mod vector;
mod wheels;

use linkwear_gamma::Prediction;
use linkwear_gamma::data::Observations;
use linkwear_gamma::fit::{Fit, Goodness};
use linkwear_gamma::plan::{AgePlan, Course, Ends};
use linkwear_runtime::Run;
use serde_json::Value;

use chart::Chart;

/// Charts of a run as one picture (SVG).
pub fn run_picture(run: &Run) -> String {
    Chart::file(&curves::charts(run))
}

/// Charts of a life, of which `life --format json` says `json`, as one picture (SVG).
pub fn life_picture(json: &Value) -> String {
    Chart::file(&lives::charts(json))
}

/// Charts of identified parameters as one picture (SVG).
pub fn identified_picture(found: &crate::identify::Identified) -> String {
    Chart::file(&identified::charts(found))
}

/// Charts of a fit as one picture (SVG).
pub fn fit_picture(fit: &Fit, goodness: &Goodness, data: &Observations) -> String {
    Chart::file(&fits::charts(fit, goodness, data))
}

/// The cost of a plan over the age of replacement (SVG).
pub fn plan_picture(course: &Course, plan: &AgePlan, best: Option<Ends>, unit: &str) -> String {
    Chart::file(&[plans::chart(course, plan, best, unit)])
}

/// Charts of a prediction as one picture (SVG).
pub fn prediction_picture(told: &Prediction) -> String {
    Chart::file(&predictions::charts(told))
}
