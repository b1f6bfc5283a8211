//! The Gamma process of wear, [CS (21)-(26)]: from measured or computed wear to the distribution of remaining useful
//! life. In: increments of wear and of exposure Lambda, in the units the caller counts in. Out: estimates, draws,
//! laws of life. Never knows mechanisms, dynamics, files or terminals.
//!
//! From readings to a remaining life:
//! ```
//! use linkwear_gamma::data::{Gauge, Observations, Reading};
//! use linkwear_gamma::fit::{Model, estimate};
//! use linkwear_gamma::life::{Method, OperatingState};
//! use linkwear_gamma::{FitFile, Prediction, Questions};
//!
//! // Wear [um] of three bearings every hundred hours.
//! let wear = [[9.0, 21.0, 30.0], [12.0, 19.0, 33.0], [8.0, 22.0, 28.0]];
//! let readings: Vec<Reading> = wear
//!     .iter()
//!     .enumerate()
//!     .flat_map(|(unit, row)| row.iter().enumerate().map(move |(at, wear)| (unit, at, *wear)))
//!     .map(|(unit, at, wear)| Reading {
//!         unit: format!("bearing {unit}"),
//!         exposure: 100.0 * (at + 1) as f64,
//!         wear,
//!         row: 3 * unit + at + 1,
//!         ..Reading::default()
//!     })
//!     .collect();
//! let data = Observations::new(&readings, true, Gauge::Exact)?;
//! let fit = estimate(&data, &Model::default())?;
//! // Shape over rate is the wear of all over the hours of all, exactly.
//! let [alpha, beta] = fit.parameters()[..] else { panic!("two parameters") };
//! assert!((alpha / beta - 91.0 / 900.0).abs() < 1e-9);
//!
//! let estimate = FitFile::new(&fit, &data, &[], ("um", "h"), false).estimate(&[])?;
//! let state = OperatingState::new(50.0)?;
//! let life = Prediction::by_fit(&estimate, &state, Method::Delta, &Questions::default())?;
//! // At a tenth of a micrometre an hour, and half an increment more until the threshold is passed.
//! let (moments, band) = life.moments.ok_or("no mean")?;
//! assert!((495.0..520.0).contains(&moments.mean), "{moments:?} {band:?}");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![deny(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::todo,
    clippy::unimplemented,
    clippy::unreachable
)]
#![warn(missing_docs)]
#![cfg_attr(test, allow(clippy::disallowed_methods))]

pub mod data;
mod error;
pub mod fit;
mod fit_file;
pub mod inspection;
pub mod life;
mod matrix;
pub mod metrics;
pub mod monte_carlo;
pub mod order;
pub mod plan;
mod prediction;
pub mod process;
mod quadrature;
pub mod random;
pub mod series;
pub mod special;

pub use fit_file::{Covariate, FitFile, FitFileError};
pub use prediction::{Answers, AtTime, IntervalKind, Machine, Member, Prediction, Questions};
