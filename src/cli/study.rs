//! `study`: a mechanism at many points, what its runs and lives come to at each.

mod arguments;
pub mod output;

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use crate::mechanism::read_source;
use crate::progress::watched;
use crate::remark::remark;
use crate::study::{
    Cases, Points, Quantity, Study, StudyError, StudyJournal, StudyPart, StudyResult, listed, merge, named,
};
use crate::table::{is_stdout, write_table};
use linkwear_codegen::SourceFile;
use serde_json::Value;

pub use self::arguments::StudyArguments;
use super::answer::Answer;
use super::arguments::MergeArguments;
use super::failure::Failure;
use super::input::{check_output, options, print_remarks};
use super::life;
use super::shard_command::shard_command;
use super::simulate::{Simulation, integrator};

pub fn run(arguments: &StudyArguments) -> Result<Answer, Failure> {
    let (file, out) = (&arguments.input.file, arguments.out.as_deref());
    let is_stream = check_output(&arguments.motion.read_beside(file), out, arguments.replace)?;
    if is_stream && (arguments.resume || arguments.shard.is_some()) {
        let help = "give a file, so that what is finished has a place";
        return Err(Failure::usage("--out is a stream: nothing could go on or be merged from there", help));
    }
    let command = shard_command(std::env::args_os());
    let result = kept(arguments, &read_source(file)?, (command, !is_stream), |study, journal| {
        print_remarks(study.cases.base());
        watched("study", |watch| match journal {
            Some(journal) => study.run_kept(journal, watch),
            None => study.run(watch),
        })
    })?;
    match (arguments.shard, out) {
        (Some(shard), Some(out)) => Ok(output::of_shard(&result, shard, out)),
        (_, out) => finished(&result, (Some(file), out)),
    }
}

/// A study with its journal beside --out, if it keeps one; of a shard the part is written there, with the command that makes it.
pub fn kept(
    arguments: &StudyArguments,
    source: &SourceFile,
    (command, keeps): (String, bool),
    run: impl FnOnce(&Study<'_>, Option<&StudyJournal>) -> Result<StudyResult, StudyError>,
) -> Result<StudyResult, Failure> {
    let out = arguments.out.as_deref();
    asked(arguments, source, |study| {
        let open =
            if arguments.resume { |path: PathBuf| StudyJournal::resume(&path) } else { StudyJournal::create };
        let journal = out.filter(|_| keeps).map(|out| open(beside(out))).transpose();
        let journal = journal.map_err(Failure::journal)?;
        let result = run(study, journal.as_ref()).map_err(|error| failed(arguments, error))?;
        let part = StudyPart::new(study, command, result.clone());
        if let (Some(part), Some(out)) = (part, out) {
            part.write(out, study)?;
        }
        Ok(result)
    })
}

/// The points of all shards as one study.
pub fn merged(arguments: &MergeArguments) -> Result<Answer, Failure> {
    let shards: Vec<&Path> = arguments.shards.iter().map(PathBuf::as_path).collect();
    check_output(&shards, Some(&arguments.out), arguments.replace)?;
    let result = merge(&arguments.shards).map_err(Failure::merge)?;
    finished(&result, (None, Some(&arguments.out)))
}

/// The answer, and its table in its place.
fn finished(result: &StudyResult, (file, out): (Option<&Path>, Option<&Path>)) -> Result<Answer, Failure> {
    let mut answer = output::answer(result, file)?;
    if let Some(out) = out {
        write_table(out, &result.table(), Some(&result.facts.provenance))?;
        if is_stdout(out) {
            output::remarks(result).lines().for_each(|line| remark(&line));
            return Ok(Answer::new(String::new(), Value::Null, None));
        }
        answer.text.push_str(&output::written(result, out));
    }
    Ok(answer)
}

/// Does something with the study that is asked for.
pub fn asked<T>(
    arguments: &StudyArguments,
    source: &SourceFile,
    run: impl FnOnce(&Study<'_>) -> Result<T, Failure>,
) -> Result<T, Failure> {
    integrator(&arguments.motion)?;
    let points = points(arguments)?;
    let options = options(&arguments.input, arguments.equations.rigid);
    let cases = Cases::new(source, &options, arguments.equations.backend, ("--vary", &points))?;
    let mechanism = cases.base();
    let of = of(&arguments.of, &cases.quantities(&points))?;
    let simulation = Simulation::new(&arguments.input.file, &arguments.motion, mechanism)?;
    let steps = (arguments.motion.step, arguments.motion.tol);
    let (life, warnings) = life::lives(&arguments.lives, steps, mechanism)?;
    life::check_mission(&arguments.input.file, &life)?;
    warnings.iter().for_each(|warning| remark(&format_args!("warning: {warning}")));
    let study = Study {
        cases: &cases,
        points: &points,
        of,
        settings: simulation.settings,
        signals: simulation.signals.as_ref(),
        life,
        run_options: simulation.options(),
        shard: arguments.shard,
        threads: arguments.threads,
    };
    study.check().map_err(|error| failed(arguments, error))?;
    run(&study)
}

fn points(arguments: &StudyArguments) -> Result<Points, Failure> {
    let set = arguments.input.overrides.iter().map(|(name, _)| name);
    if let Some(name) = set.into_iter().find(|name| arguments.vary.iter().any(|axis| axis.name == **name)) {
        return Err(Failure::usage(format!("`{name}` is set and varies"), "leave --set or --vary out"));
    }
    let axes = arguments.vary.clone();
    let points = match arguments.sample {
        Some(count) => Points::sobol(axes, count, arguments.lives.seed),
        None => Points::grid(axes),
    };
    points.map_err(|error| {
        let help = "a grid takes NAME=A..B:N or NAME=a,b,c; --sample sobol:N takes NAME=A..B or NAME=a,b,c";
        Failure::usage(format!("--vary: {error}"), help)
    })
}

/// What is asked, each once.
fn of(names: &[String], known: &[Quantity]) -> Result<Vec<Quantity>, Failure> {
    let mut all: Vec<Quantity> = Vec::new();
    for name in names.iter().map(|name| name.trim()) {
        let found = named(name, known).ok_or_else(|| {
            let names: Vec<String> = known.iter().map(|quantity| quantity.name.clone()).collect();
            Failure::unknown_name("result", name, &names, &listed(known))
        })?;
        if named(name, &all).is_none() {
            all.push(found.clone());
        }
    }
    Ok(all)
}

/// Why there is no study, and what to do about it.
pub fn failed(arguments: &StudyArguments, error: StudyError) -> Failure {
    let help = match &arguments.out {
        Some(_) => "the same command with --resume goes on from there",
        None => "with --out FILE it could go on by --resume",
    };
    match error {
        StudyError::Journal(error) => Failure::journal(error),
        StudyError::GivenOverTime { ref name } => {
            let help = format!("delete its column in the file of --inputs, or leave `--vary {name}` out");
            Failure::usage(&error, help)
        }
        StudyError::SetOverTime { ref name } => Failure::set_over_time(name),
        StudyError::LifeOverTime { ref name } => {
            let help = format!(
                "leave `{name}` or --inputs out; give inputs of a life a value by --set or --vary, or values that change by a mission"
            );
            Failure::usage(&error, help)
        }
        StudyError::Interrupted { .. } => Failure::stopped(&arguments.input.file, error, help),
    }
}

/// `lives.csv` -> `lives.csv.journal`.
fn beside(out: &Path) -> PathBuf {
    let mut name = OsString::from(out.as_os_str());
    name.push(".journal");
    PathBuf::from(name)
}
