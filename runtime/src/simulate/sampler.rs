//! What is recorded along the way: sampled rows, unwrapped angles, energy balance, loop error.
//! In: states at steps and sample times. Out: a [`Run`]. Never knows integrators.

use std::f64::consts::PI;
use std::ops::ControlFlow;

use super::motion::ConstrainedMotion;
use super::schedule::Schedule;
use super::{Progress, Run, Statistics};
use crate::{LoopError, RunError};

/// Recorder of one run.
pub(super) struct Sampler {
    schedule: Schedule,
    pub(super) statistics: Statistics,
    times: Vec<f64>,
    rows: Vec<Vec<f64>>,
    /// Last value of every channel, unwrapped.
    last: Option<Vec<f64>>,
    wraps: Vec<bool>,
    start_energy: f64,
    kinetic: f64,
    work: (f64, f64),
}

impl Sampler {
    pub(super) fn new(motion: &mut ConstrainedMotion<'_>, schedule: Schedule, state: &[f64]) -> Self {
        let channels = &motion.dynamics.evaluator.description().channels;
        let wraps = channels.iter().map(|channel| channel.wraps).collect();
        let (q, v, work) = motion.split(state);
        let (kinetic, potential) = motion.dynamics.evaluator.energy(0.0, q, v);
        motion.energy_scale = motion.energy_scale.max(kinetic);
        Self {
            schedule,
            statistics: Statistics::default(),
            times: Vec::with_capacity(schedule.samples),
            rows: Vec::with_capacity(schedule.samples),
            last: None,
            wraps,
            start_energy: kinetic + potential,
            kinetic,
            work,
        }
    }

    /// End of the run [s].
    pub(super) fn end(&self) -> f64 {
        self.schedule.end
    }

    /// The time up to which steps may be spread evenly from `t`; `None` at the end.
    pub(super) fn next_stop(&self, t: f64) -> Option<f64> {
        let next = if self.times.len() < self.schedule.samples {
            self.schedule.time(self.times.len())
        } else {
            self.schedule.end
        };
        if t < next { Some(next) } else { None }
    }

    /// The next sample time strictly before `t`.
    pub(super) fn due_before(&self, t: f64) -> Option<f64> {
        let time = self.schedule.time(self.times.len());
        (self.times.len() < self.schedule.samples && time < t).then_some(time)
    }

    /// Whether a sample is due at exactly `t`.
    pub(super) fn is_due(&self, t: f64) -> bool {
        self.times.len() < self.schedule.samples && self.schedule.time(self.times.len()) == t
    }

    /// The state at t = 0: a sample unless the run settles first.
    pub(super) fn sample_at_start(
        &mut self,
        motion: &mut ConstrainedMotion<'_>,
        state: &[f64],
    ) -> Result<(), RunError> {
        let mut state = state.to_vec();
        if self.is_due(0.0) {
            self.sample(motion, 0.0, &mut state)
        } else {
            self.observe(motion, 0.0, &state, None)
        }
    }

    /// Records a row; `state` is put onto the constraints first, if it is not there.
    pub(super) fn sample(
        &mut self,
        motion: &mut ConstrainedMotion<'_>,
        t: f64,
        state: &mut [f64],
    ) -> Result<(), RunError> {
        motion.put_on(t, state)?;
        self.note_loop_error(motion.loop_error());
        self.note_energy(motion, t, state);
        let mut row = vec![0.0; self.wraps.len()];
        self.observe(motion, t, state, Some(&mut row))?;
        self.times.push(t);
        self.rows.push(row);
        Ok(())
    }

    /// Notes an accepted step that ends in `state`.
    pub(super) fn step_done(
        &mut self,
        motion: &mut ConstrainedMotion<'_>,
        t: f64,
        state: &[f64],
    ) -> Result<(), RunError> {
        self.statistics.steps += 1;
        let kinetic = self.note_energy(motion, t, state);
        let (_, _, work) = motion.split(state);
        self.statistics.energy_throughput_J +=
            (work.0 - self.work.0).abs() + (work.1 - self.work.1).abs() + (kinetic - self.kinetic).abs();
        (self.kinetic, self.work) = (kinetic, work);
        motion.energy_scale = motion.energy_scale.max(kinetic);
        // Between samples an angle may turn more than once: follow it at every step.
        if self.wraps.contains(&true) && !self.is_due(t) {
            self.observe(motion, t, state, None)
        } else {
            Ok(())
        }
    }

    /// Tells the caller how far the run is.
    pub(super) fn report(&self, t: f64, progress: Progress<'_>) -> Result<(), RunError> {
        match progress(t / self.schedule.end) {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(RunError::Interrupted { t }),
        }
    }

    /// Evaluates the channels and unwraps the angles among them.
    fn observe(
        &mut self,
        motion: &mut ConstrainedMotion<'_>,
        t: f64,
        state: &[f64],
        row: Option<&mut [f64]>,
    ) -> Result<(), RunError> {
        let (q, v, _) = motion.split(state);
        motion.dynamics.accelerate(t, q, v)?;
        let values = motion.dynamics.evaluator.observe(t, q, v);
        if row.is_some()
            && let Some(i) = values.iter().position(|x| !x.is_finite())
        {
            let what = motion.dynamics.evaluator.description().channels[i].name.to_string();
            return Err(RunError::NonFinite { t, what });
        }
        let last = self.last.get_or_insert_with(|| values.to_vec());
        for ((last, value), wraps) in last.iter_mut().zip(values).zip(&self.wraps) {
            let turns = if *wraps { ((*last - value) / (2.0 * PI)).round() } else { 0.0 };
            *last = value + 2.0 * PI * turns;
        }
        if let Some(row) = row {
            row.copy_from_slice(last);
        }
        Ok(())
    }

    /// Notes how far loops are open.
    pub(super) fn note_loop_error(&mut self, error: LoopError) {
        self.statistics.max_loop_error_m = self.statistics.max_loop_error_m.max(error.metres);
        self.statistics.max_loop_error_rad = self.statistics.max_loop_error_rad.max(error.radians);
    }

    /// Notes the balance and returns the kinetic energy [J].
    fn note_energy(&mut self, motion: &mut ConstrainedMotion<'_>, t: f64, state: &[f64]) -> f64 {
        let (q, v, (supplied, dissipated)) = motion.split(state);
        let (kinetic, potential) = motion.dynamics.evaluator.energy(t, q, v);
        let error = (kinetic + potential - self.start_energy - supplied + dissipated).abs();
        self.statistics.energy_error_J = self.statistics.energy_error_J.max(error);
        kinetic
    }

    /// Gives the recorded samples away.
    pub(super) fn finish(mut self, motion: &ConstrainedMotion<'_>, stopped: Option<RunError>) -> Run {
        self.statistics.evaluations += motion.dynamics.evaluations;
        self.statistics.rank_revealing_solves = motion.dynamics.rank_revealing_solves;
        self.statistics.projections = motion.projections;
        Run { times: self.times, rows: self.rows, statistics: self.statistics, stopped }
    }
}
