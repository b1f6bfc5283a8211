//! `life`: the coupled wear of a mechanism, cycle by cycle, to the failure threshold; one mean path, or many random
//! ones by its Gamma process.

mod fits;
pub mod folder;
mod hours;
mod mission;
pub mod output;
mod told;

use std::path::Path;

use crate::files::claim_folder;
use crate::life::{
    Cause, LifeError, LifeFacts, LifeJournal, LifePart, LifeStudy, MissionChoice, Pace, Trajectories, merge,
};
use crate::mechanism::Mechanism;
#[cfg(feature = "page")]
use crate::page::life_picture;
use crate::progress::watched;
use crate::provenance::Provenance;
use crate::remark::remark;
use linkwear_runtime::{Integrator, RevolutionSettings};

use self::fits::fits;
use super::answer::Answer;
use super::arguments::{LifeArguments, MergeArguments};
use super::failure::Failure;
use super::input::load_mechanism;
use super::options::LivesArguments;
#[cfg(feature = "page")]
use super::picture;
use super::shard_command::shard_command;

pub fn run(arguments: &LifeArguments) -> Result<Answer, Failure> {
    #[cfg(feature = "page")]
    picture::check_plot(&[&arguments.input.file], arguments.plot.as_deref(), arguments.replace)?;
    let mechanism = load_mechanism(&arguments.input, arguments.equations)?;
    let folder = arguments.out.as_deref();
    let open = if arguments.resume { LifeJournal::resume } else { LifeJournal::create };
    let journal = folder.map(open).transpose().map_err(Failure::journal)?;
    let (study, warnings) = study(arguments, &mechanism)?;
    let kept = folder.map(|folder| Kept::new(folder, &study));
    let cost = watched("first turn", |watch| study.cost(watch))
        .map_err(|error| failed(&arguments.input.file, error, kept.as_ref()))?;
    if let Some(cost) = cost {
        remark(&output::cost(&cost));
    }
    let lived = watched("table", |watch| match &journal {
        Some(journal) => study.run_kept(journal, watch),
        None => study.run_watched(watch),
    });
    let mut life = lived.map_err(|error| failed(&arguments.input.file, error, kept.as_ref()))?;
    life.warnings.extend(warnings);
    if let Some(note) = life.thread_note.take() {
        remark(&format_args!("warning: {note}"));
    }
    if let (Some(folder), Some(journal), None) = (folder, &journal, study.shard) {
        let (kept, told) = (journal.random_lives(), life.random_lives());
        if told < kept {
            remark(&format_args!(
                "warning: `{}` keeps {kept} random lives, of which {told} are asked for: its results are of these alone now; \
                 --resume with --trajectories {kept} tells all",
                folder.display()
            ));
        }
    }
    let facts = LifeFacts::new(&study, life.coupling);
    let answer = output::answer(&facts, &life);
    #[cfg(feature = "page")]
    picture::write_plot(arguments.plot.as_deref(), || life_picture(&answer.json))?;
    match (folder, study.shard) {
        (Some(folder), Some(shard)) => {
            let part = LifePart::new(&study, shard_command(std::env::args_os()), life);
            part.map_or(Ok(()), |part| folder::write_shard(folder, &part, &study))?;
            Ok(output::of_shard(answer, shard))
        }
        (Some(folder), None) => {
            folder::write(folder, &facts, &life, &answer.json).map(|()| answer).map_err(Failure::from)
        }
        (None, _) => Ok(answer),
    }
}

/// What is asked for, and what is doubtful about its fits.
pub fn study<'m>(
    arguments: &LifeArguments,
    mechanism: &'m Mechanism,
) -> Result<(LifeStudy<'m>, Vec<String>), Failure> {
    let (study, warnings) =
        lives(&arguments.lives, (arguments.revolutions.step, arguments.revolutions.tol), mechanism)?;
    Ok((LifeStudy { threads: arguments.threads, shard: arguments.shard, ..study }, warnings))
}

/// The same, whoever asks; with a step or a tolerance.
pub fn lives<'m>(
    arguments: &LivesArguments,
    (step, tolerance): (Option<f64>, Option<f64>),
    mechanism: &'m Mechanism,
) -> Result<(LifeStudy<'m>, Vec<String>), Failure> {
    let (fits, warnings) = fits(&arguments.fit, &mechanism.description)?;
    let default = LifeStudy::new(mechanism);
    let study = LifeStudy {
        revolutions: RevolutionSettings {
            integrator: match (step, tolerance) {
                (Some(step), _) => Integrator::Rk4 { step },
                (None, Some(tolerance)) => Integrator::Rk43 { tolerance, max_step: None },
                (None, None) => default.revolutions.integrator,
            },
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
        fits,
        mission: match (&arguments.mission, arguments.no_mission) {
            (_, true) => MissionChoice::None,
            (Some(name), false) => MissionChoice::Named(name.clone()),
            (None, false) => MissionChoice::Only,
        },
        shared_factor: arguments.shared_factor,
        ..default
    };
    Ok((study, warnings))
}

/// Whether there is the mission that is named, also where no life is lived.
pub fn check_mission(file: &Path, study: &LifeStudy<'_>) -> Result<(), Failure> {
    let is_named = matches!(study.mission, MissionChoice::Named(_));
    let chosen = if is_named { study.chosen_mission().map(drop) } else { Ok(()) };
    chosen.map_err(|cause| failed(file, cause.into(), None))
}

/// The lives of all shards as one.
pub fn merged(arguments: &MergeArguments) -> Result<Answer, Failure> {
    let (facts, life) = merge(&arguments.shards).map_err(Failure::merge)?;
    claim_folder(&arguments.out)?;
    let answer = output::answer(&facts, &life);
    folder::write(&arguments.out, &facts, &life, &answer.json)?;
    Ok(answer)
}

/// Where what was finished before an error is kept, and what it is of.
pub struct Kept<'a> {
    folder: &'a Path,
    provenance: Provenance,
}

impl<'a> Kept<'a> {
    pub fn new(folder: &'a Path, study: &LifeStudy<'_>) -> Self {
        Self { folder, provenance: LifeFacts::new(study, study.coupling()).provenance }
    }
}

/// What counts cycles of a machine in which nothing turns.
const CLOCK: &str = "where nothing turns, a body of its own on a revolute joint, written first in [joints] and driven round once a \
                     period, counts periods as revolutions";

/// What to do about an error; the cycles and lives completed before go into the folder, else the cycles on stdout with
/// the error.
pub fn failed(file: &Path, error: LifeError, kept: Option<&Kept<'_>>) -> Failure {
    let LifeError { cause, joints, cycles, lives } = error;
    let cause = *cause;
    if let Cause::Journal(error) = cause {
        return Failure::journal(error);
    }
    let mut help = match &cause {
        Cause::NoRandomLives => {
            let message = "--shared-factor spreads random lives, and none are asked for";
            let help = "add --trajectories 16; with full coupling every life costs a run of the dynamics";
            return Failure::usage(message, help);
        }
        Cause::NothingToShare => {
            let help = "add --trajectories 1000; with full coupling every life costs a run of the dynamics";
            return Failure::usage("--shard parts random lives, and none are asked for", help);
        }
        Cause::SharedFactor(_) => return Failure::usage(&cause, "give a smaller --shared-factor"),
        Cause::UnknownMission { mission, known } if !known.is_empty() => {
            return Failure::unknown_name("mission", mission, known, known);
        }
        Cause::UnknownMission { .. } => {
            return Failure::usage(&cause, "this mechanism has none: leave --mission out, or add a table [missions]");
        }
        Cause::SeveralMissions { known } => {
            let help = format!("choose one, as by --mission {}, or live without by --no-mission", known[0]);
            return Failure::usage(&cause, help);
        }
        Cause::UnevenTurns { .. } => {
            "drive it at one speed in each segment, as in drive = \"2*pi*speed*t\"; --no-mission lives without missions".to_owned()
        }
        Cause::Rests { .. } => {
            "leave the segment out: a rest wears nothing, and shares and durations are of the operating time".to_owned()
        }
        Cause::MissionOutlastsLife { .. } => {
            "give shares of the operating time if it is used so for good, or break the mission into shorter ones".to_owned()
        }
        Cause::TwoFits { .. } => return Failure::usage(&cause, "give one --fit for each joint"),
        Cause::Run(linkwear_runtime::RunError::NeverAlike { .. }) => {
            "--settle 500 measures after so many turns, --average 80 takes the mean of so many; what a machine does by turns belongs \
             into [missions]"
                .to_owned()
        }
        Cause::NoWear => "add [clearance.R1] and [wear.R1], R1 being the joint that wears".to_owned(),
        Cause::NoTurns => format!("drive one, as in R1 = {{ revolute = .., drive = \"2*pi*speed*t\" }}; {CLOCK}"),
        Cause::NoWholeTurn { .. } => format!("change the law of its drive; {CLOCK}"),
        Cause::NoProcess { joint } => format!(
            "add alpha = \"13.65 1/um\" to [wear.{joint}], give --fit {joint}=FIT.json, or leave --trajectories, \
             --fit and --shared-factor out"
        ),
        _ if cycles.is_empty() => String::new(),
        _ => match kept
            .map(|Kept { folder, provenance }| {
                folder::write_parts(folder, &joints, (&cycles, &lives), provenance)
            })
            .transpose()
        {
            Err(error) => return error.into(),
            Ok(Some(path)) => {
                format!("{} cycles were completed before; they are in `{}`", cycles.len(), path.display())
            }
            Ok(None) => format!("{} cycles were completed before", cycles.len()),
        },
    };
    if let Cause::CycleLimit { pace, cycles, .. } = &cause {
        // Random lives may be much longer than the mean path.
        let cure = pace.as_ref().map_or_else(
            || format!("write {} times the `revolutions_per_cycle` into every table [wear]", cycles / 50),
            Pace::cure,
        );
        help = if help.is_empty() { cure } else { format!("{cure}; {help}") };
    }
    let failure = if matches!(cause, Cause::Interrupted { .. }) {
        help.push_str(if help.is_empty() { "" } else { "; " });
        help.push_str(match kept {
            Some(_) => "the same command with --resume goes on from there",
            None => "`linkwear life --out DIR` could go on by --resume",
        });
        Failure::stopped(file, &cause, help)
    } else {
        Failure::life(file, &cause, help)
    };
    if kept.is_some() || cycles.is_empty() {
        failure
    } else {
        failure.with_cycles(output::cycles(&joints, &cycles))
    }
}
