//! Turns of one trajectory in whole steps of machine code: a bundle of one lane. In: a runner, at a turn's begin. Out: what the turn
//! did. Never knows other trajectories.

use std::slice;

use super::lanes::Lanes;
use super::outcome::TurnOutcome;
use super::step;
use super::trajectory::Trajectory;
use crate::bundle::Bundle;
use crate::error::RunError;
use crate::simulate::turns::{TurnMeasures, TurnRunner};
use crate::watch::Watch;

/// Steps after which the watch is asked: some tenths of a millisecond.
const ASKS_EVERY: u32 = 64;

/// The one lane, and what runs in it.
pub struct WholeSteps<'a> {
    lanes: Lanes<'a, 1>,
    trajectory: Trajectory<'a>,
}

impl<'a> WholeSteps<'a> {
    /// By the equations of a mechanism with the parameters of this runner.
    pub fn new(bundle: &'a dyn Bundle<1>, runner: &TurnRunner<'a>) -> Self {
        let lanes = Lanes::new(bundle, runner.motion.dynamics.evaluator.parameters());
        Self { lanes, trajectory: Trajectory::default() }
    }

    /// As [`TurnRunner::measure`], in the same bits. What whole steps do not know, the runner runs.
    ///
    /// # Errors
    /// As [`TurnRunner::measure`].
    pub fn measure(
        &mut self,
        runner: &mut TurnRunner<'a>,
        watch: Watch<'_>,
    ) -> Result<TurnMeasures, RunError> {
        let kept = runner.state();
        let looks = runner.looks();
        if !self.trajectory.begin(runner, looks, (&mut self.lanes, 0))? {
            return runner.measure(watch);
        }
        let mut outcome = None;
        let mut steps = 0_u32;
        while outcome.is_none() {
            let Self { lanes, trajectory } = self;
            let (trajectories, runners) = (slice::from_mut(trajectory), slice::from_mut(runner));
            step(lanes, trajectories, runners, &mut |_, ended| outcome = Some(ended));
            let is_asked = steps.is_multiple_of(ASKS_EVERY) && outcome.is_none();
            steps = steps.wrapping_add(1);
            if is_asked && self.trajectory.report(watch).is_break() {
                self.trajectory.cancel(runner);
                runner.restore(&kept)?;
                return Err(RunError::Interrupted { t: kept.t });
            }
        }
        if let Some(TurnOutcome::Done(done)) = outcome {
            return Ok(done.0);
        }
        runner.restore(&kept)?;
        runner.measure(watch)
    }
}
