//! Back ends: each runs or writes tapes, operation by operation. They know tapes, never mechanics.

pub mod interp;
pub mod rust;
