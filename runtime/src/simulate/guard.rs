//! What makes the numbers of a run wrong, not only doubtful. In: what every accepted step shows. Out: [`RunError`]s.
//! Counts steps, never seconds: the same run ends the same way on every machine. Never knows integrators.

use std::f64::consts::PI;

use super::motion::ConstrainedMotion;
use super::run::Statistics;
use crate::error::RunError;
use crate::evaluate::{CLOSED, LoopError};

/// Part of the energy that went through which may be missing before a run draws a warning: coarse legitimate runs lose
/// 2e-4 of it at most, and forces go wrong about as the energy does.
pub(super) const ENERGY_DOUBTFUL: f64 = 0.01;
/// Part from which nothing of a run is to be believed.
const ENERGY_WRONG: f64 = 0.1;
/// Balances are judged so many times over a run, each time over all of it so far.
const BALANCES: f64 = 10.0;
/// An error below this part of the largest energy of the run is rounding of large numbers that cancel, as those of a
/// mechanism at rest high above zero.
const BALANCE_ROUNDING: f64 = 1e-9;
/// A mechanism whose speeds stay below this [rad/s, m/s] is at rest but for rounding.
const AT_REST: f64 = 1e-11;
/// Steps tried after which progress is asked for.
const WINDOW: u64 = 20_000;
/// Part of a turn (or of the whole run, if that is shorter) that so many steps have to gain: a turn of 2e8 steps is none
/// that anybody waits for.
const LEAST_OF_A_TURN: f64 = 1e-4;
/// Part of the whole run that so many steps have to gain, if nothing turns.
const LEAST_OF_THE_RUN: f64 = 1e-9;

/// Watches one run.
pub(super) struct Guard {
    end: f64,
    span: f64,
    /// Largest speed of any coordinate so far, and of those that turn.
    fastest: f64,
    fastest_turning: f64,
    /// All bits for every free speed that turns, none for others.
    turning: Vec<u64>,
    /// Largest part of the energy so far [J].
    energy: f64,
    next_balance: f64,
    /// Steps tried and time at the beginning of the present window.
    window: (u64, f64),
}

impl Guard {
    /// Begins at a state, for a run from `begin` to `end` [s] of which these are the statistics so far.
    pub(super) fn new(
        motion: &mut ConstrainedMotion<'_>,
        (begin, end): (f64, f64),
        state: &[f64],
        statistics: &Statistics,
    ) -> Self {
        let span = end - begin;
        let speeds = motion.dynamics.evaluator.description().speeds.iter();
        let mut guard = Self {
            turning: speeds.map(|info| if turns(&info.unit) { u64::MAX } else { 0 }).collect(),
            end,
            span,
            fastest: 0.0,
            fastest_turning: 0.0,
            energy: 0.0,
            next_balance: begin + span / BALANCES,
            window: (statistics.steps + statistics.rejected, begin),
        };
        guard.note_speeds(motion, state);
        guard.note_driver(motion, begin);
        guard
    }

    /// Notes how large an energy was met [J].
    pub(super) fn note_energy(&mut self, energy: f64) {
        self.energy = self.energy.max(energy);
    }

    /// Whether loops that are open by this still count as closed.
    pub(super) fn check_loops(
        &self,
        motion: &ConstrainedMotion<'_>,
        t: f64,
        error: LoopError,
    ) -> Result<(), RunError> {
        let LoopError { metres: residual_m, radians: residual_rad, worst } = error;
        if error.part(motion.arm) > CLOSED {
            let joint = motion.dynamics.evaluator.joint_of_row(worst);
            return Err(RunError::LostAssembly { t, joint, residual_m, residual_rad });
        }
        Ok(())
    }

    /// Judges an accepted step that ends in `state`, by the statistics so far.
    pub(super) fn check_step(
        &mut self,
        motion: &mut ConstrainedMotion<'_>,
        t: f64,
        state: &[f64],
        statistics: &Statistics,
    ) -> Result<(), RunError> {
        self.note_speeds(motion, state);
        if t >= self.next_balance || t == self.end {
            self.next_balance +=
                (((t - self.next_balance) * BALANCES / self.span).floor() + 1.0) * self.span / BALANCES;
            self.check_balance(t, statistics)?;
        }
        let tried = statistics.steps + statistics.rejected - self.window.0;
        if tried < WINDOW {
            return Ok(());
        }
        let gained = t - self.window.1;
        self.window = (statistics.steps + statistics.rejected, t);
        self.note_driver(motion, t);
        let a_turn = 2.0 * PI / self.fastest_turning;
        let turning = if a_turn.is_finite() { LEAST_OF_A_TURN * a_turn.min(self.span) } else { 0.0 };
        if gained < turning.max(LEAST_OF_THE_RUN * self.span) {
            return Err(RunError::NoProgress { t, tried, gained, joint: deepest_contact(motion) });
        }
        Ok(())
    }

    fn note_speeds(&mut self, motion: &ConstrainedMotion<'_>, state: &[f64]) {
        let (_, v, _) = motion.split(state);
        // Magnitudes are ordered as their bits are: no branches.
        let (mut most, mut turning) = (self.fastest.to_bits(), self.fastest_turning.to_bits());
        for (speed, turns) in v.iter().zip(&self.turning) {
            let size = speed.abs().to_bits();
            most = most.max(size);
            turning = turning.max(size & turns);
        }
        (self.fastest, self.fastest_turning) = (f64::from_bits(most), f64::from_bits(turning));
    }

    /// Largest speed of anything that turns so far [rad/s], the driver at the begin included.
    pub(super) fn fastest_turning(&self) -> f64 {
        self.fastest_turning
    }

    fn note_driver(&mut self, motion: &mut ConstrainedMotion<'_>, t: f64) {
        let evaluator = &mut motion.dynamics.evaluator;
        if let Some(driver) = evaluator.description().turn_driver {
            self.fastest_turning = self.fastest_turning.max(evaluator.prescribed(t)[3 * driver + 1].abs());
        }
    }

    fn check_balance(&self, t: f64, statistics: &Statistics) -> Result<(), RunError> {
        let (error, throughput) = (statistics.energy_error_J, statistics.energy_throughput_J);
        let judged = self.fastest > AT_REST && error > BALANCE_ROUNDING * self.energy;
        // What is not a number is not balanced.
        let balanced = error <= ENERGY_WRONG * throughput;
        if judged && !balanced { Err(RunError::EnergyLost { t, error, throughput }) } else { Ok(()) }
    }

    /// Whether the balance at the end is doubtful.
    pub(super) fn is_doubtful(&self, statistics: &Statistics) -> bool {
        let error = statistics.energy_error_J;
        self.fastest > AT_REST
            && error > BALANCE_ROUNDING * self.energy
            && error > ENERGY_DOUBTFUL * statistics.energy_throughput_J
    }
}

/// Whether a speed of this unit is one of turning.
fn turns(unit: &str) -> bool {
    unit.starts_with("rad")
}

/// The joint with clearance that is pressed in deepest, by its clearance.
fn deepest_contact(motion: &ConstrainedMotion<'_>) -> Option<String> {
    let evaluator = &motion.dynamics.evaluator;
    let contacts = evaluator.clearances().contacts().iter().zip(&*evaluator.description().contacts);
    let depth = |touch: &crate::clearance_joint::ContactState| touch.penetration() / touch.clearance;
    let deepest = contacts.max_by(|(a, _), (b, _)| depth(a).total_cmp(&depth(b)));
    deepest.map(|(_, info)| info.joint.to_string())
}
