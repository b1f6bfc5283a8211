//! The case study of the paper, figure by figure, beside the paper's own numbers: an application of the library that
//! uses nothing but what every user has. In: [`Options`]. Out: [`Study`], plain data; a [`Report`] with figures
//! from it. Never touches files or terminals, and nothing else in linkwear knows this module.

mod around;
mod configuration;
mod error;
mod figures;
mod force;
mod lives;
mod model;
mod options;
mod parameters;
mod rate;
mod report;
mod tables;
mod watch;

pub use around::{Around, CYCLES, Peak, Snapshot, TRUE_LIFE, WornBearing};
pub use configuration::{Configuration, JointPlace, Link};
pub use error::StudyError;
pub use figures::{Picture, pictures};
pub use force::{ForceCurve, Forces, Shape};
pub use lives::{
    Density, HISTORIES, LifeNumbers, Lives, MODELS, Orderings, PROTOCOLS, Prediction, Protocol, UnderProtocol,
};
pub use options::Options;
pub use parameters::ParameterRow;
pub use report::{html, markdown, summary};
pub use tables::TableQuality;

use serde::Serialize;

use options::Effort;
use tables::Tables;
use watch::Watch;

/// Turns before that of Fig. 4.
const SETTLE: u32 = 5;
/// Work of Figs 3 and 4, in turns of the compiled mechanism.
const FORCE_WORK: f64 = 60.0;
/// Growth of the clearance per wear: the paper's gamma, which it gives no value.
const GAMMAS: [f64; 2] = [0.1, 1.0];
/// Tables for Fig. 5 reach this part beyond the threshold: its last cycle lies there.
const REACH: f64 = 1.4;

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
    /// How good the tables of wear per revolution are.
    pub tables: Vec<TableQuality>,
    /// Fig. 5.
    pub around: Around,
    /// Fig. 6 and Table 2, by definition of wear.
    pub lives: Vec<Lives>,
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
    let random = 4.0 * effort.data_sets as f64 * effort.work_of_data_set;
    let total = FORCE_WORK + 2.0 * effort.work_of_tables() + random;
    let watch = Watch::new(progress, stop, total);
    let compiled = model::compiled()?;
    let forces = force::forces(threads, SETTLE, &watch)?;
    let (mut tables, mut lives, mut around) = (Vec::new(), Vec::new(), None);
    for gamma in GAMMAS {
        let measured = Tables::measure(threads, (gamma, REACH), &effort, &watch)?;
        tables.extend(measured.quality(gamma, &effort));
        for definition in lives::definitions(gamma) {
            lives.push(lives::lives(&measured, definition, (threads, options.seed), &effort, &watch)?);
        }
        if gamma == 1.0 {
            around = Some(around::around(&measured, &effort)?);
        }
    }
    Ok(Study {
        options,
        parameters: parameters::parameters(&compiled)?,
        configuration: configuration::configuration(&compiled, &watch)?,
        forces,
        tables,
        around: around.ok_or(StudyError::Missing { kind: "gamma", name: "1".into() })?,
        lives,
    })
}
