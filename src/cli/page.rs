//! `report`, `view`, `draw`: what a mechanism looks like, how it moves, what becomes of it, in one file. In: arguments. Out: a
//! file. Numbers are those of `simulate` and `life`, which are asked here.

mod lived;

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::time::Instant;

use linkwear_codegen::{Compiled, Options, SourceFile, compile};
use linkwear_runtime::{Run, Watch};
use serde_json::{Value, json};

use self::lived::Lived;
use super::answer::Answer;
use super::answer::equations::PageAnswer;
use super::arguments::{DrawArguments, ReportArguments, ViewArguments};
use super::failure::Failure;
use super::input::{options, print_remarks};
use super::life;
use super::options::{EquationsChoice, Input, LengthArguments, MotionArguments, Replace};
use super::picture::{self, may_write};
use super::simulate::{self, Simulation};
use super::table::duration;
use crate::files::write_whole;
use crate::life::{Cause, JOURNAL, LifeFacts, LifeStudy};
use crate::mechanism::{Mechanism, read_source};
use crate::page::document::Page;
use crate::page::drawing;
use crate::progress::watched;
use crate::provenance::sealed;
use crate::remark::remark;

/// Rows of the moving picture of a report.
const ROWS: u32 = 721;
/// Rows of a drawing.
const DRAWN: u32 = 241;

/// A mechanism that was run to be looked at.
struct Seen {
    compiled: Compiled,
    run: Run,
    /// As `simulate --format json` has it.
    json: Value,
}

/// Who hears of progress and remarks.
#[derive(Clone, Copy)]
pub struct Ear<'a> {
    /// Hears of progress, and may stop the work.
    pub watch: Watch<'a>,
    /// Whether remarks go to stderr.
    pub remarks: bool,
}

pub fn report(arguments: &ReportArguments) -> Result<Answer, Failure> {
    let ReportArguments { input, out, replace, .. } = arguments;
    let told = [life::folder::LIFE, life::folder::LIVES, JOURNAL].map(|name| input.file.join(name));
    let read: Vec<&Path> = [&input.file].into_iter().chain(&told).map(PathBuf::as_path).collect();
    to_file(&read, (out, *replace), |ear| {
        if input.file.is_dir() {
            return Ok((lived_page(arguments, ear)?.into_bytes(), ""));
        }
        let (page, wears) = report_page(arguments, &read_source(&input.file)?, ear)?;
        let note = if wears {
            ""
        } else {
            "\nno joint of this mechanism wears: no life in the page; add [clearance.R1] and [wear.R1], R1 being the joint that wears"
        };
        Ok((page.into_bytes(), note))
    })
}

/// The page of a report, and whether anything wears in it.
pub fn report_page(
    arguments: &ReportArguments,
    source: &SourceFile,
    ear: Ear<'_>,
) -> Result<(String, bool), Failure> {
    let ReportArguments { input, turns, equations, .. } = arguments;
    let seen = see((input, source), &motion(*turns, ROWS), *equations, ear)?;
    let mut plain = compile(&seen.compiled.source, &options(input, equations.rigid))?;
    plain.warnings.clone_from(&seen.compiled.warnings);
    let mechanism = Mechanism::of(&plain, &options(input, equations.rigid), equations.backend)?;
    let wears = mechanism.description.contacts.iter().any(|contact| contact.wear.is_some());
    let study = asked(arguments, &mechanism)?;
    let life = if wears { lived(arguments, study, ear)? } else { None };
    Ok((page(&seen, life.as_ref(), true), wears))
}

/// The life that is asked for, and what is doubtful about its fits; names that nothing has are told where none is lived, too.
fn asked<'m>(
    arguments: &ReportArguments,
    mechanism: &'m Mechanism,
) -> Result<(LifeStudy<'m>, Vec<String>), Failure> {
    let ReportArguments { input, lives, revolutions, threads, .. } = arguments;
    let (study, warnings) = life::lives(lives, (revolutions.step, revolutions.tol), mechanism)?;
    life::check_mission(&input.file, &study)?;
    Ok((LifeStudy { threads: *threads, ..study }, warnings))
}

/// What is told of the life; nothing where revolutions cannot be counted, which leaves the motion and the loads.
fn lived(
    arguments: &ReportArguments,
    (study, warnings): (LifeStudy<'_>, Vec<String>),
    ear: Ear<'_>,
) -> Result<Option<Value>, Failure> {
    let run = || {
        if let Some(cost) = study.cost(ear.watch)?
            && ear.remarks
        {
            remark(&life::output::cost(&cost));
        }
        study.run_watched(ear.watch)
    };
    let mut result = match run() {
        Err(error) if matches!(*error.cause, Cause::NoTurns | Cause::NoWholeTurn { .. }) => {
            if ear.remarks {
                remark(&format_args!("warning: no life in the page: {error}"));
            }
            return Ok(None);
        }
        lived => lived.map_err(|error| life::failed(&arguments.input.file, error, None))?,
    };
    result.warnings.extend(warnings);
    Ok(Some(life::output::answer(&LifeFacts::new(&study, result.coupling), &result).json))
}

/// The page of a life that was lived before, in a folder.
pub fn lived_page(arguments: &ReportArguments, ear: Ear<'_>) -> Result<String, Failure> {
    let Lived { json, input, source, rigid } = Lived::read(arguments)?;
    let equations = EquationsChoice { rigid, ..arguments.equations };
    let seen = see((&input, &source), &motion(arguments.turns, ROWS), equations, ear)?;
    Ok(page(&seen, Some(&json), true))
}

fn page(seen: &Seen, life: Option<&Value>, with_parameters: bool) -> String {
    let Seen { compiled, run, json } = seen;
    Page { compiled, run, simulation: json, life, with_parameters }.html()
}

pub fn view(arguments: &ViewArguments) -> Result<Answer, Failure> {
    let ViewArguments { input, out, replace, .. } = arguments;
    to_file(&arguments.motion.read_beside(&input.file), (out, *replace), |ear| {
        Ok((view_page(arguments, &read_source(&input.file)?, ear)?.into_bytes(), ""))
    })
}

/// The page of a motion.
pub fn view_page(arguments: &ViewArguments, source: &SourceFile, ear: Ear<'_>) -> Result<String, Failure> {
    let ViewArguments { input, motion, equations, .. } = arguments;
    let seen = see((input, source), motion, *equations, ear)?;
    Ok(page(&seen, None, false))
}

pub fn draw(arguments: &DrawArguments) -> Result<Answer, Failure> {
    let DrawArguments { input, out, replace, .. } = arguments;
    picture::check_ending(out)?;
    to_file(&[&input.file], (out, *replace), |ear| {
        let svg = drawn(arguments, &read_source(&input.file)?, ear)?;
        Ok((picture::drawn(out, svg)?, ""))
    })
}

/// The picture, SVG.
pub fn drawn(arguments: &DrawArguments, source: &SourceFile, ear: Ear<'_>) -> Result<String, Failure> {
    let DrawArguments { input, turns, equations, .. } = arguments;
    let seen = see((input, source), &motion(*turns, DRAWN), *equations, ear)?;
    Ok(drawing::svg(&seen.compiled, &seen.run).unwrap_or_default())
}

/// A run by the defaults.
fn motion(turns: Option<f64>, samples: u32) -> MotionArguments {
    let length = LengthArguments { turns, time: None };
    MotionArguments { length, samples, inputs: None, integrator: None, step: None, tol: None }
}

/// Runs with columns of where the bodies are.
fn see(
    (input, source): (&Input, &SourceFile),
    motion: &MotionArguments,
    equations: EquationsChoice,
    ear: Ear<'_>,
) -> Result<Seen, Failure> {
    let options = Options { pictured: true, ..options(input, equations.rigid) };
    let compiled = compile(source, &options)?;
    let mechanism = Mechanism::of(&compiled, &options, equations.backend)?;
    if ear.remarks {
        print_remarks(&mechanism);
    }
    let mut asked = Simulation::new(&input.file, motion, &mechanism)?;
    let begin = Instant::now();
    let run = asked.shown(motion, ear.watch)?;
    if let Some(error) = &run.stopped {
        return Err(Failure::run(&input.file, error, None));
    }
    let told = simulate::told_of(None, &mechanism, &run, begin.elapsed().as_secs_f64());
    let json = sealed(json!(told), Some(&asked.provenance()));
    Ok(Seen { compiled, run, json })
}

/// Writes what is made of a file, with a note for its reader.
fn to_file(
    read: &[&Path],
    (out, replace): (&Path, Replace),
    make: impl FnOnce(Ear<'_>) -> Result<(Vec<u8>, &'static str), Failure>,
) -> Result<Answer, Failure> {
    may_write(read, out, replace)?;
    let begin = Instant::now();
    let (bytes, note) = watched("run", |watch| make(Ear { watch, remarks: true }))?;
    write_whole(out, |file| file.write_all(&bytes))?;
    let seconds = begin.elapsed().as_secs_f64();
    let (file, size) = (out.display(), bytes.len().div_ceil(1000));
    let told = PageAnswer { file: file.to_string(), bytes: bytes.len(), seconds };
    let text = format!("{file}: written, {size} kB in {}; open it in a browser{note}", duration(seconds));
    Ok(Answer::new(text, told, None))
}
