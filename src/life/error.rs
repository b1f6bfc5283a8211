//! Why there is no life, as data.

use std::error::Error as StdError;

use linkwear_gamma::life::LifeError as LawError;
use linkwear_runtime::RunError;
use linkwear_runtime::life::{CycleRecord, FailureEvent, MissionError, SettingsError};
use thiserror::Error;

use super::pace::Pace;
use crate::journal::JournalError;

/// A life that was not lived to its end, with the cycles of the mean path and the random lives that were completed.
#[derive(Debug, Error)]
#[error("{cause}")]
pub struct LifeError {
    /// Why.
    #[source]
    pub cause: Box<Cause>,
    /// Names of the wearing joints, in the order of the cycles' entries.
    pub joints: Vec<String>,
    /// Completed cycles.
    pub cycles: Vec<CycleRecord>,
    /// Random lives that were finished, by their numbers.
    pub lives: Vec<(u64, FailureEvent)>,
}

/// Why a life was not lived to its end.
#[derive(Debug, Error)]
pub enum Cause {
    /// The mechanism has no joint with wear.
    #[error("no joint of this mechanism wears")]
    NoWear,
    /// No revolute joint is driven.
    #[error("no revolute joint is driven, so revolutions cannot be counted")]
    NoTurns,
    /// One is driven, but never gets round.
    #[error(
        "the first driven revolute joint stops after {reached:.4} of a turn, so revolutions cannot be counted"
    )]
    NoWholeTurn {
        /// How far it gets of one turn.
        reached: f64,
    },
    /// Random lives are asked for, and a wearing joint has neither alpha and beta nor a fit.
    #[error("joint `{joint}` has no Gamma process to draw from")]
    NoProcess {
        /// Its name.
        joint: String,
    },
    /// A fit is given for something else.
    #[error("`{joint}` is no joint that wears; there are: {}", .known.join(", "))]
    UnknownJoint {
        /// What was given.
        joint: String,
        /// The wearing joints.
        known: Vec<String>,
    },
    /// Two fits are given for one joint.
    #[error("joint `{joint}` has two fits")]
    TwoFits {
        /// The joint.
        joint: String,
    },
    /// A shared factor is given, but only the mean path is lived.
    #[error("a shared factor spreads random lives, and none are asked for")]
    NoRandomLives,
    /// A shard is asked for, but only the mean path is lived.
    #[error("a shard is a part of the random lives, and none are asked for")]
    NothingToShare,
    /// The shared factor scatters too much for a mean life to exist.
    #[error(transparent)]
    SharedFactor(LawError),
    /// A number of a wearing joint is out of range.
    #[error(transparent)]
    Settings(#[from] SettingsError),
    /// Its journal cannot be used.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// The mechanism has no mission of this name.
    #[error("there is no mission `{mission}`")]
    UnknownMission {
        /// What was given.
        mission: String,
        /// Those of the mechanism.
        known: Vec<String>,
    },
    /// The mechanism has several missions, and none was chosen.
    #[error("there are {} missions: {}", .known.len(), .known.join(", "))]
    SeveralMissions {
        /// Their names.
        known: Vec<String>,
    },
    /// The revolutions of a segment last differently, so that time cannot be counted in them.
    #[error("the revolutions of segment `{segment}` last differently, so its time cannot be counted in them")]
    UnevenTurns {
        /// The segment.
        segment: String,
    },
    /// A segment has no revolutions.
    #[error(
        "the mechanism rests in segment `{segment}`: its driver does not get round there, so it has no revolutions to wear by"
    )]
    Rests {
        /// The segment.
        segment: String,
    },
    /// A segment cannot be run.
    #[error(transparent)]
    Segment(Box<MissionError<RunError>>),
    /// The machine fails within its first mission, so that the order of segments decides when.
    #[error(
        "the machine fails after {missions:.3} of one mission: which segments come before that decides its life, not their shares"
    )]
    MissionOutlastsLife {
        /// Missions of the mean path's life.
        missions: f64,
    },
    /// The mechanism cannot be run.
    #[error(transparent)]
    Run(RunError),
    /// No joint fails within the limit on cycles.
    #[error("{}no joint has failed after {cycles} cycles{}", of_life(*.trajectory), at_pace(.pace.as_ref()))]
    CycleLimit {
        /// The random life; none: the mean path.
        trajectory: Option<u64>,
        /// Cycles that were lived.
        cycles: u64,
        /// The life at the pace of these cycles; none for a random one.
        pace: Option<Pace>,
    },
    /// The table, the mean path or a random life cannot go on.
    #[error("{}{error}", of_life(*.trajectory))]
    Wear {
        /// The random life; none: the table or the mean path.
        trajectory: Option<u64>,
        /// Why.
        error: Box<dyn StdError + Send + Sync>,
    },
    /// The thread of a random life panicked.
    #[error("{}its thread panicked: {message}", of_life(Some(*.trajectory)))]
    Panicked {
        /// The random life.
        trajectory: u64,
        /// What the panic said.
        message: String,
    },
    /// Stopped on request.
    #[error("stopped on request{}", within(*.trajectory, *.lives))]
    Interrupted {
        /// The random life that was being lived, where one was.
        trajectory: Option<u64>,
        /// Random lives completed, and asked for; none: they had not begun.
        lives: Option<(usize, u64)>,
    },
}

fn of_life(trajectory: Option<u64>) -> String {
    trajectory.map_or_else(String::new, |number| format!("life {number}: "))
}

fn at_pace(pace: Option<&Pace>) -> String {
    pace.map_or_else(String::new, |pace| {
        format!("; as they wear, joint `{}` fails after {:.3e}", pace.joint, pace.cycles)
    })
}

fn within(trajectory: Option<u64>, lives: Option<(usize, u64)>) -> String {
    let Some((done, count)) = lives else { return String::new() };
    let place = trajectory.map_or_else(String::new, |number| format!(" in life {number},"));
    format!("{place} after {done} of {count} lives")
}

impl From<Cause> for LifeError {
    /// Before the first cycle.
    fn from(cause: Cause) -> Self {
        Self { cause: Box::new(cause), joints: Vec::new(), cycles: Vec::new(), lives: Vec::new() }
    }
}

impl From<MissionError<RunError>> for LifeError {
    fn from(error: MissionError<RunError>) -> Self {
        Cause::from(error).into()
    }
}

impl From<MissionError<RunError>> for Cause {
    fn from(error: MissionError<RunError>) -> Self {
        match error {
            MissionError::Alone(error) => error.into(),
            MissionError::Segment { segment, error } => match Self::from(error) {
                Self::Run(error) => Self::Segment(Box::new(MissionError::Segment { segment, error })),
                cause => cause,
            },
            lost @ MissionError::ContactLost { .. } => Self::Segment(Box::new(lost)),
        }
    }
}

impl From<RunError> for Cause {
    fn from(error: RunError) -> Self {
        match error {
            RunError::NoTurns => Self::NoTurns,
            RunError::TurnsNotReached { reached, .. } if reached < 1.0 => Self::NoWholeTurn { reached },
            RunError::Interrupted { .. } => Self::Interrupted { trajectory: None, lives: None },
            error => Self::Run(error),
        }
    }
}
