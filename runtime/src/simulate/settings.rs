//! What a run is told.

use core::ops::RangeInclusive;

use crate::description::Description;
use crate::dynamics::SINGULAR_PIVOT;
use crate::error::{RunError, SetupError};

/// Method of integration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Integrator {
    /// Classical Runge-Kutta, fixed step.
    Rk4 {
        /// Longest step [s]; shortened so that steps land on the samples.
        step: f64,
    },
    /// Dormand-Prince 5(4), adaptive, dense output: for smooth motion.
    Dopri5 {
        /// Accuracy wanted, relative to each value (absolute below 1 rad, m, rad/s, m/s): steps are chosen
        /// so that each adds a tenth of it at most.
        tolerance: f64,
        /// Longest step [s]; a tenth of the run if `None`.
        max_step: Option<f64>,
    },
    /// Rodas5P 5(4), a linearly implicit method, adaptive, dense output: for flexible bodies whose modes are much faster than the
    /// motion, and other stiff parts.
    Rodas5P {
        /// Accuracy wanted: of forces, relative to the loads on modes; of all else as for [`Self::Dopri5`].
        tolerance: f64,
        /// Longest step [s]; a tenth of the run if `None`.
        max_step: Option<f64>,
    },
    /// [`Self::Rodas5P`] where its longer steps pay, else [`Self::Dopri5`]: for flexible bodies, stiff springs and dampers, friction that
    /// holds.
    Switching {
        /// As for [`Self::Rodas5P`]; without flexible bodies as for [`Self::Dopri5`].
        tolerance: f64,
        /// Longest step [s]; a tenth of the run if `None`.
        max_step: Option<f64>,
    },
    /// Runge-Kutta 4(3), adaptive, dense output: for joints with clearance.
    Rk43 {
        /// Relative error of the wear integrals, where the motion is not chaotic; steps go by 1e-4 at the most.
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

impl Integrator {
    /// Accuracies that a run may ask for.
    pub const TOLERANCES: RangeInclusive<f64> = 1e-14..=1e-1;
    /// Tolerance of smooth motion where none is asked for.
    pub const SMOOTH_TOLERANCE: f64 = 1e-9;
    /// Tolerance with flexible bodies where none is asked for.
    pub const MODAL_TOLERANCE: f64 = 1e-7;
    /// Tolerance with clearance where none is asked for.
    pub const CONTACT_TOLERANCE: f64 = 1e-6;

    /// Beyond this, steps leave contacts that they should not: the wear integral of a slider-crank errs by a tenth at 2e-4 and by 2e-4
    /// at 1e-4, and loops of the case study cannot be closed any more at 5e-3.
    const LOOSEST_CONTACT: f64 = 1e-4;

    /// The tolerance that steps with clearance go by, of the one asked for.
    pub(super) const fn of_contacts(tolerance: f64) -> f64 {
        tolerance.min(Self::LOOSEST_CONTACT)
    }

    /// The adaptive method that suits a mechanism: modes of flexible bodies are often much faster than the motion, contacts vibrate faster than anything that is asked for, and steps are long
    /// with the method that bears most of that.
    pub fn adaptive(description: &Description, tolerance: Option<f64>) -> Self {
        if !description.contacts.is_empty() {
            return Self::Rk43 { tolerance: tolerance.unwrap_or(Self::CONTACT_TOLERANCE), max_step: None };
        }
        let has_modes = description.modes().next().is_some();
        let usual = if has_modes { Self::MODAL_TOLERANCE } else { Self::SMOOTH_TOLERANCE };
        Self::Switching { tolerance: tolerance.unwrap_or(usual), max_step: None }
    }

    /// Its step [s], if that is fixed.
    pub const fn step(self) -> Option<f64> {
        match self {
            Self::Rk4 { step } | Self::GeneralizedAlpha { step, .. } => Some(step),
            Self::Dopri5 { .. } | Self::Rodas5P { .. } | Self::Switching { .. } | Self::Rk43 { .. } => None,
        }
    }

    /// What it is told of its accuracy, if it chooses its steps.
    pub const fn tolerance(self) -> Option<f64> {
        match self {
            Self::Dopri5 { tolerance, .. }
            | Self::Rodas5P { tolerance, .. }
            | Self::Switching { tolerance, .. }
            | Self::Rk43 { tolerance, .. } => Some(tolerance),
            Self::Rk4 { .. } | Self::GeneralizedAlpha { .. } => None,
        }
    }

    /// The same, as exact as this at least, if it chooses its steps.
    pub(crate) fn at_least(self, tight: f64) -> Self {
        match self {
            Self::Dopri5 { tolerance, max_step } => {
                Self::Dopri5 { tolerance: tolerance.min(tight), max_step }
            }
            Self::Rodas5P { tolerance, max_step } => {
                Self::Rodas5P { tolerance: tolerance.min(tight), max_step }
            }
            Self::Switching { tolerance, max_step } => {
                Self::Switching { tolerance: tolerance.min(tight), max_step }
            }
            Self::Rk43 { tolerance, max_step } => Self::Rk43 { tolerance: tolerance.min(tight), max_step },
            Self::Rk4 { .. } | Self::GeneralizedAlpha { .. } => self,
        }
    }
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
    pub fn new(integrator: Integrator, span: Span, samples: usize) -> Self {
        Self { integrator, span, samples, settle: Span::Time(0.0), singular_pivot: SINGULAR_PIVOT }
    }

    /// Finds settings that make no sense.
    pub(super) fn check(&self) -> Result<(), RunError> {
        let positive = |name, value: f64| need(value.is_finite() && value > 0.0, name, value, "positive");
        match self.integrator {
            Integrator::Rk4 { step } => positive("step", step)?,
            Integrator::Dopri5 { tolerance, max_step }
            | Integrator::Rodas5P { tolerance, max_step }
            | Integrator::Switching { tolerance, max_step }
            | Integrator::Rk43 { tolerance, max_step } => {
                need(
                    Integrator::TOLERANCES.contains(&tolerance),
                    "tolerance",
                    tolerance,
                    "between 1e-14 and 0.1",
                )?;
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
