//! One trajectory of a bundle: what is done once a step, by the runner that would run it alone. In: a turn, steps that its lane
//! has tried. Out: whether they count, the turn's end. Never knows the other lanes.

use super::TurnOutcome;
use super::lanes::Lanes;
use crate::error::RunError;
use crate::evaluate::Evaluator;
use crate::integrate::{Adaptive, Problem, Rk43, SLOPES};
use crate::simulate::settings::Integrator;
use crate::simulate::turns::{Turn, TurnRunner, TurnState};
use crate::simulate::{events, steps};
use crate::watch::Watch;

/// A lane's place among the lanes.
type Place<'l, 'a, const N: usize> = (&'l mut Lanes<'a, N>, usize);

/// A runner, and its turn.
pub(super) struct Trajectory<'a> {
    runner: TurnRunner<'a>,
    turn: Option<UnderWay<'a>>,
}

struct UnderWay<'a> {
    turn: Turn<'a>,
    method: Adaptive<Rk43>,
    /// A state within a step.
    between: Vec<f64>,
    /// Slopes at both ends of a step.
    slopes: [Vec<f64>; 2],
    /// Residuals of all rows.
    residuals: Vec<f64>,
    /// What the lane has to know of an accepted step.
    after: After,
}

/// What became of an accepted step.
#[derive(Clone, Copy, Debug, PartialEq)]
enum After {
    /// It was not accepted, or all is as the lane has it.
    Nothing,
    /// It ended earlier than the lane had tried.
    Shortened,
    /// Only a lone trajectory can go on.
    Failed,
}

impl<'a> Trajectory<'a> {
    pub(super) fn new(runner: TurnRunner<'a>) -> Self {
        Self { runner, turn: None }
    }

    pub(super) fn evaluator(&self) -> &Evaluator<'a> {
        &self.runner.motion.dynamics.evaluator
    }

    /// Residuals up to which the end of a step needs no projection.
    pub(super) fn untouched(&self, nearness: f64) -> (f64, f64) {
        self.runner.motion.untouched(nearness)
    }

    pub(super) fn is_under_way(&self) -> bool {
        self.turn.is_some()
    }

    pub(super) fn cancel(&mut self) {
        self.runner.motion.forget();
        self.turn = None;
    }

    pub(super) fn begin<const N: usize>(
        &mut self,
        from: &TurnState,
        looked_at: Option<Vec<f64>>,
        (lanes, lane): Place<'_, 'a, N>,
    ) -> Result<bool, RunError> {
        let Integrator::Rk43 { tolerance, max_step } = self.runner.integrator else { return Ok(false) };
        self.runner.restore(from)?;
        let mut turn = self.runner.begin(looked_at)?;
        let motion = &mut self.runner.motion;
        motion.loosen(tolerance);
        let method: Adaptive<Rk43> =
            steps::begin_adaptive(motion, &mut turn.sampler, &turn.state, (tolerance, max_step))?;
        lanes.put_state(lane, method.y(), method.slope());
        lanes.put_memory(lane, motion.dynamics.evaluator.clearances());
        lanes.put_pivots(lane, &motion.dynamics);
        for place in 0..lanes.sizes.flat_state() {
            lanes.scales.all_mut()[place][lane] = motion.scale(place);
        }
        let numbers = || vec![0.0; turn.state.len()];
        let (between, slopes) = (numbers(), [numbers(), numbers()]);
        lanes.put_row_lengths(lane, &motion.dynamics.evaluator);
        let residuals = vec![0.0; lanes.sizes.all_rows];
        self.turn = Some(UnderWay { turn, method, between, slopes, residuals, after: After::Nothing });
        Ok(true)
    }

    /// Begin, length and end of the step to try, and the tolerance of its error.
    pub(super) fn propose(&mut self) -> Option<(f64, f64, f64, f64)> {
        let UnderWay { turn, method, .. } = self.turn.as_mut()?;
        let tolerance = method.tolerance();
        let control = method.control();
        let (length, end) = control.propose(turn.sampler.hard_stop(control.t()));
        Some((control.t(), length, end, tolerance))
    }

    /// Notes pivots that have grown: how regular they are, the largest now, and up to where pivots are noise.
    pub(super) fn note_pivots(&mut self, pivots: &[f64]) -> (f64, Vec<f64>, f64) {
        let dynamics = &mut self.runner.motion.dynamics;
        let regularity = dynamics.note_pivots(pivots);
        let (values, noise) = dynamics.largest_pivots();
        (regularity, values.to_vec(), noise)
    }

    /// Puts the end of the step onto the constraints; `closed`: the lanes have seen nothing to be done. Whether that succeeded.
    pub(super) fn project<const N: usize>(
        &mut self,
        (lanes, lane): Place<'_, 'a, N>,
        end: f64,
        closed: bool,
    ) -> bool {
        let Some(UnderWay { method, residuals, .. }) = &mut self.turn else { return false };
        let motion = &mut self.runner.motion;
        // Three inner stages have been evaluated.
        motion.dynamics.take_over(SLOPES as u64 - 2, lanes.nearness[lane]);
        let (before, next) = method.ends();
        lanes.residuals(lane, residuals);
        if closed && motion.take_over_loops(residuals) {
            lanes.take_normalized(lane);
            lanes.method.next.get(lane, 0, next);
            return true;
        }
        lanes.method.next.get(lane, 0, next);
        if motion.project(end, before, next).is_err() {
            return false;
        }
        lanes.method.next.put(lane, 0, &next[..motion.first_integral()]);
        lanes.put_row_lengths(lane, &motion.dynamics.evaluator);
        true
    }

    /// Whether the step counts by its error, 1 just accepted; if it does, what follows from it is done.
    pub(super) fn judge<const N: usize>(
        &mut self,
        (lanes, lane): Place<'_, 'a, N>,
        step: (f64, f64),
        error: f64,
    ) -> bool {
        let Some(UnderWay { turn, method, between, slopes, after, .. }) = &mut self.turn else {
            return false;
        };
        let motion = &mut self.runner.motion;
        motion.dynamics.take_over(1, lanes.nearness[lane]);
        *after = After::Nothing;
        if error > 1.0 && !method.control().is_smallest(step.0) {
            method.control().reject(step.0, error);
            return false;
        }
        // The steps of a lone trajectory get a reason.
        if error.is_nan() || error > 1.0 {
            *after = After::Failed;
            return false;
        }
        method.accept_end(step, error);
        motion.take_over(step.1, lanes.energy(lane), |joint, before| lanes.contact(lane, joint, before));
        let sampler = &mut turn.sampler;
        sampler.statistics.rejected = method.rejected();
        let at_end = method.t() == sampler.schedule.end;
        if at_end || sampler.watches_angles() || events::is_suspect(motion, sampler, method) {
            for (slope, answer) in slopes.iter_mut().zip([0, SLOPES - 1]) {
                lanes.method.answers[answer].get(lane, 0, slope);
            }
            method.know([&slopes[0], &slopes[1]]);
            motion.reached(method.t(), method.slope());
        }
        let done = steps::after_step(motion, sampler, method, between, Watch::NONE);
        *after = match done {
            Err(_) => After::Failed,
            Ok(()) if method.t() != step.1 => After::Shortened,
            Ok(()) => After::Nothing,
        };
        true
    }

    /// Brings the lane up to date after a step; says how the turn ended, if it has.
    pub(super) fn settle<const N: usize>(
        &mut self,
        (lanes, lane): Place<'_, 'a, N>,
        accepted: bool,
    ) -> Option<TurnOutcome> {
        let UnderWay { turn, method, after, .. } = self.turn.as_mut()?;
        let motion = &mut self.runner.motion;
        if *after == After::Failed {
            self.cancel();
            return Some(TurnOutcome::Alone);
        }
        if !accepted {
            return None;
        }
        if *after == After::Shortened {
            lanes.put_state(lane, method.y(), method.slope());
            lanes.put_pivots(lane, &motion.dynamics);
        }
        lanes.put_memory(lane, motion.dynamics.evaluator.clearances());
        for place in motion.first_integral()..lanes.sizes.flat_state() {
            lanes.scales.all_mut()[place][lane] = motion.scale(place);
        }
        if method.t() < turn.sampler.schedule.end {
            return None;
        }
        motion.forget();
        turn.state.copy_from_slice(method.y());
        let UnderWay { turn, .. } = self.turn.take()?;
        let measures = self.runner.end(turn);
        Some(TurnOutcome::Done(Box::new((measures, self.runner.state()))))
    }
}
