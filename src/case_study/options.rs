//! How much work a study does. In: what the user asked for. Out: numbers of turns, points and steps.
//! Never knows what they are used for.

use linkwear_runtime::life::WearStep;
use linkwear_runtime::{Integrator, RevolutionSettings};
use serde::Serialize;

/// What a study is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Options {
    /// A rough study for tests of the tool: less turns, points and data sets.
    pub quick: bool,
    /// Seed of all random numbers.
    pub seed: u64,
}

/// The work in numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Effort {
    /// Time step [s].
    pub step: f64,
    /// Revolutions of the flexible mechanism, which is periodic.
    pub flexible: RevolutionSettings,
    /// Revolutions of the rigid one, which chatters: a mean of many.
    pub rigid: RevolutionSettings,
    /// Bearing angles of a profile.
    pub bins: usize,
    /// Wear steps of the proposed model, and of the finest.
    pub wear_step: WearStep,
    pub finest_wear_step: WearStep,
    /// Wear steps of a life that only has to be long enough.
    pub calibration_step: WearStep,
    /// Estimate of the work of Fig. 5, in turns of the compiled mechanism.
    pub turns_around: f64,
}

impl Effort {
    pub fn of(options: Options) -> Self {
        if options.quick { Self::quick() } else { Self::full() }
    }

    fn full() -> Self {
        let step = 2e-5;
        let settings = RevolutionSettings { integrator: Integrator::Rk4 { step }, settle: 4, average: 1 };
        Self {
            step,
            flexible: settings,
            rigid: RevolutionSettings { average: 32, ..settings },
            bins: 72,
            wear_step: WearStep::Adaptive { tolerance: 1e-3, shortest: 0.5, longest: 1 },
            finest_wear_step: WearStep::Adaptive { tolerance: 2e-4, shortest: 0.25, longest: 1 },
            calibration_step: WearStep::FULL,
            turns_around: 2500.0,
        }
    }

    fn quick() -> Self {
        let step = 2e-5;
        let settings = RevolutionSettings { integrator: Integrator::Rk4 { step }, settle: 1, average: 1 };
        Self {
            step,
            flexible: settings,
            rigid: RevolutionSettings { settle: 2, average: 6, ..settings },
            bins: 72,
            wear_step: WearStep::Cycle,
            finest_wear_step: WearStep::Cycle,
            calibration_step: WearStep::Adaptive { tolerance: 1e-2, shortest: 1.0, longest: 16 },
            turns_around: 400.0,
        }
    }
}
