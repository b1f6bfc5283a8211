//! What became of a life. In: the mean path, random lives. Out: their statistics and how far off they may be.
//! Never knows how they were lived.

use linkwear_gamma::life::{Contribution, ErrorBudget, LifeStatistics};
use linkwear_runtime::life::{CycleRecord, FailureEvent, JointLife, TableReport};
use linkwear_runtime::wear::Profile;
use serde::{Deserialize, Serialize};

use super::counted::CountedEnds;
use super::mission_result::MissionResult;
use super::paths::LifePaths;
use super::process::JointProcess;
use super::steady::TurnErrors;
use super::study::Coupling;

/// A life to the failure threshold, in cycles.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct LifeResult {
    /// The wearing joints.
    pub joints: Vec<JointLife>,
    /// Where wear was from.
    pub coupling: Coupling,
    /// End of the mean path.
    pub end: FailureEvent,
    /// Cycles of the mean path.
    pub cycles: Vec<CycleRecord>,
    /// Estimated error of the mean path by its wear steps [cycles].
    pub step_error: f64,
    /// Ends of the random lives, in the order of their numbers; none of them if only the mean path was lived, or if they are
    /// counted.
    pub lives: Vec<FailureEvent>,
    /// The random lives, if they are more than [`LifeStudy::listed`](super::LifeStudy::listed).
    pub counted: Option<CountedEnds>,
    /// Wear of the first random lives at whole cycles; none if only the mean path was lived.
    pub paths: Option<LifePaths>,
    /// Gamma process of each wearing joint, if all have one.
    pub process: Option<Vec<JointProcess>>,
    /// The table of wear per revolution and its errors, if there is one.
    pub table: Option<TableReport>,
    /// Measurements of revolutions.
    pub measurements: u64,
    /// What was doubtful.
    pub warnings: Vec<String>,
    /// What was odd about the machine, not about the life.
    #[serde(skip)]
    pub thread_note: Option<String>,
    /// Standard error of the mean life by the covariances of fits, if there are any [cycles].
    pub parameter_error: Option<f64>,
    /// What turns that are not steady do to the life of the joint that ends the mean path.
    pub turn_errors: TurnErrors,
    /// How long a revolution lasts [s], if all last equally long; in a mission their mean.
    pub seconds_per_revolution: Option<f64>,
    /// Joints whose journals wear, as they are after the last cycle of the mean path.
    #[serde(default)]
    pub worn: Vec<WornPair>,
    /// How it was used, if by a mission.
    #[serde(default)]
    pub mission: Option<MissionResult>,
}

/// A joint whose bush and journal are worn.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct WornPair {
    /// Its name.
    pub joint: String,
    /// Depth of the bush by bearing angle, if it is kept.
    pub bush: Option<Profile>,
    /// Depth of the journal by its own angle.
    pub journal: Profile,
}

/// The numbers that a life is told by: those of the random lives, or of the mean path where there are none [cycles].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LifeNumbers {
    /// Mean.
    pub mean: f64,
    /// Its standard error, if there are random lives.
    pub mean_error: Option<f64>,
    /// Standard deviation.
    pub std: f64,
    /// Coefficient of variation [1].
    pub cov: f64,
    /// Cycles before which a tenth has failed.
    pub p10: f64,
    /// The median.
    pub p50: f64,
    /// Cycles before which nine tenths have failed.
    pub p90: f64,
    /// Mean as inspections after whole cycles see it.
    pub mean_whole_cycles: f64,
    /// Revolutions of the mean life.
    pub revolutions: f64,
    /// The mean life at the speed of the drive [h], if all revolutions last equally long.
    pub hours: Option<f64>,
}

/// Seconds of an hour.
pub const HOUR: f64 = 3600.0;
/// Seconds of a year of 365.25 days.
pub const YEAR: f64 = 8766.0 * HOUR;

impl LifeResult {
    /// The numbers it is told by; `statistics` are [`Self::statistics`].
    pub fn numbers(&self, statistics: Option<&LifeStatistics>) -> LifeNumbers {
        let mean = self.mean();
        let quantile = |p| {
            let quantile = statistics.and_then(|lives| lives.quantile(p).ok());
            quantile.map_or(mean, |quantile| quantile.value)
        };
        LifeNumbers {
            mean,
            mean_error: statistics.map(|lives| lives.mean().error),
            std: statistics.map_or(0.0, |lives| lives.std().value),
            cov: statistics.map_or(0.0, |lives| lives.cov().value),
            p10: quantile(0.1),
            p50: quantile(0.5),
            p90: quantile(0.9),
            mean_whole_cycles: self.mean_whole_cycles(),
            revolutions: mean * self.failed_joint().revolutions_per_cycle,
            hours: self.seconds_per_cycle().map(|seconds| mean * seconds / HOUR),
        }
    }

    /// In what another shard of the same study differs although it may not; nothing if it is as it must be.
    pub(super) fn differs(&self, other: &Self) -> Option<&'static str> {
        let same = [
            ("the joints", self.joints == other.joints),
            ("the mean path", self.end == other.end && self.cycles == other.cycles),
            ("the processes of wear", self.process == other.process),
            ("the table of wear", self.table == other.table && self.measurements == other.measurements),
            ("the mission", self.mission == other.mission),
            ("how lives are told", self.counted.is_some() == other.counted.is_some()),
        ];
        same.iter().find(|(_, is_same)| !is_same).map(|(what, _)| *what)
    }

    /// With the lives of the next shard.
    pub(super) fn joined(mut self, next: Self) -> Self {
        self.lives.extend(next.lives);
        if let (Some(all), Some(more)) = (&mut self.counted, &next.counted) {
            all.merge(more);
        }
        if let (Some(all), Some(more)) = (&mut self.paths, next.paths) {
            all.join(more);
        }
        self
    }

    /// Names of the wearing joints.
    pub fn names(&self) -> Vec<String> {
        self.joints.iter().map(|joint| joint.joint.clone()).collect()
    }

    /// Statistics of the random lives with their standard errors [cycles]; none with fewer than two lives.
    pub fn statistics(&self) -> Option<LifeStatistics> {
        if let Some(counted) = &self.counted {
            return LifeStatistics::counted(counted.cycles()).ok();
        }
        let cycles: Vec<f64> = self.lives.iter().map(|end| end.cycles).collect();
        LifeStatistics::of(&cycles).ok()
    }

    /// Number of random lives.
    pub fn random_lives(&self) -> u64 {
        self.counted.as_ref().map_or(self.lives.len() as u64, |counted| counted.cycles().count())
    }

    /// Ends of the random lives, or that of the mean path alone.
    fn ends(&self) -> &[FailureEvent] {
        if self.lives.is_empty() { std::slice::from_ref(&self.end) } else { &self.lives }
    }

    /// Mean life [cycles]; that of the mean path where no random lives were drawn.
    pub fn mean(&self) -> f64 {
        let listed = || self.ends().iter().map(|end| end.cycles).sum::<f64>() / self.ends().len() as f64;
        self.counted.as_ref().map_or_else(listed, |counted| counted.cycles().mean())
    }

    /// Mean life as inspections after whole cycles see it.
    pub fn mean_whole_cycles(&self) -> f64 {
        let whole = |end: &FailureEvent| end.whole_cycles as f64;
        let listed = || self.ends().iter().map(whole).sum::<f64>() / self.ends().len() as f64;
        self.counted.as_ref().map_or_else(listed, CountedEnds::mean_whole_cycles)
    }

    /// Part of the lives that each joint ended.
    pub fn failed_first(&self) -> Vec<f64> {
        if let Some(counted) = &self.counted {
            return (0..self.joints.len()).map(|joint| counted.failed_first(joint)).collect();
        }
        let count = self.ends().len() as f64;
        let ended_by = |joint| self.ends().iter().filter(|end| end.joint == joint).count() as f64;
        (0..self.joints.len()).map(|joint| ended_by(joint) / count).collect()
    }

    /// The joint that ends the mean path.
    pub fn failed_joint(&self) -> &JointLife {
        &self.joints[self.end.joint]
    }

    /// Largest relative error of the table, if there is one.
    pub fn table_error(&self) -> Option<f64> {
        let report = self.table.as_ref()?;
        let others = report.others.iter().flatten();
        Some(report.left_out.iter().chain(others).copied().fold(0.0, f64::max))
    }

    /// How long a cycle lasts at the speed of the drive [s]; nothing where revolutions last differently, or a cycle
    /// stands for different numbers of them at different joints.
    pub fn seconds_per_cycle(&self) -> Option<f64> {
        let revolutions = self.failed_joint().revolutions_per_cycle;
        let is_one = self.joints.iter().all(|joint| joint.revolutions_per_cycle == revolutions);
        self.seconds_per_revolution.filter(|_| is_one).map(|seconds| revolutions * seconds)
    }

    /// How many missions the mean path lasts, where segments have durations.
    pub fn missions(&self) -> Option<f64> {
        self.missions_of(self.end.cycles)
    }

    /// How many missions so many cycles last, where segments have durations.
    pub fn missions_of(&self, cycles: f64) -> Option<f64> {
        let revolutions = cycles * self.failed_joint().revolutions_per_cycle;
        Some(revolutions * self.seconds_per_revolution? / self.mission.as_ref()?.seconds?)
    }

    /// How far off the mean life may be: that of the random lives, or of the mean path where there are none [cycles].
    pub fn budget(&self) -> ErrorBudget {
        let (mean, monte_carlo) = match self.statistics() {
            Some(lives) => (lives.mean().value, Contribution::Random(lives.mean_half_width())),
            None if self.random_lives() == 1 => {
                (self.mean(), Contribution::Unknown("one random life tells no scatter"))
            }
            None => (self.end.cycles, Contribution::None("one life, every increment its mean")),
        };
        let table = match self.table_error() {
            // A depth that is wrong everywhere by a part makes the life wrong by that part.
            Some(error) => Contribution::Bound(error * mean),
            None => Contribution::Bound(self.step_error),
        };
        let turns = |error: Option<f64>, of: fn(f64) -> Contribution| {
            let unknown = Contribution::Unknown("one turn for each measurement, and none to settle");
            Some(error.map_or(unknown, of))
        };
        let settling = turns(self.turn_errors.settling.map(|part| part * mean), Contribution::Bound);
        let averaging = turns(self.turn_errors.averaging.map(|part| part * mean), ErrorBudget::random);
        let is_fitted = |joints: &[JointProcess]| joints.iter().any(|joint| joint.from.is_some());
        let parameters = match (self.parameter_error, &self.process) {
            (Some(error), _) => ErrorBudget::random(error),
            (None, Some(joints)) if is_fitted(joints) => Contribution::None("the fit gives no covariance"),
            (None, Some(_)) => {
                Contribution::None("alpha and beta are taken as known from the mechanism's file")
            }
            (None, None) => Contribution::None("no Gamma process: wear is what physics says"),
        };
        ErrorBudget { monte_carlo, table, settling, averaging, parameters }
    }
}
