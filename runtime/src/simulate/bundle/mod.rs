//! Turns of several trajectories of one mechanism side by side, a lane each, in the bits that each has alone.
//! In: where turns begin. Out: what they did. Never knows lives, threads, or which lane a turn runs in.
//!
//! Every lane has a runner of its own, which does all that is done once a step as it does it alone; what is done at every
//! stage, the lanes do together. A turn that meets what only a lone trajectory is made for (loops nearly singular, numbers
//! that are infinite, steps that do not get longer) is given back, to be run alone from its beginning.

mod lanes;
mod outcome;
mod queue;
mod room;
mod trajectory;
mod whole;
mod wide;

pub use outcome::TurnOutcome;
pub use whole::WholeSteps;
pub use wide::{LaneTurns, WideBundle};

pub use queue::{TurnQueue, TurnRequests, turn_queue};

use super::turns::{TurnRunner, TurnState};
use crate::bundle::Bundle;
use crate::error::RunError;
use lanes::{Lanes, Steps};
use trajectory::Trajectory;

/// Steps of all lanes after which they look for turns that are not wanted any more: some milliseconds.
pub(crate) const LOOKS_EVERY: u32 = 1000;

/// Runs turns of one mechanism in `N` lanes.
pub struct TurnBundle<'a, const N: usize> {
    lanes: Lanes<'a, N>,
    trajectories: Vec<Trajectory<'a>>,
    runners: Vec<TurnRunner<'a>>,
}

impl<'a, const N: usize> TurnBundle<'a, N> {
    /// Prepares the lanes; `runner` makes a runner of the mechanism that the bundle has the equations of.
    ///
    /// # Errors
    /// What making a runner reports.
    pub fn new(
        bundle: &'a dyn Bundle<N>,
        runner: impl Fn() -> Result<TurnRunner<'a>, RunError>,
    ) -> Result<Self, RunError> {
        let runners: Vec<_> = (0..N).map(|_| runner()).collect::<Result<_, _>>()?;
        let lanes = Lanes::new(bundle, runners[0].motion.dynamics.evaluator.parameters());
        Ok(Self { lanes, trajectories: (0..N).map(|_| Trajectory::default()).collect(), runners })
    }

    /// A lane without a turn; none if all are under way.
    pub fn free_lane(&self) -> Option<usize> {
        self.trajectories.iter().position(|trajectory| !trajectory.is_under_way())
    }

    /// Whether no lane has a turn.
    pub fn is_idle(&self) -> bool {
        !self.trajectories.iter().any(Trajectory::is_under_way)
    }

    /// Begins a turn in a lane that has none; `looked_at`: the clearances [m], if it has to be looked at for forces that jump
    /// with an angle. Whether it can be run here: only by [`crate::Integrator::Rk43`].
    ///
    /// # Errors
    /// If the state is not one of this mechanism, or the turn cannot begin.
    pub fn begin(
        &mut self,
        lane: usize,
        from: &TurnState,
        looked_at: Option<Vec<f64>>,
    ) -> Result<bool, RunError> {
        let runner = &mut self.runners[lane];
        runner.restore(from)?;
        self.trajectories[lane].begin(runner, looked_at, (&mut self.lanes, lane))
    }

    /// Gives up the turn of a lane.
    pub fn cancel(&mut self, lane: usize) {
        self.trajectories[lane].cancel(&mut self.runners[lane]);
    }

    /// Tries one step in every lane that has a turn; `ended` hears of turns that end.
    pub fn step(&mut self, ended: &mut dyn FnMut(usize, TurnOutcome)) {
        step(&mut self.lanes, &mut self.trajectories, &mut self.runners, ended);
    }
}

/// One step of every trajectory that has a turn, each with its runner.
fn step<'a, const N: usize>(
    lanes: &mut Lanes<'a, N>,
    trajectories: &mut [Trajectory<'a>],
    runners: &mut [TurnRunner<'a>],
    ended: &mut dyn FnMut(usize, TurnOutcome),
) {
    let mut steps = Steps { begins: [0.0; N], lengths: [0.0; N], ends: [0.0; N], ordinary: [false; N] };
    for (lane, trajectory) in trajectories.iter_mut().enumerate() {
        if let Some((begin, length, end)) = trajectory.propose() {
            (steps.begins[lane], steps.lengths[lane], steps.ends[lane]) = (begin, length, end);
            steps.ordinary[lane] = true;
        }
    }
    let asked = steps.ordinary;
    lanes.step(&mut steps);
    for lane in (0..N).filter(|lane| asked[*lane]) {
        let (is_regular, end, runner) = (steps.ordinary[lane], steps.ends[lane], &mut runners[lane]);
        steps.ordinary[lane] = is_regular && trajectories[lane].project(runner, (lanes, lane), end);
    }
    lanes.conclude(&mut steps);
    let mut accepted = [false; N];
    for lane in (0..N).filter(|lane| asked[*lane]) {
        let step = ((steps.lengths[lane], steps.ends[lane]), steps.ordinary[lane]);
        accepted[lane] = trajectories[lane].judge(&mut runners[lane], (lanes, lane), step);
    }
    lanes.accept(&accepted);
    for lane in (0..N).filter(|lane| asked[*lane]) {
        if let Some(outcome) = trajectories[lane].settle(&mut runners[lane], (lanes, lane), accepted[lane]) {
            ended(lane, outcome);
        }
    }
}
