//! What went wrong, for people and for machines, and the exit code that says whose fault it was.
//! In: errors of every stage. Out: text on stderr or `{"errors": [..]}` on stdout.

use std::fmt::Write as _;
use std::io;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::error::ErrorKind;
use linkwear::files::print;
use linkwear_codegen::diagnostic::{Diagnostics, Entry, nearest};
use linkwear_runtime::RunError;
use serde_json::{Value, json};

use super::arguments::Format;

/// The input or the run failed.
const FAILED: u8 = 1;
/// The command line is wrong.
const USAGE: u8 = 2;

/// Why a subcommand did not do what was asked.
#[derive(Debug)]
pub enum Failure {
    /// The arguments do not fit this mechanism or each other.
    Usage {
        /// What is wrong.
        message: String,
        /// What to do.
        help: String,
    },
    /// The mechanism file is wrong.
    Mechanism(Diagnostics),
    /// A file cannot be read.
    Read(PathBuf, io::Error),
    /// A file cannot be written.
    Write(PathBuf, io::Error),
    /// A file would be overwritten that should not be.
    Exists(PathBuf),
    /// A generated file is not what the mechanism gives.
    Stale {
        /// The file.
        file: PathBuf,
        /// First line that differs, from 1.
        line: usize,
    },
    /// A name given on the command line does not exist.
    UnknownName {
        /// What was given.
        name: String,
        /// What there is.
        known: Vec<String>,
    },
    /// The backend asked for cannot run this.
    Backend {
        /// Why.
        message: String,
        /// What to do.
        help: String,
    },
    /// A file with data or results is wrong.
    Data {
        /// The file.
        file: PathBuf,
        /// Where, from 1, if it has a place.
        line: Option<usize>,
        /// What is wrong.
        message: String,
        /// What to do.
        help: String,
    },
    /// A life could not be lived to its end.
    Life {
        /// The mechanism.
        file: PathBuf,
        /// Why.
        message: String,
        /// What to do, or where the cycles before are.
        help: String,
        /// The cycles before, if they are in no file.
        cycles: Vec<Value>,
    },
    /// The simulation failed, or was stopped.
    Run {
        /// The mechanism.
        file: PathBuf,
        /// Why.
        error: RunError,
        /// Where the rows computed so far are.
        kept: Option<PathBuf>,
    },
    /// Ctrl-C.
    Interrupted {
        /// The mechanism.
        file: PathBuf,
        /// Simulated time reached [s].
        time: f64,
        /// Where the rows computed so far are.
        kept: Option<PathBuf>,
    },
}

/// One error without a place in the text of a file.
struct Plain {
    code: &'static str,
    file: Option<PathBuf>,
    line: Option<usize>,
    message: String,
    help: String,
}

impl Failure {
    /// Says it, and returns the exit code.
    pub fn report(&self, format: Format) -> ExitCode {
        let code = if matches!(self, Self::Usage { .. }) { USAGE } else { FAILED };
        match format {
            Format::Text => eprintln!("{}", self.text()),
            Format::Json => print_errors(&self.entries(), self.cycles()),
        }
        ExitCode::from(code)
    }

    fn cycles(&self) -> &[Value] {
        if let Self::Life { cycles, .. } = self { cycles } else { &[] }
    }

    fn text(&self) -> String {
        if let Self::Mechanism(diagnostics) = self {
            return diagnostics.to_string().trim_end().to_owned();
        }
        let plain = self.plain();
        let mut text = format!("error[{}]: {}", plain.code, plain.message);
        // Other messages name their file.
        if let Self::Data { file, line, .. } = self {
            let place = line.map_or_else(String::new, |line| format!(":{line}"));
            let _ = write!(text, "\n  --> {}{place}", file.display());
        }
        if !plain.help.is_empty() {
            let _ = write!(text, "\n  = help: {}", plain.help);
        }
        text
    }

    fn entries(&self) -> Vec<Value> {
        if let Self::Mechanism(diagnostics) = self {
            return entries(diagnostics);
        }
        let plain = self.plain();
        vec![json!({
            "code": plain.code,
            "file": plain.file.map(|file| file.display().to_string()),
            "line": plain.line, "column": Value::Null,
            "message": plain.message, "help": plain.help,
        })]
    }

    /// The one table of codes and messages of the command line.
    fn plain(&self) -> Plain {
        let (code, file, message, help) = match self {
            Self::Usage { message, help } => ("C0001", None, message.clone(), help.clone()),
            Self::Read(file, error) => (
                "C0002",
                Some(file),
                format!("cannot read `{}`: {error}", file.display()),
                "check the path; shipped mechanisms are in `mechanisms/`".to_owned(),
            ),
            Self::Write(file, error) => (
                "C0003",
                Some(file),
                format!("cannot write `{}`: {error}", file.display()),
                "nothing was left there; choose a folder that exists and can be written".to_owned(),
            ),
            Self::Exists(file) => (
                "C0004",
                Some(file),
                format!("`{}` exists and would be overwritten", file.display()),
                "choose another name".to_owned(),
            ),
            Self::Stale { file, line } => (
                "C0005",
                Some(file),
                format!("`{}` is stale: it differs from line {line} on", file.display()),
                "run the same command without --check".to_owned(),
            ),
            Self::UnknownName { name, known } => {
                ("C0006", None, format!("there is no output or function `{name}`"), suggestion(name, known))
            }
            Self::Backend { message, help } => ("C0007", None, message.clone(), help.clone()),
            Self::Life { file, message, help, .. } => ("C0010", Some(file), message.clone(), help.clone()),
            Self::Data { file, message, help, .. } => ("C0011", Some(file), message.clone(), help.clone()),
            Self::Run { file, error, kept } => ("C0008", Some(file), error.to_string(), kept_help(kept)),
            Self::Interrupted { file, time, kept } => {
                ("C0009", Some(file), format!("stopped on request at t = {time} s"), kept_help(kept))
            }
            Self::Mechanism(_) => unreachable!("rendered by the front end"),
        };
        let line = match self {
            Self::Stale { line, .. } => Some(*line),
            Self::Data { line, .. } => *line,
            _ => None,
        };
        Plain { code, file: file.cloned(), line, message, help }
    }
}

fn kept_help(kept: &Option<PathBuf>) -> String {
    kept.as_deref().map_or_else(String::new, |path: &Path| {
        format!("the rows computed before that are in `{}`", path.display())
    })
}

fn suggestion(name: &str, known: &[String]) -> String {
    match nearest(name, known.iter().map(String::as_str)) {
        Some(candidate) => format!("did you mean `{candidate}`?"),
        None => format!("there are: {}", known.join(", ")),
    }
}

/// Diagnostics of the mechanism file as machines read them.
pub fn entries(diagnostics: &Diagnostics) -> Vec<Value> {
    let value = |entry: Entry| {
        json!({
            "code": entry.code, "file": entry.file, "line": entry.line, "column": entry.column,
            "message": entry.message, "help": entry.help,
        })
    };
    diagnostics.entries().into_iter().map(value).collect()
}

/// `cycles` are what a life had before it stopped, kept beside the errors.
fn print_errors(errors: &[Value], cycles: &[Value]) {
    let mut answer = json!({ "errors": errors });
    if !cycles.is_empty() {
        answer["cycles"] = json!(cycles);
    }
    // A reader who has gone away cannot be told; the exit code still says it.
    let _ = print(&answer);
}

/// Reports what clap says about arguments it could not read; help and version are not errors.
pub fn wrong_arguments(error: &clap::Error, as_json: bool) -> ExitCode {
    if as_json && error.use_stderr() {
        let text = error.render().to_string();
        let message = match error.kind() {
            ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand => "no subcommand given".to_owned(),
            _ => first_paragraph(&text),
        };
        print_errors(
            &[json!({
                "code": "C0001", "file": Value::Null, "line": Value::Null, "column": Value::Null,
                "message": message, "help": text.trim_end(),
            })],
            &[],
        );
    } else {
        let _ = error.print();
    }
    ExitCode::from(if error.use_stderr() { USAGE } else { 0 })
}

/// What clap says before its usage lines, in one line.
fn first_paragraph(text: &str) -> String {
    let lines = text.lines().map(str::trim).take_while(|line| !line.is_empty());
    lines.collect::<Vec<_>>().join(" ").trim_start_matches("error: ").to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_near_name_is_suggested_and_a_far_one_lists_all() {
        let known = ["closure".to_owned(), "phi".to_owned()];
        assert_eq!(suggestion("closrue", &known), "did you mean `closure`?");
        assert_eq!(suggestion("torque", &known), "there are: closure, phi");
    }
}
