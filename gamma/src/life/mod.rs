//! Laws of life: when wear that grows by a process reaches its threshold.
//! In: a law of wear, a clock that says how exposure Lambda runs with time, the present state. Out: reliability,
//! density, hazard, quantiles, moments, bands from the uncertainty of the parameters, an error budget, statistics of
//! simulated lives. Never knows how the parameters were estimated, mechanisms, files.
//!
//! Every law of life is a [`Lifetime`]. Time runs from the present, in the unit of the clock.

mod band;
mod budget;
mod clock;
mod counted;
mod estimate;
mod first_passage;
mod law;
mod lifetime;
mod mixture;
mod observed;
mod ordered;
mod possible;
mod state;
mod statistics;
mod survived;
#[cfg(test)]
mod weibull;

pub use crate::error::LifeError;
pub(crate) use band::variance;
pub use band::{Band, Bands, Method, Scale};
pub use budget::{Contribution, ErrorBudget};
pub use clock::Clock;
pub use counted::CountedLives;
pub use estimate::{Estimate, ParameterSet, Sample, SeenUnit};
pub use first_passage::FirstPassage;
pub use law::Law;
pub(crate) use lifetime::mixed_hazard;
pub use lifetime::{Lifetime, Moments};
pub use mixture::LifeMixture;
pub use observed::ObservedLives;
pub use possible::PossibleLives;
pub use state::OperatingState;
pub use statistics::{LifeStatistics, WithError};
pub use survived::Survived;
#[cfg(test)]
pub(crate) use weibull::Weibull;

#[cfg(test)]
mod tests;
