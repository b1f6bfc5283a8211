//! What a life with the dynamics at every wear step will cost, before it begins. In: a study. Out: one revolution, run and
//! timed, and what follows from it. Never lives anything.

use std::time::Instant;

use linkwear_runtime::life::{DEFAULT_POINTS, Feedback, LifeSettings, WearSource};
use linkwear_runtime::{DynamicsSource, RevolutionSettings, Watch};

use super::error::{Cause, LifeError};
use super::mission::Duty;
use super::pace::Pace;
use super::run::{Plan, joints};
use super::study::{Coupling, LifeStudy};

/// Measurements of a mean path that is measured ahead: fewest where wear is smooth, most where it scatters.
const AHEAD: [f64; 2] = [9.0, 130.0];
/// Measurements of others: fewest where wear is smooth, ...
const FEWEST: f64 = 30.0;
/// ... most where it is noisy: steps stay within a cycle at first, and reach over some thirty later.
const PER_CYCLE: [f64; 2] = [5.0, 0.1];
const FIRST_CYCLES: f64 = 50.0;
/// Measurements per cycle of a random life: one in its middle, and now and then three; four where a profile is fed back.
const PER_DRAWN_CYCLE: [f64; 2] = [1.3, 4.0];
/// How many times shorter a turn is in one of the lanes of a thread than alone: 4 to 5 in the case study.
const SHORTER_IN_LANES: f64 = 4.0;
/// Revolutions that a motion takes to settle when what it wears has hardly changed.
const TO_SETTLE: u32 = 1;

/// What full coupling costs by one revolution from the start, as far as the rest of the life is like it.
#[derive(Clone, Debug, PartialEq)]
pub struct Cost {
    /// Time that a revolution took [s].
    pub seconds_per_revolution: f64,
    /// Revolutions of a measurement.
    pub revolutions: u32,
    /// Cycles until the first joint fails, if every revolution wears as the first.
    pub cycles: f64,
    /// Measurements of the mean path, from and to.
    pub mean_path: [f64; 2],
    /// How many times shorter they take than others: those that do not wait for each other are made side by side, where a thread has lanes.
    pub mean_path_side_by_side: f64,
    /// Measurements of the random lives that one thread makes.
    pub lives: f64,
    /// How many times shorter they take than others: they are lived side by side in the lanes of a thread, where it has some.
    pub side_by_side: f64,
    /// Measurements of a table instead; nothing where a profile is fed back, which no table holds.
    pub table: Option<f64>,
    /// The life, if it has more cycles than are lived.
    pub too_long: Option<Pace>,
}

impl Cost {
    /// Time of so many measurements [s].
    pub fn seconds(&self, measurements: f64) -> f64 {
        measurements * f64::from(self.revolutions) * self.seconds_per_revolution
    }
}

impl LifeStudy<'_> {
    /// The cost of this life; nothing with a table, which costs seconds.
    ///
    /// # Errors
    /// As [`Self::run`].
    pub fn cost(&self, watch: Watch<'_>) -> Result<Option<Cost>, LifeError> {
        self.wears()?;
        let system = self.mechanism.system();
        let once = RevolutionSettings { settle: Some(0), average: 1, ..self.revolutions };
        let duty = Duty::new(self, &*system)?;
        let code = self.machine_code();
        let sources = code.run(duty.sources(&*system, once, watch)?);
        let unworn = sources.first().map_or_else(Vec::new, DynamicsSource::unworn);
        let plan = Plan::new(self, &duty, joints(&sources)?, None, (watch, watch))?;
        let mut source = duty.compose(sources);
        if plan.coupling == Coupling::Table {
            return Ok(None);
        }
        let LifeSettings { joints, most_cycles, .. } = &plan.settings;
        let start = Instant::now();
        let measured = source.measure(&unworn, &mut Vec::new()).map_err(Cause::from)?;
        let seconds_per_revolution = start.elapsed().as_secs_f64();
        let wears = joints.iter().zip(&measured);
        let wears = wears.map(|(joint, measured)| joint.revolutions_per_cycle * joint.wear.of(measured));
        let pace = Pace::of(joints, wears);
        let cycles = pace.as_ref().map_or(f64::INFINITY, |pace| pace.cycles);
        let is_ahead = plan.settings.is_measured_ahead();
        let [first, later] = PER_CYCLE;
        let most = first * cycles.min(FIRST_CYCLES) + later * (cycles - FIRST_CYCLES).max(0.0);
        let step_by_step = [FEWEST, most.max(FEWEST)];
        let shorter = if code.has_lanes() { SHORTER_IN_LANES } else { 1.0 };
        let lives = plan.trajectories.unwrap_or(0) as f64 / plan.threads.get() as f64;
        let has_table = joints.iter().all(|joint| joint.feedback != Feedback::Profile);
        // With several joints every point needs a predictor.
        let table = DEFAULT_POINTS as f64 * if joints.len() > 1 { 2.0 } else { 1.0 };
        Ok(Some(Cost {
            seconds_per_revolution,
            revolutions: self.revolutions.settle.unwrap_or(TO_SETTLE) + self.revolutions.average.max(1),
            cycles,
            mean_path: if is_ahead { AHEAD } else { step_by_step },
            mean_path_side_by_side: if is_ahead { shorter } else { 1.0 },
            lives: lives * PER_DRAWN_CYCLE[usize::from(!has_table)] * cycles,
            side_by_side: plan.lanes().map_or(1.0, |_| SHORTER_IN_LANES),
            table: has_table.then_some(table),
            too_long: pace.filter(|pace| pace.cycles > *most_cycles as f64),
        }))
    }
}
