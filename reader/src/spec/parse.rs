//! From the text of a file to [`Spec`]. Faults in single values do not stop it: they wait in the
//! [`Spec`] until the resolver has found the others, so that a user sees all at once.

use std::collections::HashSet;

use toml::de::DeTable;

use super::file::File;
use super::read;
use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::source::{SourceFile, Span};

/// The version of the format that this program reads.
const VERSION: i64 = 1;

/// A file as written.
#[derive(Clone, Debug)]
pub struct Spec {
    /// The text and its name.
    pub source: SourceFile,
    /// The tables.
    pub file: File,
    /// Unknown keys and values of the wrong type; reported by the resolver together with what it finds.
    pub problems: Vec<Diagnostic>,
    /// Values left out because of `problems`.
    pub skipped: Vec<Span>,
    /// Names of what was left out.
    pub lost: Vec<String>,
}

/// Reads a file.
///
/// # Errors
/// If it is not TOML, or of another version of the format.
pub fn parse(source: &SourceFile) -> Result<Spec, Diagnostics> {
    let (document, errors) = DeTable::parse_recoverable(&source.text);
    if !errors.is_empty() {
        return Err(Diagnostics::from_list(syntax_errors(source, &errors)).located(source));
    }
    let says_version = document.get_ref().iter().any(|(key, _)| key.get_ref() == "spec");
    let (file, notes) = read::read::<File>(document);
    if let Some(problem) = version_problem(&file, says_version, Span::default()) {
        return Err(Diagnostics::from_list(vec![problem]).located(source));
    }
    Ok(Spec {
        source: source.clone(),
        file,
        problems: notes.diagnostics,
        skipped: notes.skipped.into_iter().collect(),
        lost: notes.lost,
    })
}

/// At most one error a line: what follows in a line is usually caused by the first.
pub(super) fn syntax_errors(source: &SourceFile, errors: &[toml::de::Error]) -> Vec<Diagnostic> {
    let ends: Vec<usize> = source.text.match_indices('\n').map(|(at, _)| at).collect();
    let mut seen = HashSet::new();
    let mut list = Vec::new();
    for error in errors {
        let span = error.span().map_or(Span::default(), Span::from);
        let line = ends.partition_point(|end| *end < span.start);
        if !seen.insert(line) {
            continue;
        }
        let twice = error.message().contains("duplicate key");
        let name = source.text.get(span.start..span.end).filter(|name| twice && !name.is_empty());
        let (message, help) = match name {
            Some(name) => {
                let name = name.rsplit('.').next().unwrap_or(name).trim_matches(['"', '\'', '[', ']']);
                (
                    format!("the key `{name}` stands twice in one table"),
                    "keep one of the two, or give the other a name of its own",
                )
            }
            None => (
                format!("this is not TOML: {}", error.message()),
                "quantities and formulas stand in quotes: `L1 = \"120 mm\"`; names of points in lists too",
            ),
        };
        list.push(Diagnostic::new(Code::NotToml, message).at(span, "").help(help));
    }
    list
}

/// A `spec` that is no number is among the problems already. `begin`: of the file.
pub(super) fn version_problem(file: &File, written: bool, begin: Span) -> Option<Diagnostic> {
    let wrong = |message: String| Diagnostic::new(Code::SpecVersion, message);
    match &file.spec {
        Some(version) if version.value == VERSION => None,
        Some(version) => Some(
            wrong(format!("the file is of format {}, this program reads format {VERSION}", version.value))
                .at(version.span, "")
                .help("update linkwear, or write `spec = 1` and follow docs/spec-reference.md"),
        ),
        None if written => None,
        None => Some(
            wrong("the file does not say which format it is in".into())
                .at(begin, "")
                .help("put `spec = 1` in the first line"),
        ),
    }
}
