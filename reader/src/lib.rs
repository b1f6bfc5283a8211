//! Reads mechanism files: a [`SourceFile`] into a [`spec::Spec`], every value with its place; what is wrong with a file as [`Diagnostics`].
//!
//! The first stage of the generator, toml -> spec. It knows names, units and tables of a file, and no mechanics: what
//! the values mean is the model's, in `linkwear-codegen`, which hands these modules on. A crate of its own so that it
//! need not be compiled to be fast.

#![deny(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::todo,
    clippy::unimplemented,
    clippy::unreachable
)]

pub mod diagnostic;
pub mod input;
pub mod limits;
pub mod source;
pub mod spec;

pub use diagnostic::Diagnostics;
pub use source::SourceFile;
