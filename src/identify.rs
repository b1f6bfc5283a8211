//! From measurements to the numbers of a model: which values of some parameters come nearest to what was measured, how sure that is,
//! and what the measurements cannot tell. In: free parameters with bounds, readings, a [`Model`] of them. Out: [`Identified`].
//! Never touches files or terminals.
//!
//! Weighted least squares within bounds from several starts; errors from sensitivities, and from the profile of the likelihood where
//! that is no parabola. What readings cannot tell apart has no number: [`State::NotIdentified`].

mod clocks;
mod curve;
mod differences;
mod directions;
mod errors;
mod free;
mod inference;
mod machine;
mod noise;
mod problem;
mod profile;
mod readings;
mod residuals;
mod result;
mod search;
mod starts;
#[cfg(test)]
mod tests;
mod told;
mod wear;

pub use clocks::{Clock, Clocks};
pub use curve::{Curve, CurveColumn};
pub use errors::{IdentifyError, ModelFault};
pub use free::{Free, FreeError};
pub use machine::Machine;
pub use problem::Model;
pub use readings::{Group, Readings};
pub use residuals::Whiteness;
#[cfg(feature = "cli")]
pub(crate) use residuals::probability;
pub use result::{Combination, Direction, Estimated, GroupFit, Identified, Minimum, Misfit, State};
pub use starts::{IdentifySettings, identify};
pub use wear::{Inspections, WearPath, WornJoint};
