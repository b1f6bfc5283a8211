//! One trajectory of a bundle: what is done once a step, by the runner that would run it alone. In: a turn, steps that its lane
//! has tried. Out: whether they count, the turn's end. Never knows the other lanes.

use std::ops::ControlFlow;

use super::lanes::Lanes;
use super::outcome::TurnOutcome;
use crate::clearance_joint::ContactState;
use crate::error::RunError;
use crate::evaluate::{CLOSED, LoopError};
use crate::integrate::{Adaptive, Problem, Rk43};
use crate::runge_kutta::PARTS;
use crate::simulate::motion::ConstrainedMotion;
use crate::simulate::schedule::Schedule;
use crate::simulate::settings::Integrator;
use crate::simulate::turns::{Turn, TurnRunner};
use crate::simulate::{events, steps};
use crate::watch::Watch;

/// A lane's place among the lanes.
type Place<'l, 'a, const N: usize> = (&'l mut Lanes<'a, N>, usize);

/// The turn of a runner, if it has one.
#[derive(Default)]
pub(super) struct Trajectory<'a>(Option<UnderWay<'a>>);

struct UnderWay<'a> {
    turn: Turn<'a>,
    method: Adaptive<Rk43>,
    /// A state within a step.
    between: Vec<f64>,
    /// Slopes at both ends of a step.
    slopes: [Vec<f64>; 2],
    /// Residuals of all rows.
    residuals: Vec<f64>,
    /// Steps that the lane alone has followed.
    quiet: u32,
    /// Whether the end of the present step is known here.
    is_end_known: bool,
    /// What the lane has to know of an accepted step.
    after: After,
}

/// What became of an accepted step.
#[derive(Clone, Copy, Debug, PartialEq)]
enum After {
    /// It was not accepted.
    Nothing,
    /// The lane alone has followed it.
    Quiet,
    /// All is as the lane has it.
    Followed,
    /// It ended earlier than the lane had tried.
    Shortened,
    /// Only a lone trajectory can go on.
    Failed,
}

impl<'a> Trajectory<'a> {
    pub(super) fn is_under_way(&self) -> bool {
        self.0.is_some()
    }

    pub(super) fn cancel(&mut self, runner: &mut TurnRunner<'a>) {
        runner.motion.forget();
        self.0 = None;
    }

    /// Begins a turn where the runner is. Whether it can be run here.
    pub(super) fn begin<const N: usize>(
        &mut self,
        runner: &mut TurnRunner<'a>,
        looked_at: Option<Vec<f64>>,
        (lanes, lane): Place<'_, 'a, N>,
    ) -> Result<bool, RunError> {
        let Integrator::Rk43 { tolerance, max_step } = runner.integrator else { return Ok(false) };
        let tolerance = Integrator::of_contacts(tolerance);
        let evaluator = &runner.motion.dynamics.evaluator;
        // Steps that end at switches and samples are a lone trajectory's.
        if evaluator.has_switches() || evaluator.has_samplers() {
            return Ok(false);
        }
        let mut turn = runner.begin(looked_at)?;
        let motion = &mut runner.motion;
        motion.loosen(tolerance);
        let mut method: Adaptive<Rk43> =
            steps::begin_adaptive(motion, &mut turn.sampler, &turn.state, ((tolerance, max_step), false))?;
        lanes.put_state(lane, method.y(), method.slope());
        lanes.put_settings(lane, motion, method.tolerance());
        lanes.put_progress(lane, motion, &mut turn.sampler);
        lanes.put_last_error(lane, method.control().last_error());
        lanes.put_pivots(lane, &motion.dynamics);
        let numbers = || vec![0.0; turn.state.len()];
        let (between, slopes) = (numbers(), [numbers(), numbers()]);
        lanes.put_row_squares(lane, &motion.dynamics.evaluator);
        let residuals = vec![0.0; lanes.sizes.all_rows];
        let (quiet, is_end_known, after) = (0, false, After::Nothing);
        self.0 = Some(UnderWay { turn, method, between, slopes, residuals, quiet, is_end_known, after });
        Ok(true)
    }

    /// Tells how far the turn is.
    pub(super) fn report(&mut self, watch: Watch<'_>) -> ControlFlow<()> {
        self.0.as_mut().map_or(ControlFlow::Continue(()), |UnderWay { turn, method, .. }| {
            let Schedule { begin, end, .. } = turn.sampler.schedule;
            watch.report((method.t() - begin) / (end - begin))
        })
    }

    /// Begin, length and end of the step to try.
    pub(super) fn propose(&mut self) -> Option<(f64, f64, f64)> {
        let UnderWay { turn, method, .. } = self.0.as_mut()?;
        let control = method.control();
        let (length, end) = control.propose(turn.sampler.hard_stop(control.t()));
        Some((control.t(), length, end))
    }

    /// Puts the end of the step onto the constraints, unless the lanes have seen that nothing has to be done. Whether that
    /// succeeded.
    pub(super) fn project<const N: usize>(
        &mut self,
        runner: &mut TurnRunner<'a>,
        (lanes, lane): Place<'_, 'a, N>,
        end: f64,
    ) -> bool {
        let (Some(under_way), motion) = (&mut self.0, &mut runner.motion) else { return false };
        motion.dynamics.take_over(PARTS.len() as u64, lanes.nearness(lane));
        let is_untouched = lanes.is_untouched(lane);
        let [metres, radians] = lanes.open(lane);
        let is_closed = LoopError { metres, radians, worst: 0 }.part(motion.arm) <= CLOSED;
        under_way.is_end_known = !(is_untouched && is_closed);
        if is_untouched && lanes.has_longer_row(lane) {
            motion.dynamics.evaluator.take_over_rows(lanes.squares_at_end(lane));
            lanes.put_row_squares(lane, &motion.dynamics.evaluator);
        }
        if !under_way.is_end_known {
            return true;
        }
        under_way.catch_up(motion, (lanes, lane));
        let (before, next) = under_way.method.ends();
        lanes.raw_end(lane, next);
        if motion.project(end, before, next).is_err() {
            return false;
        }
        lanes.put_end(lane, &next[..motion.first_integral()]);
        lanes.put_row_squares(lane, &motion.dynamics.evaluator);
        true
    }

    /// Whether the step counts by its error; if it does, what follows from it is done. Of what is not ordinary, nothing is to be
    /// believed.
    pub(super) fn judge<const N: usize>(
        &mut self,
        runner: &mut TurnRunner<'a>,
        (lanes, lane): Place<'_, 'a, N>,
        (step, is_ordinary): ((f64, f64), bool),
    ) -> bool {
        let (Some(under_way), motion) = (&mut self.0, &mut runner.motion) else { return false };
        motion.dynamics.take_over(1, lanes.nearness_at_end(lane));
        if let Some(pivots) = lanes.grown_pivots(lane) {
            motion.dynamics.note_pivots(&pivots);
        }
        let (error, growth) = lanes.error(lane);
        let error = if is_ordinary { error } else { f64::NAN };
        under_way.after = After::Nothing;
        let control = under_way.method.control();
        if error > 1.0 && !control.is_smallest(step.0) {
            control.reject(step.0, error);
            return false;
        }
        // The steps of a lone trajectory get a reason.
        if error.is_nan() || error > 1.0 {
            under_way.after = After::Failed;
            return false;
        }
        if lanes.is_quiet(lane) && under_way.is_idle(step.1) {
            under_way.method.pass(step, error, growth);
            under_way.quiet += 1;
            under_way.after = After::Quiet;
            return true;
        }
        under_way.catch_up(motion, (lanes, lane));
        under_way.know_end(motion, (lanes, lane));
        let UnderWay { turn, method, between, slopes, after, .. } = under_way;
        method.accept_end(step, error, growth);
        motion.take_over(step.1, lanes.energy(lane), |joint, before| lanes.contact(lane, joint, before));
        let sampler = &mut turn.sampler;
        sampler.statistics.rejected = method.rejected();
        let at_end = method.t() == sampler.schedule.end;
        let is_suspect = events::is_suspect(motion, sampler, method);
        if at_end || sampler.watches_angles() || is_suspect {
            let [begin, end] = slopes;
            lanes.slopes(lane, [&mut *begin, &mut *end]);
            method.know([begin, end]);
            motion.reached(method.t(), method.y(), method.slope());
        }
        let stopped =
            if is_suspect { events::stop_at_contact(motion, sampler, method, between) } else { Ok(()) };
        let done = stopped.and_then(|()| {
            steps::look_back(motion, sampler, method)
                .and_then(|()| sampler.step_done(motion, method.t(), method.y()))
        });
        *after = match done {
            Err(_) => After::Failed,
            Ok(()) if method.t() != step.1 => After::Shortened,
            Ok(()) => After::Followed,
        };
        true
    }

    /// Brings the lane up to date after a step; says how the turn ended, if it has.
    pub(super) fn settle<const N: usize>(
        &mut self,
        runner: &mut TurnRunner<'a>,
        (lanes, lane): Place<'_, 'a, N>,
        accepted: bool,
    ) -> Option<TurnOutcome> {
        let UnderWay { turn, method, after, .. } = self.0.as_mut()?;
        let motion = &mut runner.motion;
        if *after == After::Failed {
            self.cancel(runner);
            return Some(TurnOutcome::Alone);
        }
        if accepted {
            lanes.put_last_error(lane, method.control().last_error());
        }
        if matches!(after, After::Nothing | After::Quiet) {
            return None;
        }
        if *after == After::Shortened {
            lanes.put_state(lane, method.y(), method.slope());
            lanes.put_pivots(lane, &motion.dynamics);
        }
        lanes.put_progress(lane, motion, &mut turn.sampler);
        if method.t() < turn.sampler.schedule.end {
            return None;
        }
        motion.forget();
        turn.state.copy_from_slice(method.y());
        let UnderWay { turn, .. } = self.0.take()?;
        let measures = runner.end(turn);
        Some(TurnOutcome::Done(Box::new((measures, runner.state()))))
    }
}

impl UnderWay<'_> {
    /// Whether a step to `end` [s], if the lane has seen nothing in it, changes nothing but what is added up.
    fn is_idle(&mut self, end: f64) -> bool {
        let Self { turn: Turn { sampler, .. }, method, quiet, is_end_known, .. } = self;
        let tried = sampler.statistics.steps + u64::from(*quiet) + 1 + method.rejected();
        !*is_end_known && end != sampler.hard_stop(method.t()) && sampler.is_idle(end, tried)
    }

    /// Takes over the steps that the lane alone has followed.
    fn catch_up<const N: usize>(
        &mut self,
        motion: &mut ConstrainedMotion<'_>,
        (lanes, lane): (&mut Lanes<'_, N>, usize),
    ) {
        let steps = std::mem::take(&mut self.quiet);
        if steps == 0 {
            return;
        }
        let Self { turn: Turn { sampler, .. }, method, .. } = self;
        lanes.get(lane, lanes.places().y.start, method.y_mut());
        let added = sampler.ledger.balance.added;
        lanes.read_ledger(lane, &mut sampler.ledger);
        motion.energy_scale = lanes.energy_scale(lane);
        let contact = |joint: usize, before: &ContactState| lanes.contact_before(lane, joint, before);
        sampler.take_over(motion, (method.t(), method.y()), (steps, added), contact);
    }

    /// Takes over the end of the present step, if it is not known here.
    fn know_end<const N: usize>(
        &mut self,
        motion: &mut ConstrainedMotion<'_>,
        (lanes, lane): (&mut Lanes<'_, N>, usize),
    ) {
        if self.is_end_known {
            return;
        }
        lanes.get(lane, lanes.places().residuals.start, &mut self.residuals);
        motion.take_over_loops(&self.residuals);
        lanes.get(lane, lanes.places().next.start, self.method.ends().1);
    }
}
