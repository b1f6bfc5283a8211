//! The command line: who answers what was asked.
//! In: arguments. Out: text or one JSON object on stdout, everything else on stderr, an exit code
//! (0 done, 1 the input or the run failed, 2 wrong usage). Never knows how a stage works.

mod arguments;
mod check;
mod csv_table;
mod equations;
mod failure;
mod file;
mod fit;
mod fit_file;
mod generate;
mod input;
mod life;
mod new;
mod packaging;
mod plot;
mod predict;
mod readings;
mod schema;
mod simulate;
mod summary;
mod table;
mod value;

use std::ffi::OsString;
use std::process::ExitCode;

use clap::Parser;

use arguments::{Arguments, Command, Format};
use failure::Failure;

/// Reads the arguments of this process, answers, and says how it ended.
pub fn run() -> ExitCode {
    let arguments: Vec<OsString> = std::env::args_os().collect();
    let parsed = match Arguments::try_parse_from(&arguments) {
        Ok(parsed) => parsed,
        Err(error) => return failure::wrong_arguments(&error, wants_json(&arguments)),
    };
    let format = if wants_json(&arguments) { Format::Json } else { parsed.format };
    match answer(parsed) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(format),
    }
}

fn answer(arguments: Arguments) -> Result<(), Failure> {
    let format = arguments.format;
    match arguments.command {
        Command::Check(input) => check::run(&input, format),
        Command::Equations(arguments) => equations::run(&arguments, format),
        Command::Generate(arguments) => generate::run(&arguments, format),
        Command::Simulate(arguments) => simulate::run(&arguments, format),
        Command::Life(arguments) => life::run(&arguments, format),
        Command::CaseStudy { arguments } => Err(moved_case_study(&arguments)),
        Command::Predict(arguments) => predict::run(&arguments, format),
        Command::Fit(arguments) => fit::run(&arguments, format),
        Command::New(arguments) => new::run(&arguments, format),
        Command::Schema => schema::run(),
        Command::Completions { shell } => packaging::completions(shell, format),
        Command::Man => packaging::manual(format),
    }
}

fn moved_case_study(arguments: &[String]) -> Failure {
    let arguments = if arguments.is_empty() { "--out study".to_owned() } else { arguments.join(" ") };
    Failure::Usage {
        message: "the case study is a program of its own".to_owned(),
        help: format!("cargo run --release -p linkwear-case-study -- {arguments}"),
    }
}

/// Whether JSON was asked for, on a command line that clap could not read, or that belongs to another program.
fn wants_json(arguments: &[OsString]) -> bool {
    let is = |argument: &OsString, text: &str| argument.to_str() == Some(text);
    arguments.iter().any(|argument| is(argument, "--format=json"))
        || arguments.windows(2).any(|pair| is(&pair[0], "--format") && is(&pair[1], "json"))
}
