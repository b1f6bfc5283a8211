//! What makes the numbers of a run wrong, not only doubtful. In: what every accepted step shows. Out: [`RunError`]s.
//! Counts steps, never seconds: the same run ends the same way on every machine. Never knows integrators.

use std::f64::consts::PI;

use super::motion::ConstrainedMotion;
use crate::error::RunError;
use crate::evaluate::{CLOSED, LoopError};
use crate::ledger::{Balance, Ledger};

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
/// An error below this part of the work of wear, the integral of normal force by way, says nothing of forces and wear that a run tells:
/// they are right to that part. A rotor that slides without friction passes nothing on, but for what steps within their tolerance shake
/// its contact by: five parts in a million a step of what the contact stores, some 1e-7 of the work of wear. With a coefficient of
/// friction above 0.05 a tenth of that work goes through, supplied and dissipated: nothing is judged otherwise then.
const BESIDE_WEAR: f64 = 1e-3;
/// A motion of which no more than this part went through before the last balance has just begun: its energies are smaller than its steps
/// are exact, and it is judged at the next balance, or at the end.
const JUST_BEGUN: f64 = 1e-3;
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
    next_balance: f64,
    /// What had gone through at the last balance [J].
    through: f64,
    /// Steps tried and time at the beginning of the present window.
    window: (u64, f64),
}

impl Guard {
    /// Begins a run from `begin` to `end` [s], after so many steps tried.
    pub(super) fn new((begin, end): (f64, f64), tried: u64) -> Self {
        let span = end - begin;
        Self { end, span, next_balance: begin + span / BALANCES, through: 0.0, window: (tried, begin) }
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

    /// Whether anything is judged at the end of an accepted step, after so many steps tried.
    pub(super) fn is_due(&self, t: f64, tried: u64) -> bool {
        t >= self.next_balance || t == self.end || tried - self.window.0 >= WINDOW
    }

    /// Judges an accepted step that ends in a flat state, by what was added up so far.
    pub(super) fn check_step(
        &mut self,
        motion: &mut ConstrainedMotion<'_>,
        (t, tried): (f64, u64),
        (state, ledger): (&[f64], &mut Ledger<f64>),
    ) -> Result<(), RunError> {
        if !self.is_due(t, tried) {
            return Ok(());
        }
        if t >= self.next_balance || t == self.end {
            self.next_balance +=
                (((t - self.next_balance) * BALANCES / self.span).floor() + 1.0) * self.span / BALANCES;
            let before = core::mem::replace(&mut self.through, ledger.balance.throughput);
            if t == self.end || before > JUST_BEGUN * self.through {
                check_balance(t, ledger, motion.worn(state))?;
            }
        }
        let in_window = tried - self.window.0;
        if in_window < WINDOW {
            return Ok(());
        }
        let gained = t - self.window.1;
        self.window = (tried, t);
        note_driver(motion, t, ledger);
        let a_turn = 2.0 * PI / ledger.fastest_turning;
        let turning = if a_turn.is_finite() { LEAST_OF_A_TURN * a_turn.min(self.span) } else { 0.0 };
        if gained < turning.max(LEAST_OF_THE_RUN * self.span) {
            let joint = deepest_contact(motion);
            return Err(RunError::NoProgress { t, tried: in_window, gained, joint });
        }
        Ok(())
    }
}

/// Notes how fast the driver of turns is.
pub(super) fn note_driver(motion: &mut ConstrainedMotion<'_>, t: f64, ledger: &mut Ledger<f64>) {
    let evaluator = &mut motion.dynamics.evaluator;
    if let Some(driver) = evaluator.description().turn_driver {
        ledger.fastest_turning = ledger.fastest_turning.max(evaluator.prescribed(t)[3 * driver + 1].abs());
    }
}

/// Whether the error of the balance is more than rounding of something that moves, and beside this work of wear [J].
fn is_judged(ledger: &Ledger<f64>, wear: f64) -> bool {
    let Balance { error, largest, .. } = ledger.balance;
    // What is not a number is judged.
    let is_small = error <= BALANCE_ROUNDING * largest || error <= BESIDE_WEAR * wear;
    ledger.fastest > AT_REST && !is_small
}

fn check_balance(t: f64, ledger: &Ledger<f64>, wear: f64) -> Result<(), RunError> {
    let Balance { error, throughput, .. } = ledger.balance;
    // What is not a number is not balanced.
    let balanced = error <= ENERGY_WRONG * ledger.balance.at_stake();
    if is_judged(ledger, wear) && !balanced {
        Err(RunError::EnergyLost { t, error, throughput })
    } else {
        Ok(())
    }
}

/// Whether the balance at the end is doubtful, beside this work of wear [J].
pub(super) fn is_doubtful(ledger: &Ledger<f64>, wear: f64) -> bool {
    is_judged(ledger, wear) && ledger.balance.error > ENERGY_DOUBTFUL * ledger.balance.at_stake()
}

/// The joint with clearance that is pressed in deepest, by its clearance.
fn deepest_contact(motion: &ConstrainedMotion<'_>) -> Option<String> {
    let evaluator = &motion.dynamics.evaluator;
    let contacts = evaluator.clearances().contacts().iter().zip(&*evaluator.description().contacts);
    let depth = |touch: &crate::clearance_joint::ContactState| touch.penetration() / touch.clearance;
    let deepest = contacts.max_by(|(a, _), (b, _)| depth(a).total_cmp(&depth(b)));
    deepest.map(|(_, info)| info.joint.to_string())
}
