//! Estimation of the processes of wear by maximum likelihood, [CS (25)], [CS (26)]. In: observed wear. Out: estimates with
//! their uncertainty. Never knows files or terminals.
//!
//! Wear grows by independent increments whose law depends on dLambda, for the Gamma process dW ~ Gamma(shape alpha dLambda,
//! rate beta). Lambda is the exposure as given, or exposure^c with c estimated, times covariates to powers b.

mod bootstrap;
mod bounds;
mod cv_interval;
mod drawn_falls;
mod drawn_units;
mod error;
mod estimate;
mod exact;
mod few_increments;
mod few_units;
mod goodness;
mod heterogeneity;
mod hidden_scatter;
mod interval;
mod likelihood;
mod maximise;
mod model;
mod parameter_sets;
mod point;
mod rounded;
mod units;

pub use bootstrap::{Bootstrap, bootstrap};
pub use error::FitError;
pub use estimate::{Fit, LikelihoodRatio, likelihood_ratio};
pub use goodness::{Goodness, goodness};
pub use heterogeneity::{Heterogeneity, UnitsTest, estimate, estimate_units};
pub use hidden_scatter::{hidden_scatter, interval};
pub use interval::{Interval, profile_interval};
pub use model::Model;
pub(crate) use parameter_sets::parameter_sets;

#[cfg(test)]
mod tests;
