//! What a run gives back.

use super::contacts::TurnMeasure;
use super::warning::RunWarning;
use crate::error::RunError;

/// What a run cost and how well it kept its laws. Covers settling too.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[allow(non_snake_case, reason = "units at the end of a name keep their case")]
pub struct Statistics {
    /// Accepted steps.
    pub steps: u64,
    /// Steps tried and not accepted.
    pub rejected: u64,
    /// Evaluations of the forward dynamics (for generalised-alpha: of the equations of motion).
    pub evaluations: u64,
    /// Projections that had something to correct, at steps and samples.
    pub projections: u64,
    /// Forward dynamics that needed the rank-revealing solve.
    pub rank_revealing_solves: u64,
    /// Newton iterations of an implicit method.
    pub newton_iterations: u64,
    /// Largest loop residual in metres at any step or sample, dropped rows too [m].
    pub max_loop_error_m: f64,
    /// The same of the rows in radians [rad].
    pub max_loop_error_rad: f64,
    /// Largest |E - E0 - supplied + dissipated| at any step or sample [J]; E with the energy stored in contacts,
    /// dissipated with what damping and friction of contacts took.
    pub energy_error_J: f64,
    /// What went through: sum over the steps of |work supplied| + |work dissipated| + |change of kinetic
    /// energy| + |lost in contacts| [J]; the measure for the error.
    pub energy_throughput_J: f64,
}

/// A finished run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Run {
    /// Times of the samples [s].
    pub times: Vec<f64>,
    /// One row per sample, one value per channel (those of contacts after the generated ones, see
    /// [`crate::clearance_joint::ContactChannels`]); angles that wrap are unwrapped along time.
    pub rows: Vec<Vec<f64>>,
    /// Cost and quality.
    pub statistics: Statistics,
    /// For every full turn after settling, what every joint with clearance did in it.
    pub turns: Vec<TurnMeasure>,
    /// Where the result is not to be trusted.
    pub warnings: Vec<RunWarning>,
    /// Why the run ended before its time, if it did.
    pub stopped: Option<RunError>,
}
