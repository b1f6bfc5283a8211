//! Compiles a linkage described in TOML into specialised solver code.
//!
//! Data flows one way: toml -> `spec` -> `model` -> `derive` -> `expr` -> `tape` -> back ends.

pub mod builder;
pub mod derive;
pub mod expr;
pub mod id;
pub mod model;
pub mod source;
pub mod spec;
#[rustfmt::skip]
pub mod stub; // STUB

#[allow(missing_docs)]
pub mod diagnostic {
    pub use crate::stub::{Diagnostic, Diagnostics, Entry, nearest}; // STUB
}

pub use builder::Builder;
pub use diagnostic::Diagnostics;
pub use model::Closure;
pub use source::SourceFile;
pub use stub::{Compiled, Options, compile}; // STUB
