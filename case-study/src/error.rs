//! Why a study could not be finished, as data. Out: [`StudyError`].

use std::convert::Infallible;

use linkwear::mechanism::LoadError;
use linkwear_gamma::fit::FitError;
use linkwear_runtime::life::{CalibrationError, LifeError, SettingsError};
use linkwear_runtime::{NoColumn, RunError, SetupError};
use thiserror::Error;

/// Why a study could not be finished.
#[derive(Debug, Error)]
pub enum StudyError {
    /// A mechanism of the study is not accepted by the generator.
    #[error(transparent)]
    Mechanism(#[from] LoadError),
    /// The mechanism has no element of this name.
    #[error("the mechanism of the study has no {kind} `{name}`")]
    Missing {
        /// What it would be.
        kind: &'static str,
        /// Its name.
        name: String,
    },
    /// A run lacks a column.
    #[error(transparent)]
    Column(#[from] NoColumn),
    /// A run failed.
    #[error(transparent)]
    Run(#[from] RunError),
    /// A mechanism could not be set up.
    #[error(transparent)]
    Setup(#[from] SetupError),
    /// A life could not be lived.
    #[error(transparent)]
    Life(#[from] LifeError<RunError>),
    /// A life has settings that make no sense.
    #[error(transparent)]
    Settings(#[from] SettingsError),
    /// A life by a table could not be lived.
    #[error(transparent)]
    TableLife(#[from] LifeError<Infallible>),
    /// No length of cycle gives the life of the paper.
    #[error(transparent)]
    Calibration(#[from] CalibrationError<Infallible>),
    /// A model could not be fitted to histories.
    #[error(transparent)]
    Fit(#[from] FitError),
    /// A curve of reference data cannot be read.
    #[error("line {line} of the reference data is no row of numbers")]
    Reference {
        /// Its number, from 1.
        line: usize,
    },
    /// A picture could not be drawn.
    #[error(transparent)]
    Plot(#[from] crate::plot::PlotError),
    /// Stopped on request.
    #[error("stopped on request")]
    Interrupted,
}
