//! The case study of the paper, figure by figure, beside the paper's own numbers: an application of the library that
//! uses nothing but what every user has. In: [`Options`]. Out: [`Study`], plain data; figures, Markdown and HTML
//! from it. Never touches files or terminals, and nothing else in linkwear knows this crate.

#![deny(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::todo,
    clippy::unimplemented,
    clippy::unreachable
)]

mod areas;
mod around;
mod configuration;
mod error;
mod figures;
mod force;
mod learn;
mod lives;
mod markup;
mod model;
mod options;
mod paper;
mod parameters;
mod plot;
mod rate;
mod report;
mod statistics;
mod table2;
mod tables;
mod workers;

pub use areas::AreaGrowth;
pub use around::{Around, CYCLES, Peak, Snapshot, WornBearing};
pub use configuration::{Configuration, JointPlace, Link};
pub use error::StudyError;
pub use figures::{Picture, pictures};
pub use force::{ForceCurve, Forces, Shape};
pub use learn::{HISTORIES, PROTOCOLS, Protocol};
pub use lives::{Lives, MODELS, Orderings, Prediction, SHOWN, UnderProtocol};
pub use options::Options;
pub use paper::{Printed, TABLE_2};
pub use parameters::ParameterRow;
pub use report::{html, markdown, summary};
pub use statistics::{Density, LifeNumbers};
pub use table2::{Row, ShownProtocol, Table2};
pub use tables::{TRUE_LIFE, TableQuality};

use linkwear_runtime::Watch;
use serde::Serialize;

use lives::DEFINITIONS;
use options::Effort;
use tables::{Survey, Tables};
use workers::Workers;

/// Turns before that of Fig. 4.
const SETTLE: u32 = 5;
/// Work of Figs 3 and 4, in turns of the compiled mechanism.
const FORCE_WORK: f64 = 60.0;
/// Growth of the clearance per wear: the paper's gamma, which it gives no value.
const GAMMAS: [f64; 2] = [0.1, 1.0];
/// Place of gamma = 1 in [`GAMMAS`], which Fig. 5 is made with.
const FULL_FEEDBACK: usize = 1;

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
    /// Table 2, ours and the paper's.
    pub table2: Table2,
    /// How ours comes about.
    pub protocol: ShownProtocol,
    /// How wear grows with the clearance, by model of the contact area.
    pub areas: Vec<AreaGrowth>,
    /// Fig. 6 and Table 2, by definition of wear.
    pub lives: Vec<Lives>,
}

/// Runs the study on so many threads, whose number changes no bit. `watch` hears the finished part
/// and may stop it.
///
/// # Errors
/// If a run fails, or if asked to stop.
pub fn run(options: Options, threads: usize, watch: Watch<'_>) -> Result<Study, StudyError> {
    let effort = Effort::of(options);
    let compiled = model::compiled()?;
    let (areas, tables) = (areas::surveys(&effort), GAMMAS.map(|gamma| Tables::surveys(gamma, &effort)));
    let surveys = [areas.as_slice(), tables.as_flattened()].concat();
    let data_sets = (GAMMAS.len() * DEFINITIONS.len()) as f64 * effort.data_sets as f64;
    let work =
        FORCE_WORK + surveys.iter().map(Survey::work).sum::<f64>() + data_sets * effort.work_of_data_set;
    let workers = Workers::new(threads, watch, work);
    let forces = force::forces(SETTLE, &workers)?;
    let measured = workers.each(&surveys, |survey| survey.measure(&workers))?;
    let (areas, tables) = measured.split_at(areas.len());
    let tables: Vec<Tables<'_>> = tables.as_chunks().0.iter().map(Tables::of).collect();
    let pairs = tables.iter().flat_map(|tables| DEFINITIONS.map(|definition| (tables, definition)));
    let lives =
        pairs.map(|(tables, definition)| lives::lives(tables, definition, (options, &effort), &workers));
    let lives = lives.collect::<Result<Vec<Lives>, StudyError>>()?;
    let (table2, protocol) = table2::table2(&lives[0], options);
    Ok(Study {
        options,
        table2,
        protocol,
        parameters: parameters::parameters(&compiled)?,
        configuration: configuration::configuration(&compiled, &workers)?,
        forces,
        tables: tables.iter().flat_map(Tables::quality).collect(),
        around: around::around(&tables[FULL_FEEDBACK])?,
        areas: areas::growths(areas),
        lives,
    })
}
