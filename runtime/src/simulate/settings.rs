//! What a run is told and what it gives back. In: nothing. Out: plain data.

use super::{RunWarning, TurnMeasure};
use crate::{RunError, SINGULAR_PIVOT, SetupError};

/// Method of integration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Integrator {
    /// Classical Runge-Kutta, fixed step.
    Rk4 {
        /// Longest step [s]; shortened so that steps land on the samples.
        step: f64,
    },
    /// Dormand-Prince 5(4), adaptive, dense output.
    Dopri5 {
        /// Accuracy wanted, relative to each value (absolute below 1 rad, m, rad/s, m/s): steps are chosen
        /// so that each adds a tenth of it at most.
        tolerance: f64,
        /// Longest step [s]; a tenth of the run if `None`.
        max_step: Option<f64>,
    },
    /// Generalised-alpha on the index-3 equations (Arnold & Brüls), fixed step, order 2.
    GeneralizedAlpha {
        /// Longest step [s]; shortened so that steps land on the samples.
        step: f64,
        /// Spectral radius at infinite frequency, 0 (strong numerical damping) to 1 (none). With loops take
        /// less than 1: without damping, errors of the multipliers grow.
        rho: f64,
    },
}

/// Length of a run or of its settling.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Span {
    /// Seconds.
    Time(f64),
    /// Turns of the first driven revolute joint.
    Turns(f64),
}

/// What to run and what to record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Method.
    pub integrator: Integrator,
    /// What is recorded.
    pub span: Span,
    /// Evenly spaced samples, both ends included: 0 for none, else at least 2.
    pub samples: usize,
    /// What runs before, not recorded.
    pub settle: Span,
    /// See [`SINGULAR_PIVOT`].
    pub singular_pivot: f64,
}

impl Default for Settings {
    /// One second by Dormand-Prince at a tolerance of 1e-9, 201 samples.
    fn default() -> Self {
        Self::new(Integrator::Dopri5 { tolerance: 1e-9, max_step: None }, Span::Time(1.0), 201)
    }
}

impl Settings {
    /// Settings without settling.
    #[must_use]
    pub fn new(integrator: Integrator, span: Span, samples: usize) -> Self {
        Self { integrator, span, samples, settle: Span::Time(0.0), singular_pivot: SINGULAR_PIVOT }
    }

    /// Finds settings that make no sense.
    pub(super) fn check(&self) -> Result<(), RunError> {
        let positive = |name, value: f64| need(value.is_finite() && value > 0.0, name, value, "positive");
        match self.integrator {
            Integrator::Rk4 { step } => positive("step", step)?,
            Integrator::Dopri5 { tolerance, max_step } => {
                need((1e-14..=1e-1).contains(&tolerance), "tolerance", tolerance, "between 1e-14 and 0.1")?;
                max_step.map_or(Ok(()), |step| positive("max_step", step))?;
            }
            Integrator::GeneralizedAlpha { step, rho } => {
                positive("step", step)?;
                need((0.0..=1.0).contains(&rho), "rho", rho, "between 0 and 1")?;
            }
        }
        let (Span::Time(span) | Span::Turns(span)) = self.span;
        positive("span", span)?;
        let (Span::Time(settle) | Span::Turns(settle)) = self.settle;
        need(settle.is_finite() && settle >= 0.0, "settle", settle, "zero or positive")?;
        need(self.samples != 1, "samples", 1.0, "0 for none, or at least 2")?;
        need(
            (0.0..1.0).contains(&self.singular_pivot),
            "singular_pivot",
            self.singular_pivot,
            "between 0 and 1",
        )
    }
}

fn need(holds: bool, name: &'static str, value: f64, need: &'static str) -> Result<(), RunError> {
    if holds { Ok(()) } else { Err(SetupError::Setting { name, value, need }.into()) }
}

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
    /// [`crate::clearance::ContactChannels`]); angles that wrap are unwrapped along time.
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
