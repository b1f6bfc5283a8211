//! State variables of a file's own: quantities that a formula gives the rate of.

use super::Formula;
use crate::source::Span;

/// A quantity that the run integrates along with the motion.
#[derive(Clone, Debug)]
pub struct StateVariable {
    /// Name in the file.
    pub name: String,
    /// Value at the start, over parameters.
    pub initial: Formula,
    /// Rate in time, over all that forces may depend on; its dimension is that of the value per second.
    pub rate: Formula,
    /// What it is from the next sample of its controller on, of one that is held between samples: its rate is then zero.
    pub next: Option<Formula>,
    /// Where it is written.
    pub span: Span,
}
