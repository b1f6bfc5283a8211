//! A life that was lived before, from the folder of `life --out`. In: a folder. Out: what is told of it, and the mechanism with the
//! options it was lived with. Never lives anything.

use linkwear_codegen::{SourceFile, limits};
use serde_json::Value;

use super::super::arguments::ReportArguments;
use super::super::failure::Failure;
use super::super::life::folder::{LIFE, SOURCES};
use super::super::options::{CLOSURES, Input, LivesArguments};
use crate::life::{JOURNAL, SHARD};
use crate::mechanism::MECHANISM;
use crate::provenance::FORMAT;
use linkwear_codegen::input::read_text;

/// A life and what it is of.
pub struct Lived {
    /// As `life --format json` has it.
    pub json: Value,
    /// The mechanism's file in the folder, with the changes to it.
    pub input: Input,
    pub source: SourceFile,
    /// Flexible bodies were taken as rigid.
    pub rigid: bool,
}

impl Lived {
    /// Reads a folder.
    ///
    /// # Errors
    /// A folder of another kind, of a life that is not finished, or that was changed; options of a life beside it.
    pub fn read(arguments: &ReportArguments) -> Result<Self, Failure> {
        let folder = &arguments.input.file;
        let wrong = |message: String, help: &str| Failure::data(folder, None, message, help);
        if let Some(option) = option_of_a_life(arguments) {
            let message = format!(
                "the life in `{}` is lived already: {option} changes nothing in it",
                folder.display()
            );
            return Err(Failure::usage(
                message,
                "leave it out, or give the mechanism's file to live another life",
            ));
        }
        let (file, place) = (folder.join(LIFE), folder.display());
        if !file.is_file() {
            let has = |name: &str| folder.join(name).is_file();
            return Err(if has(SHARD) {
                wrong(
                    format!("`{place}` holds a shard, a part of a life"),
                    "`linkwear merge` puts all shards together; report their folder",
                )
            } else if has(JOURNAL) {
                wrong(
                    format!("the life in `{place}` is not finished"),
                    "the command that began it goes on with it by --resume",
                )
            } else {
                wrong(
                    format!("`{place}` is no folder of a life: there is no {LIFE} in it"),
                    "give a mechanism's file, or the folder of `linkwear life FILE --out DIR`",
                )
            });
        }
        let text = read_text(&file, limits::DATA_BYTES).map_err(Failure::read(&file))?;
        let read: Option<Value> = serde_json::from_str(&text).ok();
        let foreign = || {
            wrong(
                format!("`{}` is not what `linkwear life --out` writes", file.display()),
                "live the life again in another folder",
            )
        };
        let json =
            read.filter(|json| json["format"] == FORMAT && json["cycles"].is_array()).ok_or_else(foreign)?;
        let hash = json["provenance"]["file_sha256"].as_str().ok_or_else(foreign)?;
        let options = &json["provenance"]["options"];
        let path = folder.join(SOURCES).join(MECHANISM);
        if !path.is_file() {
            let message = format!(
                "the mechanism of the life in `{place}` is not kept there: there is no {SOURCES}/{MECHANISM}"
            );
            return Err(wrong(
                message,
                "the command that lived it adds it by --resume, without living again",
            ));
        }
        let text = read_text(&path, limits::FILE_BYTES).map_err(Failure::read(&path))?;
        let source = SourceFile { name: path.display().to_string(), text };
        if source.sha256() != hash {
            let message = format!("`{}` was changed: it is not the mechanism of this life", path.display());
            return Err(wrong(
                message,
                "put the file back as it was, or live the changed one in another folder",
            ));
        }
        let set = options["set"].as_object().into_iter().flatten();
        let set = set.map(|(name, value)| Some((name.clone(), value.as_str()?.to_owned())));
        let closure = options["closure"].as_str();
        let input = Input {
            overrides: set.collect::<Option<_>>().ok_or_else(foreign)?,
            closure: closure
                .and_then(|asked| CLOSURES.iter().find(|(name, _)| *name == asked))
                .map(|(_, closure)| *closure),
            file: path,
            allow_outside_data: false,
        };
        Ok(Self { rigid: options["rigid"] == true, json, input, source })
    }
}

/// The first option that is given and would be one of a life.
fn option_of_a_life(arguments: &ReportArguments) -> Option<&'static str> {
    let ReportArguments { input, lives, revolutions, threads, equations, .. } = arguments;
    // All of them, so that a new one is not passed over.
    let LivesArguments {
        trajectories,
        fit,
        shared_factor,
        seed,
        mission,
        no_mission,
        mean,
        coupling,
        no_feedback,
        settle,
        average,
    } = lives;
    let given = [
        ("--set", !input.overrides.is_empty()),
        ("--closure", input.closure.is_some()),
        ("--fit", !fit.is_empty()),
        ("--trajectories", trajectories.is_some()),
        ("--shared-factor", shared_factor.is_some()),
        ("--seed", *seed != 1),
        ("--mission", mission.is_some()),
        ("--no-mission", *no_mission),
        ("--mean", *mean),
        ("--coupling", coupling.is_some()),
        ("--no-feedback", *no_feedback),
        ("--settle", settle.is_some()),
        ("--average", *average != 1),
        ("--tol", revolutions.tol.is_some()),
        ("--step", revolutions.step.is_some()),
        ("--threads", threads.is_some()),
        ("--rigid", equations.rigid),
    ];
    given.into_iter().find(|(_, is)| *is).map(|(name, _)| name)
}
