//! What went wrong, for people and for machines, and the exit code that says whose fault it was.
//! In: errors of every stage. Out: text on stderr or `{"errors": [..]}` on stdout.

mod from;

use std::fmt::{self, Display, Write as _};
use std::io;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use crate::files::{STDOUT, WriteError, print};
use crate::journal::JournalError;
use crate::life::MergeError;
use crate::provenance::sealed;
use crate::remark::remark;
use crate::study::{LIFE_FAILED, RUN_FAILED};
use clap::error::ErrorKind;
use linkwear_codegen::diagnostic::{Diagnostics, nearest};
use linkwear_codegen::input::NotUtf8;
use linkwear_gamma::FitFileError;
use linkwear_runtime::{RunError, what_and_cure};
use serde_json::{Value, json};

use super::answer::Answer;
use super::arguments::Format;
use super::colour;

/// The input or the run failed.
const FAILED: u8 = 1;
/// The command line is wrong.
const USAGE: u8 = 2;

/// Why a subcommand did not do what was asked. The constructors are the one table of codes of the command line.
#[derive(Debug)]
pub struct Failure {
    exit: u8,
    text: String,
    /// The text in colours, where it has more than its code.
    coloured: Option<String>,
    errors: Vec<Value>,
    /// What a life had lived before it stopped, if that is in no file.
    cycles: Option<Box<Answer>>,
}

impl Failure {
    fn new(code: &str, file: Option<&Path>, message: impl Display, help: impl Display) -> Self {
        Self::placed(code, (file, None), "", (message, help))
    }

    /// With a line of the file, from 1, if the fault has one; `place` shows it to people.
    fn placed(
        code: &str,
        (file, line): (Option<&Path>, Option<usize>),
        place: &str,
        (message, help): (impl Display, impl Display),
    ) -> Self {
        let (message, help) = (message.to_string(), help.to_string());
        let mut text = format!("error[{code}]: {message}{place}");
        if !help.is_empty() {
            let _ = write!(text, "\n  = help: {help}");
        }
        let error = json!({
            "code": code, "file": file.map(|file| file.display().to_string()),
            "line": line, "column": Value::Null, "message": message, "help": help,
        });
        Self { exit: FAILED, text, coloured: None, errors: vec![error], cycles: None }
    }

    /// Both, one after the other.
    pub fn and(mut self, other: Self) -> Self {
        self.text = format!("{}\n\n{}", self.text, other.text);
        self.errors.extend(other.errors);
        self
    }

    /// Two things that were asked for, or all that is wrong with them.
    pub fn both<A, B>(a: Result<A, Self>, b: Result<B, Self>) -> Result<(A, B), Self> {
        match (a, b) {
            (Ok(a), Ok(b)) => Ok((a, b)),
            (Err(a), Err(b)) => Err(a.and(b)),
            (Err(error), _) | (_, Err(error)) => Err(error),
        }
    }

    /// The arguments do not fit this mechanism or each other.
    pub fn usage(message: impl Display, help: impl Display) -> Self {
        Self { exit: USAGE, ..Self::new("C0001", None, message, help) }
    }

    /// An input has a value by `--set` and a column in the file of `--inputs`.
    pub fn set_over_time(name: &str) -> Self {
        let help = format!("delete its column in the file of --inputs, or leave `--set {name}` out");
        Self::usage(format!("the input `{name}` is set and given over time"), help)
    }

    /// A file cannot be read.
    pub fn read(file: &Path) -> impl FnOnce(io::Error) -> Self + '_ {
        move |error| {
            let message = format!("cannot read `{}`: {error}", file.display());
            let cause = error.get_ref().and_then(|cause| cause.downcast_ref::<NotUtf8>());
            if let Some(NotUtf8 { line, .. }) = cause {
                let help = "save it as UTF-8 text: editors and spreadsheets ask for the encoding";
                return Self::placed("C0002", (Some(file), Some(*line)), "", (message, help));
            }
            if error.kind() == io::ErrorKind::FileTooLarge {
                let (what, cure) = what_and_cure(&message);
                return Self::new("C0002", Some(file), what, cure);
            }
            let is_mechanism = file.extension().is_none_or(|extension| extension == "toml");
            let help = if file == Path::new("-") {
                "what a pipe brings is read as `/dev/stdin`"
            } else if is_mechanism {
                "check the path; shipped mechanisms are in `mechanisms/`"
            } else {
                "check the path"
            };
            Self::new("C0002", Some(file), message, help)
        }
    }

    /// A generated file is not what the mechanism gives, from this line on, counted from 1.
    pub fn stale(file: &Path, line: usize) -> Self {
        let message = format!("`{}` is stale: it differs from line {line} on", file.display());
        Self::placed("C0005", (Some(file), Some(line)), "", (message, "run the same command without --check"))
    }

    /// A name given on the command line does not exist.
    /// `listed` stand for those that are known, where none of these is near.
    pub fn unknown_name(what: &str, name: &str, known: &[String], listed: &[String]) -> Self {
        let message = format!("there is no {what} `{name}`");
        Self::new("C0006", None, message, suggestion(name, known, listed))
    }

    /// There is no such subcommand.
    pub fn no_subcommand(name: &str, known: &[String]) -> Self {
        Self::usage(format!("there is no subcommand `{name}`"), suggestion(name, known, known))
    }

    /// The simulation failed, or was stopped by Ctrl-C; the rows computed before may be in a file.
    pub fn run(file: &Path, error: &RunError, kept: Option<PathBuf>) -> Self {
        let kept = kept.map(|path| format!("the rows computed before that are in `{}`", path.display()));
        match error {
            RunError::Interrupted { t } => {
                let help = kept.unwrap_or_else(|| "a run begins anew".to_owned());
                Self::stopped(file, format_args!("stopped on request at t = {t} s"), help)
            }
            error => {
                let text = error.to_string();
                let (what, cure) = what_and_cure(&text);
                let help =
                    [Some(cure.to_owned()), kept].into_iter().flatten().filter(|part| !part.is_empty());
                Self::new(RUN_FAILED, Some(file), what, help.collect::<Vec<_>>().join("; "))
            }
        }
    }

    /// A life could not be lived to its end. Without other help, that of a run which failed.
    pub fn life(file: &Path, message: impl Display, help: impl Display) -> Self {
        let (text, help) = (message.to_string(), help.to_string());
        let (what, cure) = what_and_cure(&text);
        let (message, help) = if help.is_empty() { (what, cure) } else { (&*text, &*help) };
        Self::new(LIFE_FAILED, Some(file), message, help)
    }

    /// A life, a study or a search was stopped by Ctrl-C.
    pub fn stopped(file: &Path, message: impl Display, help: impl Display) -> Self {
        Self::new("C0009", Some(file), message, help)
    }

    /// With the cycles that a life had lived before, which are in no file.
    pub fn with_cycles(self, cycles: Answer) -> Self {
        Self { cycles: Some(Box::new(cycles)), ..self }
    }

    /// A file is there that linkwear did not make.
    pub fn foreign(file: &Path) -> Self {
        let message = format!("`{}` exists, and is not known to be made by linkwear", file.display());
        Self::new(
            "C0004",
            Some(file),
            message,
            "nothing was changed; choose another name, or replace it by --force",
        )
    }

    /// Nothing could be run at any point of a study.
    pub fn empty_study(file: Option<&Path>, message: impl Display, help: impl Display) -> Self {
        Self::new("C0015", file, message, help)
    }

    /// A parameter that is sought changes nothing of what was measured.
    pub fn no_influence(file: &Path, message: impl Display, help: impl Display) -> Self {
        Self::new("C0016", Some(file), message, help)
    }

    /// Steps of C know nothing of controllers that act at sampled times.
    pub fn samples_in_c(file: &Path) -> Self {
        let message = "steps of C know nothing of controllers that act at sampled times";
        let help = "take `sample_time` out of [controllers], so that they act all the time; or leave them to your program, which sets an input at its own samples; Rust and units of FMI (co-simulation) sample themselves";
        Self::new("C0017", Some(file), message, help)
    }

    /// A run that was interrupted cannot be gone on with.
    pub fn journal(error: JournalError) -> Self {
        let (file, help) = match &error {
            JournalError::Write(WriteError::Exists(folder)) => {
                let help = "choose another folder, or go on with the run that is there by --resume";
                return Self::new("C0004", Some(folder), &error, help);
            }
            JournalError::NoRun(folder) => {
                let help = "nothing was changed; give the folder of the run, or a new one to begin it there";
                return Self::new("C0004", Some(folder), &error, help);
            }
            JournalError::Write(WriteError::System { file, .. }) => {
                let help = "make room, or give a folder that exists and can be written; --resume goes on with what was finished before";
                return Self::new("C0003", Some(file), &error, help);
            }
            JournalError::InUse(file) => (file, "wait for its end, or choose another --out"),
            JournalError::Damaged { file, .. } => {
                (file, "nothing was changed; take the file from a copy, or begin again with another --out")
            }
            JournalError::OtherVersion { file, .. } => (
                file,
                "nothing was changed; go on with the program that wrote it, or begin again with another --out",
            ),
            JournalError::OtherRun { file, .. } => {
                (file, "give the file and the options of that run, or another --out")
            }
        };
        Self::new("C0013", Some(file), &error, help)
    }

    /// Shards cannot be put together.
    pub fn merge(error: MergeError) -> Self {
        let help = match &error {
            MergeError::NoShard { place, .. } => {
                let help = "give folders of `life --shard I/N --out DIR`, or files of `study --shard I/N --out FILE`";
                return Self::new("C0014", Some(place), &error, help);
            }
            MergeError::Journal(JournalError::OtherRun { file, what, was, is }) => {
                let message = format!(
                    "`{}` is of another study than the shards before it: {what} is {was} here, {is} there",
                    file.display()
                );
                let help = "merge shards of one study alone: same file, options, seed and version";
                return Self::new("C0014", Some(file), message, help);
            }
            MergeError::Journal(
                JournalError::Damaged { file, .. } | JournalError::OtherVersion { file, .. },
            ) => {
                return Self::new(
                    "C0014",
                    Some(file),
                    &error,
                    "make this shard anew, by the version that made the others",
                );
            }
            MergeError::Journal(JournalError::Write(WriteError::System { file, .. })) => {
                return Self::new("C0014", Some(file), &error, "check the folder");
            }
            MergeError::Journal(_) => String::new(),
            MergeError::Missing { command, .. } => command.as_ref().map_or_else(
                || "give all shards".to_owned(),
                |command| format!("make it by `{command}`, or give it too"),
            ),
            MergeError::Differ { second, .. } => {
                let help = "one of them is of another build: make both anew by the same program";
                return Self::new("C0014", Some(second), &error, help);
            }
            MergeError::Nothing => "give all shards".to_owned(),
        };
        Self::new("C0014", None, &error, help)
    }

    /// A file with data or results is wrong; at a line, counted from 1, if the fault has a place.
    pub fn data(file: &Path, line: Option<usize>, message: impl Display, help: impl Display) -> Self {
        // Other messages name their file.
        let at = line.map_or_else(String::new, |line| format!(":{line}"));
        let place = format!("\n  --> {}{at}", file.display());
        Self::placed("C0011", (Some(file), line), &place, (message, help))
    }

    /// A fit that is none, or does not do for what is asked.
    pub fn fit(file: &Path) -> impl Fn(FitFileError) -> Self + '_ {
        move |error| Self::data(file, error.line, &error.message, &error.cure)
    }

    /// What is wrong, as machines read it: objects of code, file, line, column, message and help.
    pub fn errors(&self) -> &[Value] {
        &self.errors
    }

    /// Whether the question is wrong; else the file, the data or the run.
    pub fn is_usage(&self) -> bool {
        self.exit == USAGE
    }

    fn in_colours(&self) -> String {
        self.coloured.clone().unwrap_or_else(|| colour::painted(&self.text))
    }

    /// Where to read more about the first of the faults; arguments are explained by their help.
    fn more(&self) -> String {
        let code = self.errors.first().and_then(|error| error["code"].as_str());
        let code = code.filter(|_| !self.is_usage());
        code.map_or_else(String::new, |code| format!("\n\nMore about {code}: linkwear explain {code}"))
    }

    /// Says it, and returns the exit code.
    pub fn report(&self, format: Format) -> ExitCode {
        match format {
            Format::Text => {
                let _ = self.cycles.as_ref().map(|cycles| cycles.print(format));
                let coloured = colour::wanted().then(|| self.in_colours());
                remark(&format_args!("{}{}", coloured.as_ref().unwrap_or(&self.text), self.more()));
            }
            Format::Json => {
                let mut answer = sealed(json!({ "errors": self.errors }), None);
                if let Some(cycles) = &self.cycles {
                    answer["cycles"] = cycles.json.clone();
                }
                // A reader of stdout who has gone away cannot be told; the exit code still says it.
                if let Err(full) = print(&answer) {
                    remark(&format_args!("{}\n\n{}", self.text, Self::from(full).text));
                }
            }
        }
        ExitCode::from(self.exit)
    }
}

impl Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl std::error::Error for Failure {}

fn suggestion(name: &str, known: &[String], listed: &[String]) -> String {
    match nearest(name, known.iter().map(String::as_str)) {
        Some(candidate) => format!("did you mean `{candidate}`?"),
        None => format!("there are: {}", listed.join(", ")),
    }
}

/// Diagnostics of the mechanism file as machines read them.
pub fn entries(diagnostics: &Diagnostics) -> Vec<Value> {
    diagnostics.entries().into_iter().map(|entry| json!(entry)).collect()
}

/// Warnings for machines: those of the file, then those of what was done with it, under one code.
pub fn warnings<T: Display>(of_file: &Diagnostics, code: &str, later: &[T]) -> Vec<Value> {
    remarks(entries(of_file), code, later)
}

/// The same, where those of the file are read already.
pub fn remarks<T: Display>(of_file: Vec<Value>, code: &str, later: &[T]) -> Vec<Value> {
    let later = later.iter().map(|warning| json!({ "code": code, "message": warning.to_string() }));
    of_file.into_iter().chain(later).collect()
}

/// Reports what clap says about arguments it could not read; help and version are not errors.
pub fn wrong_arguments(error: &clap::Error, format: Format) -> ExitCode {
    if format == Format::Text || !error.use_stderr() {
        let written = error.print();
        return match written {
            _ if error.use_stderr() => ExitCode::from(USAGE),
            // A reader who has gone away has seen enough, as in all answers.
            Err(full) if full.kind() != io::ErrorKind::BrokenPipe => {
                Failure::from(WriteError::of(Path::new(STDOUT))(full)).report(format)
            }
            _ => ExitCode::SUCCESS,
        };
    }
    unread_arguments(error).report(format)
}

/// What clap says: the message is its first paragraph in one line, the cure what follows (tips, usage, where to ask for more), and
/// before that the cure of a value that an option does not take.
pub(super) fn unread_arguments(error: &clap::Error) -> Failure {
    let text = error.render().to_string();
    if error.kind() == ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
        return Failure::usage("no subcommand given", text.trim_end());
    }
    let mut lines = text.lines();
    let what: Vec<&str> = lines.by_ref().map(str::trim).take_while(|line| !line.is_empty()).collect();
    let what = what.join(" ");
    let what = what.trim_start_matches("error: ");
    let rest = lines.collect::<Vec<_>>().join("\n").trim().to_owned();
    // Of a value the cause stands behind the option; a value may have any characters.
    let cause =
        what.rfind("': ").filter(|_| error.kind() == ErrorKind::ValueValidation).unwrap_or(what.len());
    match what_and_cure(&what[cause..]) {
        (_, "") => Failure::usage(what, rest),
        (cause_alone, cure) => {
            Failure::usage(&what[..cause + cause_alone.len()], format!("{cure}\n\n{rest}"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_near_name_is_suggested_and_a_far_one_lists_all() {
        let known = ["closure".to_owned(), "phi".to_owned()];
        assert_eq!(suggestion("closrue", &known, &known), "did you mean `closure`?");
        assert_eq!(suggestion("torque", &known, &known), "there are: closure, phi");
    }
}
