//! `report`, `view`, `draw`: what a mechanism looks like, how it moves, what becomes of it, in one file. In: arguments. Out: a
//! file. Numbers are those of `simulate` and `life`, which are asked here.

use std::io::Write as _;
use std::path::Path;
use std::time::Instant;

use linkwear_codegen::{Compiled, Options, compile};
use linkwear_runtime::Run;
use serde_json::{Value, json};

use super::answer::Answer;
use super::answer::equations::PageAnswer;
use super::arguments::{DrawArguments, ReportArguments, ViewArguments};
use super::failure::Failure;
use super::input::{options, print_remarks};
use super::life;
use super::options::{EquationsChoice, Input, LengthArguments, MotionArguments};
use super::picture::may_write;
use super::simulate::{self, Simulation};
use super::table::duration;
use crate::files::write_whole;
use crate::life::{LifeFacts, LifeStudy};
use crate::mechanism::{Mechanism, read_source};
use crate::page::document::Page;
use crate::page::drawing;
use crate::progress::watched;
use crate::provenance::sealed;

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

pub fn report(arguments: &ReportArguments) -> Result<Answer, Failure> {
    let ReportArguments { input, lives, tol, step, threads, turns, equations, out, force } = arguments;
    may_write(&input.file, out, *force)?;
    let begin = Instant::now();
    let seen = see(input, &motion(*turns, ROWS), *equations)?;
    let mut plain = compile(&seen.compiled.source, &options(input, equations.rigid))?;
    plain.warnings.clone_from(&seen.compiled.warnings);
    let mechanism = Mechanism::of(&plain, &options(input, equations.rigid), equations.backend)?;
    let wears = mechanism.description.contacts.iter().any(|contact| contact.wear.is_some());
    let life = if wears {
        let (study, warnings) = life::lives(lives, (*step, *tol), &mechanism)?;
        let study = LifeStudy { threads: *threads, ..study };
        let failed = |error| life::failed(&input.file, error, None);
        if let Some(cost) = watched(|watch| study.cost(watch)).map_err(failed)? {
            eprintln!("{}", life::output::cost(&cost));
        }
        let mut result = watched(|watch| study.run_watched(watch)).map_err(failed)?;
        result.warnings.extend(warnings);
        let json = life::output::answer(&LifeFacts::new(&study, result.coupling), &result).json;
        Some((result, json))
    } else {
        None
    };
    let page = Page {
        compiled: &seen.compiled,
        run: &seen.run,
        simulation: &seen.json,
        life: life.as_ref().map(|(result, json)| (result, json)),
        with_parameters: true,
    };
    let note = if wears {
        ""
    } else {
        "\nno joint of this mechanism wears: no life in the page; add [clearance.R1] and [wear.R1], R1 being the joint that wears"
    };
    written(out, page.html(), begin, note)
}

pub fn view(arguments: &ViewArguments) -> Result<Answer, Failure> {
    let ViewArguments { input, motion, equations, out, force } = arguments;
    may_write(&input.file, out, *force)?;
    let begin = Instant::now();
    let seen = see(input, motion, *equations)?;
    let page = Page {
        compiled: &seen.compiled,
        run: &seen.run,
        simulation: &seen.json,
        life: None,
        with_parameters: false,
    };
    written(out, page.html(), begin, "")
}

pub fn draw(arguments: &DrawArguments) -> Result<Answer, Failure> {
    let DrawArguments { input, turns, equations, out, force } = arguments;
    may_write(&input.file, out, *force)?;
    let begin = Instant::now();
    let seen = see(input, &motion(*turns, DRAWN), *equations)?;
    written(out, drawing::svg(&seen.compiled, &seen.run).unwrap_or_default(), begin, "")
}

/// A run by the defaults.
fn motion(turns: Option<f64>, samples: u32) -> MotionArguments {
    let length = LengthArguments { turns, time: None };
    MotionArguments { length, samples, inputs: None, integrator: None, step: None, tol: None }
}

/// Runs with columns of where the bodies are.
fn see(input: &Input, motion: &MotionArguments, equations: EquationsChoice) -> Result<Seen, Failure> {
    let source = read_source(&input.file)?;
    let options = Options { pictured: true, ..options(input, equations.rigid) };
    let compiled = compile(&source, &options)?;
    let mechanism = Mechanism::of(&compiled, &options, equations.backend)?;
    print_remarks(&mechanism);
    let asked = Simulation::new(&input.file, motion, &mechanism)?;
    let begin = Instant::now();
    let run = watched(|watch| asked.run(watch))?;
    if let Some(error) = &run.stopped {
        return Err(Failure::run(&input.file, error, None));
    }
    let told = simulate::told_of(None, &mechanism, &run, begin.elapsed().as_secs_f64());
    let json = sealed(json!(told), Some(&asked.provenance()));
    Ok(Seen { compiled, run, json })
}

fn written(out: &Path, text: String, begin: Instant, note: &str) -> Result<Answer, Failure> {
    write_whole(out, |file| file.write_all(text.as_bytes()))?;
    let seconds = begin.elapsed().as_secs_f64();
    let (file, size) = (out.display(), text.len().div_ceil(1000));
    let told = PageAnswer { file: file.to_string(), bytes: text.len(), seconds };
    let text = format!("{file}: written, {size} kB in {}; open it in a browser{note}", duration(seconds));
    Ok(Answer::new(text, told, None))
}
