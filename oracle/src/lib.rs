//! An independent numeric model of a mechanism: the oracle of linkwear's tests.
//!
//! The generator derives equations symbolically, in joint coordinates, along a spanning tree. This crate
//! answers the same questions in another way, so that a mistake in one is not repeated in the other:
//! every body has six absolute coordinates, every joint is a set of constraint rows, and
//! `[M Gᵀ; G 0]` is solved by singular values. It knows no tree, no cut joint and no symbol.
//! Both share only the description, [`linkwear_codegen::model::Mechanism`].
//!
//! In: a mechanism and parameter values. Out: accelerations, wrenches, energies, trajectories.

mod assemble;
mod channels;
mod check;
pub mod closed_form;
mod error;
mod force;
mod formula;
mod frame;
mod integrate;
mod jet;
mod joint;
mod kind;
mod least_norm;
mod mass;
mod model;
mod pieces;
mod place;
pub mod random;
mod row;
mod solve;

pub use assemble::{AssemblyError, Wish};
pub use error::OracleError;
pub use formula::{State, evaluate};
pub use frame::{BodyState, Load};
pub use integrate::{IntegrationError, Tolerance};
pub use jet::Jet;
pub use joint::JointMotion;
pub use kind::Kind;
pub use mass::MassProperties;
pub use model::Oracle;
pub use solve::{Solution, Wrench};
