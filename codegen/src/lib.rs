//! Compiles a linkage described in TOML into specialised solver code.
//!
//! Data flows one way: toml -> `spec` -> `model` -> `derive` -> `expr` -> `tape` -> back ends.

pub mod derive;
pub mod diagnostic;
pub mod expr;
pub mod id;
pub mod model;
pub mod source;
pub mod spec;
