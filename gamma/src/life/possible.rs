//! Laws of life that data leave possible. In: laws. Out: all or some of them. Never knows which data.

use super::first_passage::FirstPassage;

/// Laws of life, all equally probable, in the order of their typical lives; none where the parameters are taken as known.
#[derive(Clone, Debug, Default)]
pub struct PossibleLives {
    pub(crate) lives: Vec<FirstPassage>,
}

impl PossibleLives {
    /// The laws.
    pub fn as_slice(&self) -> &[FirstPassage] {
        &self.lives
    }

    /// One of every `step` neighbours, the middle one.
    pub fn one_of(&self, step: usize) -> Self {
        Self { lives: self.lives.iter().skip(step / 2).step_by(step.max(1)).cloned().collect() }
    }
}
