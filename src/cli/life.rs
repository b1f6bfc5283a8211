//! `life`: the coupled wear of a mechanism, cycle by cycle, to the failure threshold; one mean path, or many random
//! ones by its Gamma process.

mod fits;
mod folder;
mod output;

use linkwear::life::{Cause, LifeError, LifeStudy, Trajectories};
use linkwear::progress::watched;
use linkwear_runtime::{Integrator, RevolutionSettings};
use serde_json::Value;

use self::fits::Fits;
use self::folder::Folder;
use self::output::{Answer, cycle_entry, cycles_table};
use super::arguments::{Format, LifeArguments};
use super::failure::Failure;
use super::file::print;
use super::input::load_mechanism;

/// Answers `life`.
pub fn run(arguments: &LifeArguments, format: Format) -> Result<(), Failure> {
    let mechanism = load_mechanism(&arguments.input, arguments.rigid, arguments.backend)?;
    let folder = arguments.out.as_deref().map(Folder::claim).transpose()?;
    let Fits { fits, warnings } = Fits::read(arguments, &mechanism.description)?;
    let study = LifeStudy {
        revolutions: RevolutionSettings {
            integrator: Integrator::Rk4 { step: arguments.step },
            settle: arguments.settle,
            average: arguments.average,
        },
        coupling: arguments.coupling,
        feedback: !arguments.no_feedback,
        trajectories: match (arguments.mean, arguments.trajectories) {
            (true, _) => Trajectories::MeanPath,
            (false, Some(count)) => Trajectories::Count(count),
            (false, None) => Trajectories::Default,
        },
        seed: arguments.seed,
        threads: arguments.threads,
        fits,
        shared_factor: arguments.shared_factor,
        ..LifeStudy::new(&mechanism)
    };
    let lived = watched(|watch| study.run_watched(watch));
    let mut life = lived.map_err(|error| failed(arguments, error, folder.as_ref(), format))?;
    life.warnings.extend(warnings);
    let answer = Answer { mechanism: &mechanism, study: &study, life: &life };
    if let Some(folder) = &folder {
        folder.write(&answer)?;
    }
    match format {
        Format::Json => print(&answer.to_json()),
        Format::Text => print(&answer.to_text()),
    }
}

/// What to do about an error; the cycles completed before go into the folder, else on stdout with the error.
fn failed(
    arguments: &LifeArguments,
    LifeError { cause, joints, cycles }: LifeError,
    folder: Option<&Folder>,
    format: Format,
) -> Failure {
    let file = arguments.input.file.clone();
    let message = cause.to_string();
    let help = match &cause {
        Cause::NoRandomLives => {
            let message = "--shared-factor spreads random lives, and none are asked for".to_owned();
            let help = "add --trajectories 16; with full coupling every life costs a run of the dynamics";
            return Failure::Usage { message, help: help.to_owned() };
        }
        Cause::SharedFactor(_) => {
            return Failure::Usage { message, help: "give a smaller --shared-factor".to_owned() };
        }
        Cause::NoWear => "add [clearance.R1] and [wear.R1], R1 being the joint that wears".to_owned(),
        Cause::NoTurns => "drive one, as in R1 = { revolute = .., drive = \"2*pi*speed*t\" }".to_owned(),
        Cause::NoProcess { joint } => format!(
            "add alpha = \"13.65 1/um\" to [wear.{joint}], give --fit {joint}=FIT.json, or leave --trajectories, \
             --fit and --shared-factor out"
        ),
        _ if cycles.is_empty() => String::new(),
        _ => match folder.map(|folder| folder.write_cycles(&joints, &cycles)) {
            Some(Err(failure)) => return failure,
            Some(Ok(path)) => {
                format!("{} cycles were completed before; they are in `{}`", cycles.len(), path.display())
            }
            None => format!("{} cycles were completed before", cycles.len()),
        },
    };
    let mut kept: Vec<Value> = Vec::new();
    if folder.is_none() && !cycles.is_empty() {
        kept = cycles.iter().map(|cycle| cycle_entry(&joints, cycle)).collect();
        if format == Format::Text {
            // A reader who has gone away cannot be told.
            let _ = print(&cycles_table(&joints, &cycles));
        }
    }
    Failure::Life { file, message, help, cycles: kept }
}
