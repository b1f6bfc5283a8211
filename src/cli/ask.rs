//! Questions in the words of the command line, answered within a program: what doors in other languages stand on, so that a question
//! has the same options, the same answer and the same faults everywhere. In: words, texts in the place of files. Out: results with
//! their JSON, or a [`Failure`]. Never prints, and writes no file.

use std::ops::Range;
use std::path::{Path, PathBuf};

use clap::Parser as _;
use linkwear_codegen::SourceFile;
use linkwear_gamma::FitFile;
use linkwear_runtime::{Run, Watch};
use serde_json::{Value, json};

use super::arguments::{Arguments, Command};
use super::failure::{Failure, entries, unread_arguments};
#[cfg(feature = "page")]
use super::page;
use super::{check, fit, input, life, plan, predict, simulate, study};
use crate::csv_table::CsvTable;
use crate::life::{LifeFacts, LifeJournal, LifePart, LifeResult};
use crate::provenance::sealed;
use crate::study::StudyResult;

/// A run and what is told of it.
#[derive(Debug)]
pub struct Simulated {
    /// The run, to its end.
    pub run: Run,
    /// As `simulate --format json` has it.
    pub json: Value,
}

/// A life and what is told of it.
#[derive(Debug)]
pub struct Lived {
    /// What became of it.
    pub result: LifeResult,
    /// As `life --format json` has it.
    pub json: Value,
}

/// A study and what is told of it.
#[derive(Debug)]
pub struct Studied {
    /// What became of it.
    pub result: StudyResult,
    /// As `study --format json` has it.
    pub json: Value,
}

/// `check`, of a text.
///
/// # Errors
/// Wrong words; a wrong mechanism.
pub fn check(words: &[String], source: &SourceFile) -> Result<Value, Failure> {
    let Command::Check(input) = parsed("check", words, &source.name)? else { return Err(no_such_words()) };
    let (compiled, warnings) = input::compiled(&input, source)?;
    Ok(check::answer(&compiled, &input::options(&input, false), &entries(&warnings)).json)
}

/// A mechanism ready to run, with `--set`, `--closure` and `--allow-outside-data` of the words.
///
/// # Errors
/// Wrong words; a wrong mechanism.
pub fn compile(words: &[String], source: &SourceFile) -> Result<linkwear_codegen::Compiled, Failure> {
    let Command::Check(input) = parsed("check", words, &source.name)? else { return Err(no_such_words()) };
    Ok(input::compiled(&input, source)?.0)
}

/// `simulate`, of a text.
///
/// # Errors
/// Wrong words; a wrong mechanism; a run that does not come to its end.
pub fn simulate(words: &[String], source: &SourceFile, watch: Watch<'_>) -> Result<Simulated, Failure> {
    let Command::Simulate(arguments) = parsed("simulate", words, &source.name)? else {
        return Err(no_such_words());
    };
    nothing_written(arguments.out.as_deref())?;
    #[cfg(feature = "page")]
    nothing_written(arguments.plot.as_deref())?;
    let mechanism = input::of_source(&arguments.input, source, arguments.equations)?;
    let asked = simulate::Simulation::new(&arguments.input.file, &arguments.motion, &mechanism)?;
    let begin = std::time::Instant::now();
    let run = asked.run(watch)?;
    if let Some(error) = &run.stopped {
        return Err(Failure::run(&arguments.input.file, error, None));
    }
    let told = simulate::told_of(None, &mechanism, &run, begin.elapsed().as_secs_f64());
    let json = sealed(json!(told), Some(&asked.provenance()));
    Ok(Simulated { run, json })
}

/// `life`, of a text.
///
/// # Errors
/// Wrong words; a wrong mechanism; a life that cannot be lived to its end.
pub fn life(words: &[String], source: &SourceFile, watch: Watch<'_>) -> Result<Lived, Failure> {
    let Command::Life(arguments) = parsed("life", words, &source.name)? else { return Err(no_such_words()) };
    nothing_written(arguments.out.as_deref())?;
    #[cfg(feature = "page")]
    nothing_written(arguments.plot.as_deref())?;
    let mechanism = input::of_source(&arguments.input, source, arguments.equations)?;
    let (study, warnings) = life::study(&arguments, &mechanism)?;
    let lived = study.run_watched(watch);
    let mut result = lived.map_err(|error| life::failed(&arguments.input.file, error, None))?;
    result.warnings.extend(warnings);
    let json = life::output::answer(&LifeFacts::new(&study, result.coupling), &result).json;
    Ok(Lived { result, json })
}

/// `life --shard I/N --out DIR --resume`, of a text: what was lived before in the folder is taken over.
///
/// # Errors
/// As [`life`]; a folder that cannot be written, or that is of another study.
pub fn shard(
    words: &[String],
    source: &SourceFile,
    (shard, folder): (&str, &str),
    watch: Watch<'_>,
) -> Result<LifePart, Failure> {
    let own = ["--shard", shard, "--out", folder, "--resume"].map(str::to_owned);
    let Command::Life(arguments) = parsed("life", &[words, &own].concat(), &source.name)? else {
        return Err(no_such_words());
    };
    let mechanism = input::of_source(&arguments.input, source, arguments.equations)?;
    let folder = Path::new(folder);
    let journal = LifeJournal::resume(folder).map_err(Failure::journal)?;
    let (study, warnings) = life::study(&arguments, &mechanism)?;
    let lived = study.run_kept(&journal, watch);
    let mut result = lived.map_err(|error| {
        life::failed(&arguments.input.file, error, Some(&life::Kept::new(folder, &study)))
    })?;
    result.warnings.extend(warnings);
    let part = LifePart::new(&study, String::new(), result).ok_or_else(no_such_words)?;
    life::folder::write_shard(folder, &part, &study)?;
    Ok(part)
}

/// `merge`, of the folders of all shards.
///
/// # Errors
/// What cannot be put together.
pub fn merge(shards: &[String]) -> Result<Lived, Failure> {
    let folders: Vec<PathBuf> = shards.iter().map(PathBuf::from).collect();
    let (facts, result) = crate::life::merge(&folders).map_err(Failure::merge)?;
    let json = life::output::answer(&facts, &result).json;
    Ok(Lived { result, json })
}

/// `report`, `view` or `draw`, of a text: the page, or the picture.
///
/// # Errors
/// Wrong words; a wrong mechanism; a run or a life that does not come to its end.
#[cfg(feature = "page")]
pub fn page(
    subcommand: &str,
    words: &[String],
    source: &SourceFile,
    watch: Watch<'_>,
) -> Result<String, Failure> {
    let ear = page::Ear { watch, remarks: false };
    // It has to be named, and is not written.
    let nowhere = ["--out", "page"].map(str::to_owned);
    match parsed(subcommand, &[words, &nowhere].concat(), &source.name)? {
        Command::Report(arguments) => Ok(page::report_page(&arguments, source, ear)?.0),
        Command::View(arguments) => page::view_page(&arguments, source, ear),
        Command::Draw(arguments) => page::drawn(&arguments, source, ear),
        _ => Err(no_such_words()),
    }
}

/// `study`, of a text.
///
/// # Errors
/// Wrong words; a wrong mechanism; points at none of which there is anything.
pub fn study(words: &[String], source: &SourceFile, watch: Watch<'_>) -> Result<Studied, Failure> {
    let Command::Study(arguments) = parsed("study", words, &source.name)? else {
        return Err(no_such_words());
    };
    nothing_written(arguments.out.as_deref())?;
    let result = study::asked(&arguments, source, |study| {
        study.run(watch).map_err(|error| study::failed(&arguments, error))
    })?;
    let json = study::output::answer(&result, Some(&arguments.input.file))?.json;
    Ok(Studied { result, json })
}

/// `study --shard I/N --out FILE --resume`, of a text: what was done before beside the file is taken over.
///
/// # Errors
/// As [`study`]; a file that cannot be written.
pub fn study_shard(
    words: &[String],
    source: &SourceFile,
    (shard, file): (&str, &str),
    watch: Watch<'_>,
) -> Result<Value, Failure> {
    let own = ["--shard", shard, "--out", file, "--resume"].map(str::to_owned);
    let Command::Study(arguments) = parsed("study", &[words, &own].concat(), &source.name)? else {
        return Err(no_such_words());
    };
    let result = study::kept(&arguments, source, (String::new(), true), |study, journal| match journal {
        Some(journal) => study.run_kept(journal, watch),
        None => study.run(watch),
    })?;
    let shard = arguments.shard.ok_or_else(no_such_words)?;
    Ok(study::output::of_shard(&result, shard, Path::new(file)).json)
}

/// `merge`, of the files of all parts of a study.
///
/// # Errors
/// What cannot be put together.
pub fn merge_study(parts: &[String]) -> Result<Value, Failure> {
    let files: Vec<PathBuf> = parts.iter().map(PathBuf::from).collect();
    let result = crate::study::merge(&files).map_err(Failure::merge)?;
    Ok(study::output::answer(&result, None)?.json)
}

/// A fit and what is told of it.
#[derive(Debug)]
pub struct Fitted {
    /// As `fit --format json` has it.
    pub json: Value,
    /// The file of `fit --out`, which [`predict`] takes.
    pub file: String,
}

/// `fit`, of a table of readings as CSV; `name` is said where it is at fault. `drawn` are replicates of the bootstrap, all that the
/// words ask for, from [`replicates`] in the order of their numbers; without them they are drawn here.
///
/// # Errors
/// Wrong words; wrong data; no estimate; replicates that are not as many as asked for.
pub fn fit(words: &[String], name: &str, table: &str, drawn: &[String]) -> Result<Fitted, Failure> {
    let Command::Fit(arguments) = parsed("fit", words, name)? else { return Err(no_such_words()) };
    nothing_written(arguments.out.as_deref())?;
    #[cfg(feature = "page")]
    nothing_written(arguments.plot.as_deref())?;
    let mut all = fit::Replicates::new();
    for part in drawn {
        let part: fit::Replicates =
            serde_json::from_str(part).map_err(|error| no_replicates(&error.to_string()))?;
        part.into_iter().for_each(|(group, next)| all.entry(group).or_default().append(next));
    }
    let asked = arguments.bootstrap;
    if let Some((group, found)) = all.iter().find(|(_, replicates)| replicates.replicates() != asked) {
        let found = found.replicates();
        return Err(no_replicates(&format!("of group {group} there are {found}, and {asked} are asked for")));
    }
    let table = CsvTable::parse(Path::new(name), table)?;
    let fit::Fitted { answer, file } = fit::fitted(&arguments, &table, (!drawn.is_empty()).then_some(&all))?;
    Ok(Fitted { json: answer.json, file })
}

/// Some replicates of the bootstrap of a fit, by their numbers from 0, as text for [`fit`].
///
/// # Errors
/// As [`fit`].
pub fn replicates(words: &[String], name: &str, table: &str, numbers: Range<u64>) -> Result<String, Failure> {
    let Command::Fit(arguments) = parsed("fit", words, name)? else { return Err(no_such_words()) };
    let drawn = fit::replicates(&arguments, &CsvTable::parse(Path::new(name), table)?, numbers)?;
    serde_json::to_string(&drawn).map_err(|error| no_replicates(&error.to_string()))
}

fn no_replicates(why: &str) -> Failure {
    Failure::usage(
        format!("the replicates of the bootstrap are not those of this fit: {why}"),
        "draw them with the same words",
    )
}

/// `predict`, by the JSON of a fit.
///
/// # Errors
/// Wrong words; a fit that is none; a question without an answer.
pub fn predict(words: &[String], name: &str, fit: &str) -> Result<Value, Failure> {
    let Command::Predict(arguments) = parsed("predict", words, name)? else { return Err(no_such_words()) };
    let fit = FitFile::parse(fit).map_err(Failure::fit(Path::new(name)))?;
    Ok(predict::answer(&arguments, &fit)?.json)
}

/// `plan`, by the JSON of a fit.
///
/// # Errors
/// As [`predict`].
pub fn plan(words: &[String], name: &str, fit: &str) -> Result<Value, Failure> {
    let Command::Plan(arguments) = parsed("plan", words, name)? else { return Err(no_such_words()) };
    #[cfg(feature = "page")]
    nothing_written(arguments.plot.as_deref())?;
    let fit = FitFile::parse(fit).map_err(Failure::fit(Path::new(name)))?;
    Ok(plan::by_fit(&arguments, fit)?.json)
}

/// The words of a subcommand, its file last.
fn parsed(subcommand: &str, words: &[String], file: &str) -> Result<Command, Failure> {
    let head = ["linkwear", subcommand].map(str::to_owned);
    let tail = ["--", file].map(str::to_owned);
    let parsed = Arguments::try_parse_from(head.iter().chain(words).chain(&tail));
    parsed.map(|parsed| parsed.command).map_err(|error| unread_arguments(&error))
}

/// Words such as `--help` name no question.
fn no_such_words() -> Failure {
    Failure::usage("these words ask nothing", "give options of the subcommand")
}

fn nothing_written(out: Option<&Path>) -> Result<(), Failure> {
    match out {
        Some(_) => {
            Err(Failure::usage("--out, --plot: nothing is written here", "write the result that is returned"))
        }
        None => Ok(()),
    }
}
