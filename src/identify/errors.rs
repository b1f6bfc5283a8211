//! Why nothing was identified.

use thiserror::Error;

use crate::study::PointError;

/// Why a model has no prediction at some values.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ModelFault {
    /// Somebody stops the work.
    Interrupted,
    /// It cannot be run there.
    Failed(PointError),
}

/// What is asked cannot be answered.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum IdentifyError {
    /// No parameter is sought.
    #[error("no parameter is free")]
    NothingFree,
    /// A parameter is sought twice.
    #[error("`{0}` is free twice")]
    Twice(String),
    /// There are not more readings than parameters.
    #[error("{readings} readings cannot tell {parameters} parameters and their errors")]
    TooFew {
        /// Readings.
        readings: usize,
        /// Parameters that are sought.
        parameters: usize,
    },
    /// A reading or a noise level is no finite number, or a noise level not positive.
    #[error("{group}: {what}")]
    Number {
        /// Where.
        group: String,
        /// What is wrong.
        what: String,
    },
    /// Readings that are all the same, of unknown noise.
    #[error("{group}: all {count} readings are {value}: nothing varies, and nothing tells their noise")]
    Constant {
        /// Which.
        group: String,
        /// How many.
        count: usize,
        /// What they all are.
        value: f64,
    },
    /// The model says the same whatever the value of a parameter.
    #[error("{0} changes nothing of what was measured")]
    NoInfluence(String),
    /// The model runs at none of the starts.
    #[error("the model runs at none of {starts} starts within the bounds; at the first: {} [{}]", .first.message, .first.code)]
    NothingRuns {
        /// How many were tried.
        starts: usize,
        /// Why not at the first.
        first: PointError,
    },
    /// Stopped on request.
    #[error("stopped on request after {0} runs of the model")]
    Interrupted(u64),
}
