//! Back ends: each runs or writes tapes, operation by operation. They know tapes, never mechanics.

pub mod c;
mod comment;
mod interface;
mod names;
pub mod rust;
mod start;

pub use start::Start;

/// Runs tapes without a compiler.
pub mod interp {
    pub use linkwear_tape::Interpreted;
}
