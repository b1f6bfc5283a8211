//! Back ends: each runs or writes tapes, operation by operation. They know tapes, never mechanics.

pub mod c;
mod comment;
mod interface;
mod names;
pub mod rust;

/// Runs tapes without a compiler.
pub mod interp {
    pub use linkwear_tape::Interpreted;
}
