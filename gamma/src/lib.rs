//! The Gamma process of wear, [CS (21)-(26)]: from measured or computed wear to the distribution of remaining useful
//! life. In: increments of wear and of exposure Lambda, in the units the caller counts in. Out: estimates, draws,
//! laws of life. Never knows mechanisms, dynamics, files or terminals.

#![warn(missing_docs)]

pub mod data;
pub mod fit;
pub mod inspection;
pub mod life;
pub mod metrics;
pub mod monte_carlo;
mod quadrature;
pub mod random;
pub mod series;
pub mod special;
