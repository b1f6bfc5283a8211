//! What is recorded along the way: sampled rows, unwrapped angles, energy balance, loop error, turns.
//! In: states at steps and sample times. Out: a [`super::Run`]. Never knows integrators.

mod continuation;
mod end;
mod following;
mod looking;

use std::ops::ControlFlow;

use super::angles::Angles;
use super::bends::Bends;
use super::contacts::{Follower, touched};
use super::extremes::Collector;
use super::guard::{Guard, note_driver};
use super::looks::Looks;
use super::motion::ConstrainedMotion;
use super::run::Statistics;
use super::schedule::Schedule;
use super::singular_passage::Passages;
use super::unbounded::Unbounded;
use crate::clearance_joint::Channels;
use crate::description::Channel;
use crate::error::RunError;
use crate::evaluate::LoopError;
use crate::integrate::Problem;
use crate::ledger::{Balance, Ledger, Shown};
use crate::system::{STATES, System};
use crate::watch::Watch;

/// Recorder of one run.
pub(super) struct Sampler<'a> {
    pub(super) schedule: Schedule,
    pub(super) statistics: Statistics,
    times: Vec<f64>,
    rows: Vec<Vec<f64>>,
    columns: Channels,
    /// Columns at the state observed last.
    values: Vec<f64>,
    pub(super) angles: Angles,
    /// A state within a step.
    inner: Vec<f64>,
    /// What the run has added up.
    pub(super) ledger: Ledger<f64>,
    /// Of every free speed, whether it turns.
    turning: Vec<bool>,
    guard: Guard,
    unbounded: Unbounded,
    bends: Bends<'a>,
    pub(super) passages: Passages,
    /// Where the extremes of a run go, if anybody asks for them.
    extremes: Option<Collector>,
    /// Looks for them that wait for others.
    looks: Option<Looks<'a>>,
    /// What answers them, once so many more were taken one by one.
    soon: Option<(&'a dyn System<f64>, usize)>,
    /// Room for states within a step, side by side.
    pub(super) within: Vec<[f64; STATES]>,
    /// Time and state at the end of the last good step.
    pub(super) reached: (f64, Vec<f64>),
    /// Joints with clearance, where there are any.
    pub(super) follower: Option<Follower>,
    /// Where the present turn ends; the run stops there when joints with clearance are measured.
    turn_end: Option<f64>,
    /// A contact whose gap closes at the end of the present step.
    pub(super) closing: Option<usize>,
}

impl<'a> Sampler<'a> {
    pub(super) fn new(motion: &mut ConstrainedMotion<'a>, schedule: Schedule, state: &[f64]) -> Self {
        let description = motion.dynamics.evaluator.description();
        let columns = Channels::new(description);
        let begin = schedule.begin;
        let follower = Follower::new(motion, begin, state);
        let guard = Guard::new((begin, schedule.end), 0);
        let energies = motion.energies(begin, state);
        motion.energy_scale = motion.energy_scale.max(energies.kinetic);
        let ledger = Ledger::new(Balance::new(&energies), motion.dynamics.evaluator.sizes().contacts);
        let turning = description.turning_speeds();
        let mut sampler = Self {
            schedule,
            statistics: Statistics::default(),
            times: Vec::with_capacity(schedule.samples),
            rows: Vec::with_capacity(schedule.samples),
            values: vec![0.0; columns.channels.len()],
            // Without rows nobody asks for turns.
            angles: Angles::new(if schedule.samples > 0 { &columns.channels } else { &[] }),
            columns,
            inner: state.to_vec(),
            ledger,
            turning,
            guard,
            unbounded: Unbounded::default(),
            bends: Bends::new(description),
            passages: Passages::default(),
            extremes: None,
            looks: None,
            soon: None,
            within: Vec::new(),
            reached: (begin, state.to_vec()),
            follower,
            turn_end: None,
            closing: None,
        };
        sampler.judge_from(motion, begin, state);
        if let Some(follower) = &mut sampler.follower {
            follower.begin_turn(motion, &mut sampler.ledger.joints);
        }
        if begin == schedule.start {
            sampler.find_turn_end(motion);
        }
        sampler
    }

    /// Speeds are judged from a state on.
    fn judge_from(&mut self, motion: &mut ConstrainedMotion<'_>, t: f64, state: &[f64]) {
        (self.ledger.fastest, self.ledger.fastest_turning) = (0.0, 0.0);
        self.ledger.note_speeds(motion.split(state).1, &self.turning);
        note_driver(motion, t, &mut self.ledger);
    }

    /// Length of the run [s].
    pub(super) fn duration(&self) -> f64 {
        self.schedule.end - self.schedule.begin
    }

    /// A time that no step may pass: the end, or before it the end of a turn that is measured.
    pub(super) fn hard_stop(&self, t: f64) -> f64 {
        if self.follower.is_some() && t < self.schedule.start {
            self.schedule.start
        } else {
            self.turn_end.unwrap_or(self.schedule.end)
        }
    }

    fn find_turn_end(&mut self, motion: &mut ConstrainedMotion<'_>) {
        self.turn_end = match &self.follower {
            Some(follower) if motion.dynamics.evaluator.description().turn_driver.is_some() => {
                self.schedule.end_of_turn(&mut motion.dynamics.evaluator, follower.turn_begin)
            }
            _ => None,
        };
    }

    /// Joints with clearance after an accepted step: what they remember, what turns did.
    fn follow(&mut self, motion: &mut ConstrainedMotion<'_>, t: f64, state: &[f64]) -> Result<(), RunError> {
        let closing = self.closing.take();
        let Some(follower) = &mut self.follower else { return Ok(()) };
        follower.accept(motion, t, state, closing)?;
        let joints = &mut self.ledger.joints;
        if t == self.schedule.start {
            follower.begin_turn(motion, joints);
            self.find_turn_end(motion);
        } else if self.turn_end == Some(t) {
            follower.end_turn(motion, joints);
            self.find_turn_end(motion);
        }
        Ok(())
    }

    /// The state at the start, a sample if `sampled`.
    pub(super) fn see_start(
        &mut self,
        motion: &mut ConstrainedMotion<'_>,
        state: &[f64],
        sampled: bool,
    ) -> Result<(), RunError> {
        let begin = self.schedule.begin;
        self.follow_angles(motion, begin, state, None)?;
        if sampled {
            self.sample(motion, begin, &mut state.to_vec())?;
        } else {
            self.observe(motion, begin, state)?;
        }
        self.look(motion, (begin, state), None)
    }

    /// Evaluates the columns of a sample; `state` is put onto the constraints first, if it is not there.
    pub(super) fn sample(
        &mut self,
        motion: &mut ConstrainedMotion<'_>,
        t: f64,
        state: &mut [f64],
    ) -> Result<(), RunError> {
        motion.put_sample_on(t, state)?;
        self.note_loop_error(motion, t, motion.projector.loop_error())?;
        self.ledger.balance.note(&motion.energies(t, state));
        self.observe(motion, t, state)?;
        if let Some(i) = self.values.iter().position(|x| !x.is_finite()) {
            return Err(RunError::NonFinite { t, what: self.columns.channels[i].name.to_string() });
        }
        self.angles.unwrap(t, &mut self.values);
        Ok(())
    }

    /// Columns of the last sample.
    pub(super) fn values(&self) -> &[f64] {
        &self.values
    }

    /// Names and units of the columns.
    pub(super) fn channels(&self) -> &[Channel] {
        &self.columns.channels
    }

    /// Records the columns of the sample at `t` as a row.
    pub(super) fn record(&mut self, t: f64) {
        self.times.push(t);
        self.rows.push(self.values.clone());
    }

    /// Notes an accepted step that ends in `state`.
    pub(super) fn step_done(
        &mut self,
        motion: &mut ConstrainedMotion<'_>,
        t: f64,
        state: &[f64],
    ) -> Result<(), RunError> {
        self.statistics.steps += 1;
        let length = t - self.reached.0;
        let energies = motion.energies(t, state);
        let known = motion.dynamics.evaluator.known_of_contacts();
        let (_, speeds, _) = motion.split(state);
        let shown = Shown { t, length, energies, speeds, turning: &self.turning };
        let contacts = motion.dynamics.evaluator.clearances().contacts();
        let added = self.ledger.balance.added;
        self.ledger.note_step(&shown, contacts.iter().map(touched));
        motion.energy_scale = motion.energy_scale.max(energies.kinetic);
        let regularity = (motion.is_rough(), motion.dynamics.nearness());
        self.passages.note(t, regularity, added < self.ledger.balance.added);
        self.follow(motion, t, state)?;
        self.bends.note(t, motion.split(state).0)?;
        if !self.ledger.balance.throughput.is_finite() {
            return Err(RunError::NonFinite { t, what: "energy".to_owned() });
        }
        let tried = self.statistics.steps + self.statistics.rejected;
        self.guard.check_step(motion, (t, tried), (state, &mut self.ledger))?;
        self.reached.0 = t;
        self.reached.1.copy_from_slice(state);
        self.look(motion, (t, state), known)
    }

    /// Observes without changing anything of the run, nor what is told about its cost.
    fn observe_aside(
        &mut self,
        motion: &mut ConstrainedMotion<'_>,
        t: f64,
        state: &[f64],
    ) -> Result<(), RunError> {
        let aside = motion.dynamics.aside();
        let seen = self.observe(motion, t, state);
        motion.dynamics.resume(aside);
        seen
    }

    /// Tells the caller how far the run is.
    pub(super) fn report(&self, t: f64, watch: Watch<'_>) -> Result<(), RunError> {
        match watch.report((t - self.schedule.begin) / self.duration()) {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(RunError::Interrupted { t }),
        }
    }

    /// Evaluates the channels; angles that wrap are as atan2 has them.
    fn observe(&mut self, motion: &mut ConstrainedMotion<'_>, t: f64, state: &[f64]) -> Result<(), RunError> {
        let (q, v, _) = motion.split(state);
        motion.dynamics.accelerate(t, q, v)?;
        let generated = motion.dynamics.evaluator.observe(t, q, v);
        let count = generated.len();
        self.values[..count].copy_from_slice(generated);
        let columns = &mut self.values[..count];
        self.unbounded.take_limits(motion, (t, q, v), &self.columns.channels, columns);
        let contacts = motion.dynamics.evaluator.clearances().contacts();
        self.columns.write(contacts, &mut self.values[count..]);
        Ok(())
    }

    /// Notes how far loops are open at `t`.
    ///
    /// # Errors
    /// [`RunError::LostAssembly`] if that is no closed loop.
    pub(super) fn note_loop_error(
        &mut self,
        motion: &ConstrainedMotion<'_>,
        t: f64,
        error: LoopError,
    ) -> Result<(), RunError> {
        self.ledger.note_open([error.metres, error.radians]);
        self.guard.check_loops(motion, t, error)
    }
}
