//! How much work a study does. In: what the user asked for. Out: numbers of turns, points and steps.
//! Never knows what they are used for.

use linkwear_runtime::{Integrator, RevolutionSettings};
use serde::Serialize;

/// Time step of Runge-Kutta [s].
pub(super) const STEP: f64 = 2e-5;

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
    /// Revolutions of the flexible mechanism, which is periodic.
    pub flexible: RevolutionSettings,
    /// Revolutions of the rigid one, which chatters: a mean of many.
    pub rigid: RevolutionSettings,
    /// Bearing angles of a profile, the same for all models: the largest depth depends on how finely it is looked for.
    pub bins: usize,
    /// Points of the tables: rigid, proposed, finest.
    pub rigid_points: usize,
    pub points: usize,
    pub finest_points: usize,
    /// Data sets of histories.
    pub data_sets: u64,
    /// Random lives of the truth, and of a density.
    pub trajectories: u64,
    /// Random lives that a prediction from one data set is made of.
    pub trajectories_per_set: u64,
    /// Work of one data set, in turns of the compiled mechanism.
    pub work_of_data_set: f64,
}

impl Effort {
    pub fn of(options: Options) -> Self {
        if options.quick { Self::quick() } else { Self::full() }
    }

    fn full() -> Self {
        let integrator = Integrator::Rk4 { step: STEP };
        let settings = RevolutionSettings { integrator, settle: Some(4), average: 1 };
        Self {
            flexible: settings,
            rigid: RevolutionSettings { average: 32, ..settings },
            bins: 144,
            rigid_points: 17,
            points: 33,
            finest_points: 65,
            data_sets: 240,
            trajectories: 20_000,
            trajectories_per_set: 2_000,
            work_of_data_set: 5.0,
        }
    }

    fn quick() -> Self {
        let full = Self::full();
        let settings = RevolutionSettings { settle: Some(2), ..full.flexible };
        Self {
            flexible: settings,
            rigid: RevolutionSettings { average: 4, ..settings },
            bins: 72,
            rigid_points: 4,
            points: 5,
            finest_points: 7,
            data_sets: 10,
            trajectories: 2_000,
            trajectories_per_set: 300,
            work_of_data_set: 1.0,
        }
    }
}
