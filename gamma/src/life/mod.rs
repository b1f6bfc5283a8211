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
mod first_passage;
mod law;
mod lifetime;
mod slope;
mod statistics;

pub use band::{Band, Bands, Method};
pub use budget::{Contribution, ErrorBudget};
pub use clock::Clock;
pub use error::LifeError;
pub use estimate::{Estimate, OperatingState};
pub use first_passage::FirstPassage;
pub use law::GammaLaw;
pub use lifetime::{Lifetime, Moments};
pub use statistics::{LifeStatistics, WithError};

pub(crate) use error::positive;
pub(crate) use estimate::moved;

#[cfg(test)]
mod tests;
