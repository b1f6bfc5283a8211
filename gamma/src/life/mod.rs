//! Laws of life: when wear reaches its threshold, [CS (24), (26)].
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
mod normal;
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

pub(crate) use error::{non_negative, positive};
pub(crate) use estimate::Factor;
pub(crate) use normal::{Normals, standard_normal_cdf, standard_normal_density, standard_normal_quantile};
pub(crate) use quadrature::integrate;
