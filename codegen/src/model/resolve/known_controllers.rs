//! Controllers as far as they are read.

use crate::id::StateId;
use crate::model::{Formula, Sampler, StateVariable};

/// A controller as far as formulas ask for it.
pub(super) struct Controller {
    pub(super) name: String,
    /// What it puts out; nothing of one that is wrong, which is reported.
    pub(super) output: Option<Formula>,
    /// Names of its states.
    pub(super) states: Vec<(String, StateId)>,
}

/// All controllers so far, and the states and samples that they are made of.
#[derive(Default)]
pub(super) struct Controllers {
    pub(super) known: Vec<Controller>,
    pub(super) states: Vec<StateVariable>,
    pub(super) samplers: Vec<Sampler>,
}
