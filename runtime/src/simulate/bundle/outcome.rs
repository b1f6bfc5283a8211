//! What becomes of a turn in a lane. Never knows lanes.

use crate::simulate::turns::{TurnMeasures, TurnState};

/// How a turn in a lane ended.
#[derive(Clone, Debug, PartialEq)]
pub enum TurnOutcome {
    /// It is done: what it did, and where it got.
    Done(Box<(TurnMeasures, TurnState)>),
    /// It has to be run alone, from where it began.
    Alone,
}
