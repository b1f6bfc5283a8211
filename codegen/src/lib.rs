//! Compiles a linkage described in TOML into specialised solver code.
//!
//! Data flows one way: toml -> [`spec`] -> [`model`] -> [`derive`](mod@derive) -> [`expr`] -> [`tape`] ->
//! [`backend`]s; [`mod@compile`] calls the stages in order. The first stage is the crate `linkwear-reader`. A build script needs only [`Builder`].

#![deny(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::todo,
    clippy::unimplemented,
    clippy::unreachable
)]

pub mod backend;
pub mod builder;
pub mod compile;
mod decompose;
pub mod derive;
pub mod expr;
pub mod flexible;
pub mod id;
pub mod model;
pub mod preflight;
pub mod render;
mod sparse_rows;
pub mod tape;

pub use builder::Builder;
pub use compile::{Compiled, Options, compile};
pub use diagnostic::Diagnostics;
pub use linkwear_reader::{diagnostic, input, limits, source, spec};
pub use model::Closure;
pub use source::SourceFile;
