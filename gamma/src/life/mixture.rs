//! The law of a life mixed from those at possible parameters. In: weighted parameters, a state. Out: a [`Lifetime`]. Never knows
//! where the parameters are from.

use super::estimate::{Estimate, ParameterSet};
use super::first_passage::FirstPassage;
use super::lifetime::Lifetime;
use super::state::OperatingState;
use crate::error::LifeError;
use crate::random::Stream;

/// Lives at parameters, each with its probability.
#[derive(Debug)]
pub struct LifeMixture {
    lives: Vec<(f64, FirstPassage)>,
    typical: f64,
}

impl LifeMixture {
    /// Where the logarithms of the parameters are normal with the covariance of an estimate: `count` draws by a seed of its own.
    ///
    /// # Errors
    /// [`LifeError`] if drawn parameters leave the range of numbers.
    pub fn normal(estimate: &Estimate, state: &OperatingState, count: usize) -> Result<Self, LifeError> {
        const SEED: u64 = 0;
        // One stream for each draw, the joint 0: more draws leave the first ones as they are.
        let drawn = |at: usize| estimate.drawn_logs(&mut Stream::new(SEED, at as u64, 0));
        let sets = (0..count).map(|at| ParameterSet { logs: drawn(at), weight: 1.0 / count as f64 });
        Self::new(estimate, state, sets)
    }

    /// Where the parameters are these sets of `estimate`'s process.
    ///
    /// # Errors
    /// [`LifeError`] if parameters leave the range of numbers.
    pub fn of_sets(
        estimate: &Estimate,
        state: &OperatingState,
        sets: &[ParameterSet],
    ) -> Result<Self, LifeError> {
        Self::new(estimate, state, sets.iter().cloned())
    }

    fn new(
        estimate: &Estimate,
        state: &OperatingState,
        sets: impl Iterator<Item = ParameterSet>,
    ) -> Result<Self, LifeError> {
        let life = |set: ParameterSet| Ok((set.weight, state.life_by(estimate, &set.logs)?));
        Ok(Self {
            lives: sets.map(life).collect::<Result<_, _>>()?,
            typical: state.life(estimate)?.typical(),
        })
    }

    /// Lives with their probabilities.
    pub fn lives(&self) -> impl Iterator<Item = (f64, &FirstPassage)> {
        self.lives.iter().map(|(weight, life)| (*weight, life))
    }

    fn mean(&self, of: impl Fn(&FirstPassage) -> f64) -> f64 {
        self.lives.iter().map(|(weight, life)| weight * of(life)).sum()
    }
}

impl Lifetime for LifeMixture {
    fn reliability(&self, t: f64) -> f64 {
        self.mean(|life| life.reliability(t))
    }

    fn failed(&self, t: f64) -> f64 {
        self.mean(|life| life.failed(t))
    }

    fn typical(&self) -> f64 {
        self.typical
    }

    fn ever(&self) -> f64 {
        self.mean(FirstPassage::ever)
    }

    fn finite_moments(&self) -> Result<(), LifeError> {
        self.lives.first().map_or(Ok(()), |(_, life)| life.finite_moments())
    }
}
