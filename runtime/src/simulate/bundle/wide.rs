//! Bundles as wide as registers are. In: a bundle, turns that are asked for. Out: their answers. Never knows who asks.
//!
//! What is generic in the number of lanes is compiled here, with all that it calls, not in the crate that uses it: between crates
//! (and between parts of one that are optimised alone) small functions are not drawn into their callers.

use super::queue::TurnRequests;
use super::{TurnBundle, TurnOutcome, TurnRunner, TurnState};
use crate::bundle::Bundle;
use crate::error::RunError;

/// Steps of one mechanism, by as many lanes as a processor has.
#[derive(Clone, Copy)]
pub enum WideBundle<'a> {
    /// Of AVX2.
    Four(&'a dyn Bundle<4>),
    /// Of AVX-512.
    Eight(&'a dyn Bundle<8>),
}

/// A [`TurnBundle`], however many lanes it has.
pub trait LaneTurns<'a> {
    /// As [`TurnBundle::free_lane`].
    fn free_lane(&self) -> Option<usize>;
    /// As [`TurnBundle::is_idle`].
    fn is_idle(&self) -> bool;
    /// As [`TurnBundle::begin`].
    ///
    /// # Errors
    /// As [`TurnBundle::begin`].
    fn begin(&mut self, lane: usize, from: &TurnState, looked_at: Option<Vec<f64>>)
    -> Result<bool, RunError>;
    /// As [`TurnBundle::step`].
    fn step(&mut self, ended: &mut dyn FnMut(usize, TurnOutcome));
    /// Gives up all turns.
    fn cancel_all(&mut self);
}

impl<'a, const N: usize> LaneTurns<'a> for TurnBundle<'a, N> {
    fn free_lane(&self) -> Option<usize> {
        Self::free_lane(self)
    }

    fn is_idle(&self) -> bool {
        Self::is_idle(self)
    }

    fn begin(
        &mut self,
        lane: usize,
        from: &TurnState,
        looked_at: Option<Vec<f64>>,
    ) -> Result<bool, RunError> {
        Self::begin(self, lane, from, looked_at)
    }

    fn step(&mut self, ended: &mut dyn FnMut(usize, TurnOutcome)) {
        Self::step(self, ended);
    }

    fn cancel_all(&mut self) {
        (0..N).for_each(|lane| self.cancel(lane));
    }
}

impl<'a> WideBundle<'a> {
    /// Its lanes, for who runs turns in them one step at a time; `runner` as for [`Self::serve`].
    ///
    /// # Errors
    /// What making a runner reports.
    pub fn turns(
        self,
        runner: &dyn Fn() -> Result<TurnRunner<'a>, RunError>,
    ) -> Result<Box<dyn LaneTurns<'a> + 'a>, RunError> {
        Ok(match self {
            Self::Four(bundle) => Box::new(TurnBundle::new(bundle, runner)?),
            Self::Eight(bundle) => Box::new(TurnBundle::new(bundle, runner)?),
        })
    }

    /// Runs what is asked for until nobody can ask any more; `runner` makes a runner of the mechanism that the bundle has the
    /// equations of.
    ///
    /// # Errors
    /// What making a runner reports.
    pub fn serve(
        self,
        runner: &dyn Fn() -> Result<TurnRunner<'a>, RunError>,
        requests: TurnRequests,
    ) -> Result<(), RunError> {
        match self {
            Self::Four(bundle) => TurnBundle::new(bundle, runner)?.serve(requests),
            Self::Eight(bundle) => TurnBundle::new(bundle, runner)?.serve(requests),
        }
        Ok(())
    }
}
