//! The program of the case study: its figures and tables, recomputed, in a folder.
//! Exit code 0: done, 1: the study or the writing failed, 2: wrong usage.

#![deny(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::todo,
    clippy::unimplemented,
    clippy::unreachable
)]

use std::fs;
use std::io::{self, Write as _};
use std::num::NonZeroU16;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Parser, ValueEnum};
use linkwear::files::{WriteError, claim_folder, print, write_whole};
use linkwear::progress::watched;
use linkwear_case_study::{Options, Picture, Study, StudyError, html, markdown, pictures, run, summary};
use serde_json::{Value, json};

/// Recompute the figures and tables of the paper's case study, beside the paper's own numbers.
#[derive(Debug, Parser)]
#[command(
    name = "linkwear-case-study",
    version,
    after_help = "Example:\n  cargo run --release -p linkwear-case-study -- --out study"
)]
struct Arguments {
    /// A rough study in less than a minute, to test the tool.
    #[arg(long)]
    quick: bool,
    /// Folder for figures, tables and results; must be new or empty.
    #[arg(long, value_name = "DIR", default_value = "case-study")]
    out: PathBuf,
    /// Seed of the random numbers.
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    /// Threads [default: all processors]. Their number changes no result.
    #[arg(long, value_name = "T")]
    threads: Option<NonZeroU16>,
    /// `json`: one JSON object on stdout, nothing else there.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

/// For whom the answer is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    Text,
    Json,
}

/// An error with the code that the command line of linkwear has for its like.
struct Failure {
    code: &'static str,
    file: Option<PathBuf>,
    message: String,
    help: &'static str,
}

impl Failure {
    fn study(error: StudyError) -> Self {
        let code = if matches!(error, StudyError::Interrupted) { "C0009" } else { "C0012" };
        Self { code, file: None, message: error.to_string(), help: "nothing was written" }
    }

    fn report(&self, format: Format) {
        let Self { code, file, message, help } = self;
        match format {
            Format::Text => eprintln!("error[{code}]: {message}\n  = help: {help}"),
            Format::Json => {
                let error = json!({
                    "code": code, "file": file.as_ref().map(|file| file.display().to_string()),
                    "line": Value::Null, "column": Value::Null, "message": message, "help": help,
                });
                // A reader who has gone away cannot be told; the exit code still says it.
                let _ = print(&json!({ "errors": [error] }));
            }
        }
    }
}

impl From<WriteError> for Failure {
    fn from(error: WriteError) -> Self {
        let message = error.to_string();
        let (code, file, help) = match error {
            WriteError::Exists(file) => ("C0004", file, "choose another name"),
            WriteError::System { file, .. } => {
                ("C0003", file, "choose a folder that exists and can be written")
            }
        };
        Self { code, file: Some(file), message, help }
    }
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    match answer(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            failure.report(arguments.format);
            ExitCode::FAILURE
        }
    }
}

fn answer(arguments: &Arguments) -> Result<(), Failure> {
    let out = &arguments.out;
    let is_new = !out.exists();
    claim_folder(out)?;
    let options = Options { quick: arguments.quick, seed: arguments.seed };
    let processors = || std::thread::available_parallelism().map_or(1, usize::from);
    let threads = arguments.threads.map_or_else(processors, |threads| usize::from(threads.get()));
    let studied = watched("study", |watch| run(options, threads, watch));
    let drawn = studied.and_then(|study| Ok((pictures(&study)?, study)));
    let (pictures, study) = drawn.map_err(Failure::study).inspect_err(|_| {
        if is_new {
            // Nothing was written: the folder made for it goes, too.
            let _ = fs::remove_dir(out);
        }
    })?;
    let results = serde_json::to_value(&study)
        .map_err(|error| WriteError::of(&out.join("results.json"))(io::Error::other(error)))?;
    let names = write(out, &study, pictures, &results)?;
    match arguments.format {
        Format::Json => print(&results)?,
        Format::Text => print(&format!("{}\n\nin {}: {}", summary(&study), out.display(), names.join(", ")))?,
    }
    Ok(())
}

/// Writes every file whole; returns their names.
fn write(out: &Path, study: &Study, pictures: Vec<Picture>, results: &Value) -> Result<Vec<String>, Failure> {
    let page = html(study, &pictures);
    let mut files: Vec<(String, Vec<u8>)> = Vec::new();
    for Picture { name, svg, png } in pictures {
        files.extend([(format!("{name}.svg"), svg.into_bytes()), (format!("{name}.png"), png)]);
    }
    files.push(("case-study.md".to_owned(), markdown(study).into_bytes()));
    files.push(("case-study.html".to_owned(), page.into_bytes()));
    files.push(("results.json".to_owned(), format!("{results:#}\n").into_bytes()));
    for (name, bytes) in &files {
        write_whole(&out.join(name), |file| file.write_all(bytes))?;
    }
    Ok(files.into_iter().map(|(name, _)| name).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_study_that_is_stopped_is_told_as_all_that_is() {
        assert_eq!(Failure::study(StudyError::Interrupted).code, "C0009");
        let failed = Failure::study(StudyError::Missing { kind: "joint", name: "R1".into() });
        assert_eq!(failed.code, "C0012");
    }
}
