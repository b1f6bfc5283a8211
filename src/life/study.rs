//! What is asked of a life. In: a mechanism, choices. Out: a [`LifeStudy`] to run.

use std::num::NonZero;

use linkwear_runtime::RevolutionSettings;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};

use super::counted::LISTED_LIVES;
use super::fit::JointFit;
use super::mission_choice::MissionChoice;
use crate::checksum::sha256;
use crate::journal::Identity;
use crate::mechanism::Mechanism;
use crate::provenance::Provenance;
use crate::shard::Shard;

/// Where the wear of a revolution is from.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Coupling {
    /// From a table over the clearance, measured once with the dynamics.
    Table,
    /// From the dynamics, at every wear step.
    Full,
}

/// Random lives to draw.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Trajectories {
    /// 1000 with a table, where every wearing joint has a Gamma process; else none.
    #[default]
    Default,
    /// None, the mean path alone.
    MeanPath,
    /// So many.
    Count(u64),
}

impl Trajectories {
    /// The number of lives; none: the mean path alone.
    pub(super) fn count(self, coupling: Coupling) -> Option<u64> {
        /// A standard error of a thirtieth of the scatter.
        const DEFAULT: u64 = 1000;
        match self {
            Self::Default => (coupling == Coupling::Table).then_some(DEFAULT),
            Self::MeanPath => None,
            Self::Count(count) => Some(count),
        }
    }
}

/// A life to be lived, cycle by cycle, until the first joint has worn to its threshold.
///
/// ```
/// use linkwear::life::{LifeStudy, Trajectories};
/// use linkwear::mechanism::Mechanism;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// // A mechanism with wear: a shipped one, or `Mechanism::read("my.toml")?`.
/// let mechanism = Mechanism::shipped("rssr").ok_or("no such mechanism")?;
/// let study = LifeStudy { seed: 7, trajectories: Trajectories::Count(200), ..LifeStudy::new(&mechanism) };
/// let life = study.run()?;
/// println!("{} fails after {:.3} cycles on the mean path", life.failed_joint().joint, life.end.cycles);
///
/// let lives = life.statistics().ok_or("no random lives")?;
/// println!("B10: {:.3} cycles", lives.quantile(0.1)?.value);
/// // They scatter about the mean path; the error is one of 200 lives.
/// let mean = lives.mean();
/// assert!((mean.value - life.end.cycles).abs() < 5.0 * mean.error);
/// # Ok(())
/// # }
/// ```
/// `examples/life` prints the rest: scatter, quantiles, the error budget.
#[derive(Clone, Debug)]
pub struct LifeStudy<'m> {
    /// The mechanism, with at least one joint that wears.
    pub mechanism: &'m Mechanism,
    /// How a revolution is run and measured.
    pub revolutions: RevolutionSettings,
    /// Where wear is from. None: a table; the dynamics where a worn profile is fed back, which has no table.
    pub coupling: Option<Coupling>,
    /// Whether wear opens the clearance.
    pub feedback: bool,
    /// Random lives beside the mean path.
    pub trajectories: Trajectories,
    /// The part of the random lives that is lived here. None: all. A life depends on the seed and its number alone: shards that
    /// are lived apart, on any machines, are together the lives of one study; [`merge`](super::merge) puts them together.
    pub shard: Option<Shard>,
    /// Lives up to which each is kept and told; more are counted in bins, the same on any number of threads.
    pub listed: u64,
    /// Seed of the random numbers: the same seed gives the same bits on any number of threads.
    pub seed: u64,
    /// Threads that share the random lives. None: one per core.
    pub threads: Option<NonZero<usize>>,
    /// Fits that take the place of alpha and beta in the mechanism's file, at most one for each wearing joint. Their
    /// covariance enters the error budget.
    pub fits: Vec<JointFit>,
    /// How the machine is used.
    pub mission: MissionChoice,
    /// Coefficient of variation of a random wear-rate factor (Gamma law, mean 1) common to all joints of a life.
    pub shared_factor: Option<f64>,
}

impl<'m> LifeStudy<'m> {
    /// With the defaults of `linkwear life`: revolutions by adaptive Runge-Kutta, until two wear alike; feedback; a
    /// table where that is right; 1000 random lives where every joint has a Gamma process; seed 1; all cores.
    pub fn new(mechanism: &'m Mechanism) -> Self {
        Self {
            mechanism,
            revolutions: RevolutionSettings::of(&mechanism.description),
            coupling: None,
            feedback: true,
            trajectories: Trajectories::Default,
            shard: None,
            listed: LISTED_LIVES,
            seed: 1,
            threads: None,
            fits: Vec::new(),
            mission: MissionChoice::Only,
            shared_factor: None,
        }
    }

    /// Where wear is from: what was asked for; else a table, but the dynamics where a worn profile is fed back.
    pub(crate) fn coupling(&self) -> Coupling {
        let has_profile = self.feedback && self.mechanism.description.feeds_profiles_back();
        self.coupling.unwrap_or(if has_profile { Coupling::Full } else { Coupling::Table })
    }

    /// What a result is of.
    pub(super) fn provenance(&self, coupling: Coupling) -> Provenance {
        self.mechanism.provenance(Some(self.seed), self.options(coupling))
    }

    /// Options that decide the numbers, as results tell them.
    pub(crate) fn options(&self, coupling: Coupling) -> Value {
        let RevolutionSettings { integrator, settle, average } = &self.revolutions;
        let fit = |fit: &JointFit| (fit.joint.clone(), json!(sha256(&fit.estimate)));
        let fits = self.fits.iter().map(fit).collect::<Map<_, _>>();
        let mut options = json!({
            "coupling": coupling,
            "trajectories": self.trajectories.count(coupling),
            "step_s": integrator.step(),
            "tolerance": integrator.tolerance(),
            "settle": settle,
            "average": average,
            "feedback": self.feedback,
            "shared_factor": self.shared_factor,
            "fits_sha256": (!fits.is_empty()).then_some(fits),
        });
        if let Ok(Some(mission)) = self.chosen_mission() {
            options["mission"] = json!(&*mission.name);
        }
        options
    }

    /// All that decides the numbers of a life but the number of random lives, in words that a difference is told by.
    pub(crate) fn identity(&self, coupling: Coupling) -> Identity {
        let mut entries = self.mechanism.identity();
        let RevolutionSettings { integrator, settle, average } = &self.revolutions;
        let own = [
            ("the integrator", json!(format!("{integrator:?}"))),
            (
                "the number of revolutions to settle",
                settle.map_or(json!("until two wear alike"), Value::from),
            ),
            ("the number of revolutions to average", json!(average)),
            ("the coupling", json!(format!("{coupling:?}").to_lowercase())),
            ("feedback", json!(self.feedback)),
            ("the seed", json!(self.seed)),
            ("the shared factor", json!(self.shared_factor)),
        ];
        entries.extend(own.map(|(name, value)| (name.to_owned(), value)));
        if let Ok(Some(mission)) = self.chosen_mission() {
            entries.insert("the mission".to_owned(), json!(&*mission.name));
        }
        if let Some(shard) = self.shard {
            entries.insert("the shard".to_owned(), json!(shard.to_string()));
        }
        for fit in &self.fits {
            let together = self.fits.iter().position(|one| one.from == fit.from);
            let value = json!(format!("{:?}, of place {together:?}", fit.estimate));
            entries.insert(format!("the fit of {}", fit.joint), value);
        }
        entries
    }
}
