//! Bundles as wide as registers are. In: a bundle, turns that are asked for. Out: their answers. Never knows who asks.
//!
//! What is generic in the number of lanes is compiled here, with all that it calls, not in the crate that uses it: between crates
//! (and between parts of one that are optimised alone) small functions are not drawn into their callers.

use super::queue::TurnRequests;
use super::{TurnBundle, TurnRunner};
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

impl<'a> WideBundle<'a> {
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
