//! Measurements in the lanes of a bundle, each of its own state of wear. In: measurements that have begun. Out: the same when they are
//! done, in the bits that each has alone. Never knows what they are for.

use std::collections::VecDeque;

use super::leaving::leaves;
use super::measuring::Measuring;
use super::returning::Stand;
use super::wearing::Wearing;
use crate::error::RunError;
use crate::simulate::{LOOKS_EVERY, LaneTurns, TurnMeasures, TurnOutcome, TurnRunner, TurnState};
use crate::watch::Watch;

/// One of several measurements.
pub(super) struct Begun {
    pub measuring: Measuring,
    /// Where its next turn begins.
    pub at: TurnState,
    /// Clearances [m] that its turns were looked at with for forces that jump with an angle.
    pub looked_at: Option<Vec<f64>>,
}

/// What runs them.
pub(super) struct SideBySide<'r, 'a> {
    /// What no lane runs.
    pub runner: &'r mut TurnRunner<'a>,
    pub wearing: &'r Wearing<'a>,
    pub watch: Watch<'a>,
}

impl<'a> SideBySide<'_, 'a> {
    /// Runs turns of all of them until each is done.
    pub fn run(&mut self, lanes: &mut (dyn LaneTurns<'a> + 'a), begun: &mut [Begun]) -> Result<(), RunError> {
        let result = self.through_lanes(lanes, begun);
        if result.is_err() {
            lanes.cancel_all();
        }
        result
    }

    fn through_lanes(
        &mut self,
        lanes: &mut (dyn LaneTurns<'a> + 'a),
        begun: &mut [Begun],
    ) -> Result<(), RunError> {
        let mut waiting: VecDeque<usize> = (0..begun.len()).collect();
        let mut running: Vec<Option<usize>> = Vec::new();
        let (mut ended, mut steps) = (Vec::new(), 0_u32);
        loop {
            while let Some(lane) = lanes.free_lane() {
                let Some(which) = waiting.pop_front() else { break };
                let one = &mut begun[which];
                self.runner.go_on(&one.at, one.looked_at.clone())?;
                let looks = self.runner.looks();
                if looks.is_some() {
                    one.looked_at.clone_from(&looks);
                    self.runner.go_on(&one.at, looks.clone())?;
                }
                if lanes.begin(lane, &one.at, looks)? {
                    running.resize(running.len().max(lane + 1), None);
                    running[lane] = Some(which);
                } else if !self.alone(one)? {
                    waiting.push_back(which);
                }
            }
            if lanes.is_idle() {
                return Ok(());
            }
            lanes.step(&mut |lane, outcome| ended.push((lane, outcome)));
            for (lane, outcome) in ended.drain(..) {
                let Some(which) = running.get_mut(lane).and_then(Option::take) else { continue };
                let one = &mut begun[which];
                let done = match outcome {
                    TurnOutcome::Done(done) => {
                        let (turn, state) = *done;
                        one.at = state;
                        self.runner.restore(&one.at)?;
                        self.take(one, turn)?
                    }
                    TurnOutcome::Alone => self.alone(one)?,
                };
                if !done {
                    waiting.push_back(which);
                }
            }
            steps += 1;
            if steps.is_multiple_of(LOOKS_EVERY) && self.watch.report(0.0).is_break() {
                return Err(RunError::Interrupted { t: begun.first().map_or(0.0, |one| one.at.t) });
            }
        }
    }

    /// Runs a turn that no lane runs; whether it was the last.
    fn alone(&mut self, one: &mut Begun) -> Result<bool, RunError> {
        self.runner.restore(&one.at)?;
        let turn = self.runner.measure(self.watch)?;
        one.at = self.runner.state();
        self.take(one, turn)
    }

    /// Takes a turn at whose end the runner is; whether it was the last.
    fn take(&mut self, one: &mut Begun, turn: TurnMeasures) -> Result<bool, RunError> {
        let stand = Stand::of(self.runner);
        Ok(one.measuring.take(turn, stand, self.wearing) && !self.leaves(one)?)
    }

    /// Whether one that is done has to be made again.
    fn leaves(&mut self, one: &mut Begun) -> Result<bool, RunError> {
        if !one.measuring.shows_nothing(self.wearing) {
            return Ok(false);
        }
        self.runner.restore(&one.at)?;
        let leaves = leaves(self.runner, &mut one.measuring, self.watch)?;
        if leaves {
            one.at = self.runner.state();
        }
        Ok(leaves)
    }
}
