//! Laws of life: when wear that grows by [CS (21)] reaches its threshold.
//! In: a Gamma law of wear, a clock that says how exposure Lambda runs with time, the present state. Out: reliability,
//! density, hazard, quantiles, moments, bands from the uncertainty of the parameters, an error budget, statistics of
//! simulated lives. Never knows how the parameters were estimated, mechanisms, files.
//!
//! Every law of life is a [`Lifetime`]. Time runs from the present, in the unit of the clock.

mod band;
mod budget;
mod clock;
mod error;
mod estimate;
mod law;
mod lifetime;
mod passage;
mod quadrature;
mod slope;
mod statistics;

pub use band::{Band, Bands, Method};
pub use budget::{ErrorBudget, Part};
pub use clock::Clock;
pub use error::LifeError;
pub use estimate::{Estimate, Situation};
pub use law::GammaLaw;
pub use lifetime::{Lifetime, Moments};
pub use passage::Passage;
pub use statistics::{LifeStatistics, Measured};

pub(crate) use error::positive;
pub(crate) use estimate::moved;
pub(crate) use quadrature::integrate;

#[cfg(test)]
mod tests;
