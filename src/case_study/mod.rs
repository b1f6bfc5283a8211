//! The case study of the paper, figure by figure, beside the paper's own numbers: an application of the library that
//! uses nothing but what every user has. In: [`Options`]. Out: [`Study`], plain data; a [`Report`] with figures
//! from it. Never touches files or terminals, and nothing else in linkwear knows this module.

mod around;
mod configuration;
mod error;
mod figures;
mod force;
mod model;
mod options;
mod parameters;
mod report;
mod watch;

pub use around::{Around, CYCLES, Peak, Snapshot, TRUE_LIFE, WornBearing};
pub use configuration::{Configuration, JointPlace, Link};
pub use error::StudyError;
pub use figures::{Picture, pictures};
pub use force::{ForceCurve, Forces, Shape};
pub use options::Options;
pub use parameters::ParameterRow;
pub use report::{html, markdown, summary};

use serde::Serialize;

use options::Effort;
use watch::Watch;

/// All results, without timings: the same options give the same bits.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Study {
    /// What was asked for.
    pub options: Options,
    /// Table 1.
    pub parameters: Vec<ParameterRow>,
    /// Fig. 3.
    pub configuration: Configuration,
    /// Fig. 4.
    pub forces: Forces,
    /// Fig. 5.
    pub around: Around,
}

/// Runs the study on so many threads, whose number changes no bit. `progress` gets the finished part, 0 to 1; `stop`
/// is asked all the time.
///
/// # Errors
/// If a run fails, or if asked to stop.
pub fn run(
    options: Options,
    threads: usize,
    progress: &(dyn Fn(f64) + Sync),
    stop: &(dyn Fn() -> bool + Sync),
) -> Result<Study, StudyError> {
    let effort = Effort::of(options);
    let watch = Watch::new(progress, stop, 40.0 + effort.turns_around);
    let compiled = model::compiled()?;
    Ok(Study {
        options,
        parameters: parameters::parameters(&compiled)?,
        configuration: configuration::configuration(&compiled, &watch)?,
        forces: force::forces(threads, 5, &watch)?,
        around: around::around(threads, &effort, &watch)?,
    })
}
