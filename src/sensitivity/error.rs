//! Why there are no derivatives, as data.

use linkwear_codegen::Diagnostics;
use linkwear_runtime::life::SettingsError;
use linkwear_runtime::{RunError, SetupError};
use thiserror::Error;

/// Why a life cannot be differentiated.
#[derive(Debug, Error)]
pub enum SensitivityError {
    /// The file is wrong.
    #[error("{0}")]
    Mechanism(Diagnostics),
    /// The file has no parameters.
    #[error("this file has no parameters, by which its life could be differentiated")]
    NoParameters,
    /// The file has no such parameter.
    #[error("there is no parameter `{parameter}`; there are: {}", .known.join(", "))]
    UnknownParameter {
        /// What was given.
        parameter: String,
        /// Those of the file.
        known: Vec<String>,
    },
    /// It is no number that could be varied.
    #[error("the parameter `{parameter}` is a formula: it varies with the parameters that it is written in")]
    Formula {
        /// The parameter.
        parameter: String,
    },
    /// On one side of its value the mechanism cannot be compiled or run.
    #[error("beside the value of `{parameter}`: {error}")]
    At {
        /// The parameter.
        parameter: String,
        /// Why.
        error: Box<Self>,
    },
    /// On one side of its value the equations are others.
    #[error("beside the value of `{parameter}` the equations have another form")]
    OtherForm {
        /// The parameter.
        parameter: String,
    },
    /// No joint wears.
    #[error("no joint of this mechanism wears")]
    NothingWears,
    /// Turns last differently.
    #[error("turns of this mechanism last differently, so that none is as the one before")]
    UnevenTurns,
    /// Drives or forces are alike only after several turns.
    #[error(
        "drives or forces of this mechanism repeat after {turns} turns, and derivatives are those of one"
    )]
    SeveralTurns {
        /// After how many.
        turns: u32,
    },
    /// A joint keeps its wear by bearing angle.
    #[error("the wear of joint `{joint}` by bearing angle is not differentiated")]
    Profile {
        /// The joint.
        joint: String,
    },
    /// The mechanism has missions.
    #[error("lives with missions are not differentiated")]
    Mission,
    /// A controller acts at sampled times.
    #[error("controllers that act at sampled times are not differentiated")]
    Samples,
    /// The motion or its derivative does not settle.
    #[error(
        "the motion does not settle at a wear of {wear:.3e} m: after {turns} turns derivatives still change by {change:.1e} of \
         themselves"
    )]
    NotSettled {
        /// Wear of the joint that leads [m].
        wear: f64,
        /// Turns that were run.
        turns: u32,
        /// Change of the last one.
        change: f64,
    },
    /// Where bodies come apart, turns differ from each other; where a body swings freely, for as long as that takes to die away.
    #[error(
        "the motion has no period, or swings for long before it has, at a wear of {wear:.3e} m: its turns differ by {change:.1e} of \
         what they wear"
    )]
    NoPeriod {
        /// Wear of the joint that leads [m].
        wear: f64,
        /// By how much of its wear a turn differs from those after it.
        change: f64,
    },
    /// By one parameter there are no lives to compare.
    #[error(
        "lives of the dynamics have to tell how this one varies, and there are none on both sides of `{parameter}`"
    )]
    NoLives {
        /// The parameter.
        parameter: String,
    },
    /// No step is short enough.
    #[error("with {steps} steps a turn is still not followed")]
    TooLong {
        /// The most that was tried.
        steps: u64,
    },
    /// The life is not one along a table.
    #[error("the mean path of this life is not smooth along its table")]
    NoPath,
    /// Random lives are asked for, and a wearing joint has no Gamma process.
    #[error("joint `{joint}` has no Gamma process to draw from")]
    NoProcess {
        /// Its name.
        joint: String,
    },
    /// Increments of a cycle have so small a shape that the mean of lives hangs on rare ones.
    #[error(
        "an increment of a cycle at joint `{joint}` has a shape of {shape:.2}: below 2 few lives tell how the mean of random lives varies"
    )]
    SmallShape {
        /// The joint.
        joint: String,
        /// alpha times what an unworn joint wears in a cycle.
        shape: f64,
    },
    /// A random life does not end.
    #[error("life {life} has not ended after {cycles} cycles")]
    Endless {
        /// Its number.
        life: u64,
        /// Cycles that were lived.
        cycles: u64,
    },
    /// A setting is out of range.
    #[error("{name} is {value}; it has to be {need}")]
    Setting {
        /// What it is.
        name: &'static str,
        /// What it was.
        value: f64,
        /// What it has to be.
        need: &'static str,
    },
    /// Numbers of the mechanism make no sense.
    #[error(transparent)]
    Setup(#[from] SetupError),
    /// Numbers of a wearing joint make no sense.
    #[error(transparent)]
    Settings(#[from] SettingsError),
    /// It cannot be run.
    #[error(transparent)]
    Run(#[from] RunError),
    /// The fine scale failed.
    #[error("{0}")]
    Wear(String),
    /// Stopped on request.
    #[error("stopped on request")]
    Interrupted,
}
