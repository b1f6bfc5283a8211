//! One function of a mechanism as a straight line of statements: what every back end runs, operation by operation.
//!
//! Generators make [`Tape`]s, one per [`linkwear_runtime::Entry`]. From then on nothing is rewritten: back ends must not
//! reorder, fuse or fold, so that they agree in every bit. [`Interpreted`] runs tapes without a compiler; [`Program`]
//! is all of a mechanism that a run needs, and comes back from bytes as it was.

#![deny(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::todo,
    clippy::unimplemented,
    clippy::unreachable
)]

mod block;
mod constants;
mod evaluate;
mod interpreter;
mod needed;
mod operation;
mod operations;
mod program;
mod recorder;
mod registers;
mod side_by_side;
mod split;
pub mod stored;
mod tangent;
mod tape;
mod tapes;
mod verify;

pub use block::Block;
pub use interpreter::{Interpreted, Routine};
pub use operation::{Binary, Op, Operand, Unary, Value};
pub use operations::Operations;
pub use program::Program;
pub use recorder::{Mask, Number, Recorder};
pub use registers::Registers;
pub use side_by_side::side_by_side;
pub use split::{PART_LIMIT, Part, Split, split};
pub use tape::{Statement, Tape};
pub use tapes::Tapes;
pub use verify::verify;
