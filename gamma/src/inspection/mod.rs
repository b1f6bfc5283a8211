//! What inspections of one joint say about its remaining life.
//! In: readings (time, wear), what was known before. Out: posterior of the parameters, predictive law of the remaining
//! life, a [`crate::life::Lifetime`]. Never knows files.
//!
//! Exact readings: [`Posterior`], by quadrature over the logarithms of the parameters, or [`UnitPosterior`] where units differ. Readings with a known gauge error:
//! [`Particles`].

mod credible;
mod error;
mod history;
mod likelihood;
mod of_units;
mod particles;
mod posterior;
mod prior;

pub use credible::Mixture;
pub use error::InspectionError;
pub use history::{History, Reading};
pub use of_units::UnitPosterior;
pub use particles::{Effort, Particles};
pub use posterior::{LogParameter, Posterior};
pub use prior::Prior;

#[cfg(test)]
mod tests;
