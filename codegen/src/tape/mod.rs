//! From equations to tapes, which is where all rewriting ends.
//! In: [`crate::derive::Equations`]. Out: [`Tape`]s. Never knows mechanics; names travel as labels.

mod at_hand;
mod cut;
mod groups;
mod lower;
mod short;
mod signs;
mod unshared;

pub use at_hand::{AtHand, Lowered};
pub use linkwear_tape::{
    Binary, Block, Interpreted, Number, Op, Operand, Operations, PART_LIMIT, Part, Recorder, Registers,
    Routine, Split, Statement, Tape, Tapes, Unary, Value, side_by_side, split, verify,
};
pub use lower::lower;
pub use short::ShortTapes;
pub use unshared::unshared_operations;
