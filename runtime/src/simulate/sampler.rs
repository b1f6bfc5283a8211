//! What is recorded along the way: sampled rows, unwrapped angles, energy balance, loop error, turns.
//! In: states at steps and sample times. Out: a [`Run`]. Never knows integrators.

mod continuation;

use std::f64::consts::PI;
use std::ops::ControlFlow;

use super::angles::Angles;
use super::contacts::{Follower, touched};
use super::extremes::Collector;
use super::guard::{Guard, is_doubtful, note_driver};
use super::half_turn;
use super::looks::Looks;
use super::motion::{ConstrainedMotion, PROJECTED_STAGES};
use super::run::{Run, Statistics};
use super::schedule::Schedule;
use super::singular_passage::Passages;
use super::unbounded::Unbounded;
use super::warning::{self, RunWarning};
use crate::clearance_joint::Channels;
use crate::description::Channel;
use crate::error::RunError;
use crate::evaluate::LoopError;
use crate::integrate::Problem;
use crate::ledger::{Balance, Ledger, Shown};
use crate::system::System;
use crate::watch::Watch;

/// Times in a turn of the fastest body at which curves are looked at, at least: the peak of a tenth harmonic is then found
/// to a part in a hundred of its size, of the first to a part in ten thousand.
const LOOKS_PER_TURN: f64 = 240.0;
/// Looks in a radian of the fastest vibration, up to so many in a step: its peak is then met to a few ten-thousandths where steps
/// follow it closely, and steps that do not have no more of it to see.
const LOOKS_PER_RADIAN: f64 = 25.0;
const LOOKS_AT_VIBRATION: f64 = 4.0;

/// Looks that are taken one by one before several are taken together.
const LOOKS_ALONE: usize = 500;
/// Looks within one step, at most.
const MOST_LOOKS: f64 = 1000.0;
/// Halvings of a step to follow an angle: a step of a thousand turns that begin and end at rest takes twelve.
const MOST_HALVINGS: usize = 30;

/// Writes the state at a time within the last step.
type Between<'a> = &'a dyn Fn(f64, &mut [f64]);

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
    pub(super) passages: Passages,
    /// Where the extremes of a run go, if anybody asks for them.
    extremes: Option<Collector>,
    /// Looks for them that wait for others.
    looks: Option<Looks<'a>>,
    /// What answers them, once so many more were taken one by one.
    soon: Option<(&'a dyn System<f64>, usize)>,
    /// Room for states within a step.
    pub(super) within: Vec<f64>,
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
            inner: Vec::new(),
            ledger,
            turning,
            guard,
            unbounded: Unbounded::default(),
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
        self.look(motion, begin, state)
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
        let (_, speeds, _) = motion.split(state);
        let shown = Shown { t, length, energies, speeds, turning: &self.turning };
        let contacts = motion.dynamics.evaluator.clearances().contacts();
        let added = self.ledger.balance.added;
        self.ledger.note_step(&shown, contacts.iter().map(touched));
        motion.energy_scale = motion.energy_scale.max(energies.kinetic);
        let regularity = (motion.is_rough(), motion.dynamics.nearness());
        self.passages.note(t, regularity, added < self.ledger.balance.added);
        self.follow(motion, t, state)?;
        if !self.ledger.balance.throughput.is_finite() {
            return Err(RunError::NonFinite { t, what: "energy".to_owned() });
        }
        let tried = self.statistics.steps + self.statistics.rejected;
        self.guard.check_step(motion, (t, tried), &mut self.ledger)?;
        self.reached.0 = t;
        self.reached.1.copy_from_slice(state);
        self.look(motion, t, state)
    }

    /// Follows angles over a step that ends in `state`, before anything within it is sampled; `between`: writes
    /// the state at a time within the step, if the method can.
    ///
    /// # Errors
    /// [`RunError::TurnsUnclear`], [`RunError::AngleJumps`], or what the mechanism reports.
    pub(super) fn follow_angles(
        &mut self,
        motion: &mut ConstrainedMotion<'_>,
        t: f64,
        state: &[f64],
        between: Option<Between<'_>>,
    ) -> Result<(), RunError> {
        if self.angles.is_empty() {
            return Ok(());
        }
        self.angles.begin_step();
        let mut inner = std::mem::take(&mut self.inner);
        // The step's end, and the times that have to be looked at before it.
        let (mut pending, mut last) = ([t; MOST_HALVINGS + 1], 0);
        loop {
            let next = pending[last];
            match between {
                Some(interpolate) if next < t => {
                    inner.resize(state.len(), 0.0);
                    interpolate(next, &mut inner);
                    self.observe_aside(motion, next, &inner)?;
                }
                _ => self.observe_aside(motion, next, state)?,
            }
            if let Err(angle) = self.angles.note(next, &self.values) {
                let from = self.angles.known_until().unwrap_or(next);
                if between.is_none() || last == MOST_HALVINGS {
                    let angle = self.columns.channels[angle].name.to_string();
                    return Err(RunError::TurnsUnclear { t, step: next - from, angle });
                }
                last += 1;
                pending[last] = 0.5 * (from + next);
            } else if last > 0 {
                last -= 1;
            } else {
                break;
            }
        }
        self.inner = inner;
        let begin = &self.reached;
        let straight = |time: f64, mixed: &mut [f64]| {
            let part = (time - begin.0) / (t - begin.0);
            for ((mixed, from), to) in mixed.iter_mut().zip(&begin.1).zip(state) {
                *mixed = from + part * (to - from);
            }
        };
        let within = between.unwrap_or(&straight);
        for crossing in self.angles.crossings() {
            let name = &self.columns.channels[crossing.place].name;
            half_turn::check(motion, &self.angles, &crossing, (within, state.len()), name)?;
        }
        Ok(())
    }

    /// Whether angles are followed.
    pub(super) fn watches_angles(&self) -> bool {
        !self.angles.is_empty()
    }

    /// Follows angles although no rows are recorded.
    pub(super) fn watch_angles(&mut self) {
        self.angles = Angles::new(&self.columns.channels);
    }

    /// Collects the extremes of all columns along the way.
    pub(super) fn collect_extremes(&mut self, motion: &ConstrainedMotion<'a>) {
        // Angles are put on their turns at once, while these are known.
        self.soon = self.angles.is_empty().then(|| (motion.dynamics.evaluator.system(), LOOKS_ALONE));
        let span = (self.schedule.start, self.schedule.end);
        self.extremes = Some(Collector::new(&self.columns.channels, span));
    }

    /// Where within the last step, from `before` to `t`, curves are looked at: nowhere unless the step is long against a
    /// turn. Near a singular position steps are short, and forces off the constraints mean nothing.
    pub(super) fn between(
        &self,
        motion: &ConstrainedMotion<'_>,
        before: f64,
        t: f64,
    ) -> impl Iterator<Item = f64> + use<> {
        let turned = (t - before) * self.ledger.fastest_turning / (2.0 * PI);
        let vibrated = (t - before) * motion.fastest() * LOOKS_PER_RADIAN;
        let looks = (turned * LOOKS_PER_TURN).min(MOST_LOOKS).max(vibrated.min(LOOKS_AT_VIBRATION));
        let asked = self.extremes.is_some() && motion.dynamics.nearness() >= PROJECTED_STAGES;
        let looks = if asked { looks } else { 0.0 };
        let pieces = looks.ceil() as usize;
        (1..pieces).map(move |piece| before + (t - before) * (piece as f64 / pieces as f64))
    }

    /// Looks are taken together once there are many: code for several states is written when it is asked for first.
    fn count_look(&mut self, motion: &ConstrainedMotion<'_>) {
        match self.soon.take() {
            Some((system, 1)) => {
                self.looks = Looks::new(system, &motion.dynamics.evaluator, self.values.len());
            }
            soon => self.soon = soon.map(|(system, more)| (system, more - 1)),
        }
    }

    /// Notes the extremes of all columns at a state of the motion.
    pub(super) fn look(
        &mut self,
        motion: &mut ConstrainedMotion<'_>,
        t: f64,
        state: &[f64],
    ) -> Result<(), RunError> {
        self.count_look(motion);
        let Some(extremes) = &mut self.extremes else { return Ok(()) };
        if let Some(looks) = &mut self.looks {
            let (q, v, _) = motion.split(state);
            let aside = motion.dynamics.aside();
            let seen = motion.dynamics.accelerate(t, q, v);
            let waits = seen.is_ok() && !motion.dynamics.is_rank_lost();
            if waits {
                looks.look(&mut motion.dynamics.evaluator, (t, q, v), &self.columns, extremes);
            }
            motion.dynamics.resume(aside);
            seen?;
            if waits {
                return Ok(());
            }
            looks.finish(extremes);
        }
        self.observe_aside(motion, t, state)?;
        self.angles.unwrap(t, &mut self.values);
        if let Some(extremes) = &mut self.extremes {
            extremes.note(t, &self.values);
        }
        Ok(())
    }

    /// The same of several flat states within a step, one behind the other: side by side where that gives the same.
    pub(super) fn look_at_several(
        &mut self,
        motion: &mut ConstrainedMotion<'_>,
        times: &[f64],
        states: &[f64],
    ) -> Result<(), RunError> {
        let length = states.len() / times.len().max(1);
        let known = self
            .looks
            .as_mut()
            .is_some_and(|looks| looks.evaluate(&mut motion.dynamics.evaluator, times, states));
        for (lane, (t, state)) in times.iter().zip(states.chunks_exact(length)).enumerate() {
            if known
                && let (Some(looks), Some(extremes)) = (&mut self.looks, &mut self.extremes)
                && motion.dynamics.regularity(looks.pivots(lane)) >= PROJECTED_STAGES
            {
                looks.look_at(&motion.dynamics.evaluator, (lane, *t), extremes);
            } else {
                self.look(motion, *t, state)?;
            }
        }
        Ok(())
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

    /// Gives the recorded samples away; `limits`: see [`super::warning::step_limits`].
    pub(super) fn finish(
        mut self,
        motion: &ConstrainedMotion<'_>,
        limits: Option<(f64, f64)>,
        stopped: Option<RunError>,
    ) -> Run {
        self.statistics.evaluations += motion.dynamics.evaluations;
        self.statistics.rank_revealing_solves = motion.dynamics.rank_revealing_solves;
        self.statistics.projections = motion.projections;
        let Ledger { balance, open, .. } = &self.ledger;
        (self.statistics.energy_error_J, self.statistics.energy_throughput_J) =
            (balance.error, balance.throughput);
        [self.statistics.max_loop_error_m, self.statistics.max_loop_error_rad] = *open;
        if let (Some(looks), Some(extremes)) = (&mut self.looks, &mut self.extremes) {
            looks.finish(extremes);
        }
        let (extremes, peaks) = self.extremes.take().map(Collector::finish).unwrap_or_default();
        let mut run = Run {
            extremes,
            peaks,
            channels: self.columns.channels,
            times: self.times,
            rows: self.rows,
            statistics: self.statistics,
            stopped,
            ..Run::default()
        };
        if let Some(follower) = self.follower {
            run.warnings = follower.warnings(&motion.dynamics.evaluator, &self.ledger, limits);
            run.turns = follower.measures;
        }
        run.warnings.extend(self.unbounded.warnings(&run.channels));
        run.warnings.extend(warning::rounded_angle(motion.angles(&self.reached.1)));
        if run.stopped.is_none() && is_doubtful(&self.ledger) {
            let Statistics { energy_error_J: error, energy_throughput_J: throughput, .. } = run.statistics;
            run.warnings.push(RunWarning::EnergyOff { error, throughput });
        }
        run
    }
}
