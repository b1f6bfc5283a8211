//! How much work a study does. In: what the user asked for. Out: numbers of turns, points and steps.
//! Never knows what they are used for.

use linkwear_runtime::life::WearStep;
use linkwear_runtime::{Integrator, RevolutionSettings};
use serde::Serialize;

/// Wear steps that leave no error beside that of a table.
const FINEST: WearStep = WearStep::Adaptive { tolerance: 1e-7, shortest: 1e-3, longest: 1 };

/// Points of the tables that compare contact areas: the fewest that a table of two ends has.
pub(super) const AREA_POINTS: usize = 3;
/// Cost of a turn of an interpreted mechanism, roughly, in turns of a compiled one.
pub(super) const INTERPRETED: f64 = 4.0;

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
    /// Wear steps of the proposed model, and of the finest.
    pub wear_step: WearStep,
    pub finest_wear_step: WearStep,
}

impl Effort {
    /// Estimate of the work of all tables and lives for so many gammas, in turns of the compiled mechanism.
    pub fn work(&self, gammas: usize) -> f64 {
        let turns = |settings: RevolutionSettings| f64::from(settings.settle + settings.average);
        let tables = turns(self.flexible) * (self.points + 2 * self.finest_points) as f64
            + INTERPRETED * turns(self.rigid) * self.rigid_points as f64;
        let areas = 3.0 * AREA_POINTS as f64 * (turns(self.flexible) + INTERPRETED * turns(self.rigid));
        let lives = 2.0 * self.data_sets as f64 * self.work_of_data_set;
        areas + gammas as f64 * (tables + lives)
    }

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
            bins: 144,
            rigid_points: 17,
            points: 33,
            finest_points: 65,
            data_sets: 240,
            trajectories: 20_000,
            trajectories_per_set: 2_000,
            work_of_data_set: 5.0,
            wear_step: WearStep::TABLE,
            finest_wear_step: FINEST,
        }
    }

    fn quick() -> Self {
        let full = Self::full();
        let settings = RevolutionSettings { settle: 2, ..full.flexible };
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
            ..full
        }
    }
}
