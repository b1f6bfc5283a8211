//! From equations to tapes, which is where all rewriting ends.
//! In: [`crate::derive::Equations`]. Out: [`Tape`]s. Never knows mechanics; names travel as labels.

mod at_hand;
mod cut;
mod groups;
mod lower;
mod signs;
mod unshared;

pub use at_hand::{AtHand, Lowered};
pub use linkwear_tape::{
    Binary, Block, Interpreted, Number, Op, Operand, Operations, PART_LIMIT, Part, Recorder, Registers,
    Routine, Split, Statement, Tape, Unary, Value, side_by_side, split, verify,
};
pub use lower::{lower, lower_short};
pub use unshared::unshared_operations;
