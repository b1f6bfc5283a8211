//! The Gamma process of wear, [CS (21)-(26)]: from measured or computed wear to the distribution of remaining useful
//! life. In: increments of wear and of exposure Lambda, in the units the caller counts in. Out: estimates, draws,
//! laws of life. Never knows mechanisms, dynamics, files or terminals.

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
