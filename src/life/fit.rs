//! A fit to measured wear that a joint wears by.

use linkwear_gamma::life::Estimate;

/// alpha and beta of a joint by a fit to measured wear.
#[derive(Clone, Debug, PartialEq)]
pub struct JointFit {
    /// The joint.
    pub joint: String,
    /// Where the fit is from, to report. Joints whose fits are from the same place err together.
    pub from: String,
    /// alpha and beta [1/µm], wear and Lambda of its data counted in micrometres.
    pub estimate: Estimate,
}
