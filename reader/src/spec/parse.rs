//! From the text of a file to [`Spec`]. Faults in single values do not stop it: they wait in the
//! [`Spec`] until the resolver has found the others, so that a user sees all at once.

use toml::Spanned;
use toml::de::DeTable;

use super::file::File;
use super::not_toml::syntax_errors;
use super::read;
use crate::diagnostic::{Code, Diagnostic, Diagnostics, nearest};
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
    let says_version = said_version(&document);
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

/// Whether a file says its version: by `spec`, or by a key that is this one misspelt, which is where.
#[derive(Clone, Copy)]
pub(super) enum SaidVersion {
    Yes,
    Misspelt(Span),
    No,
}

pub(super) fn said_version(document: &Spanned<DeTable<'_>>) -> SaidVersion {
    let keys = || document.get_ref().iter().map(|(key, _)| key);
    if keys().any(|key| key.get_ref() == "spec") {
        return SaidVersion::Yes;
    }
    let near = keys().find(|key| nearest(key.get_ref(), ["spec"]).is_some());
    near.map_or(SaidVersion::No, |key| SaidVersion::Misspelt(key.span().into()))
}

/// A `spec` that is no number is among the problems already. `begin`: of the file.
pub(super) fn version_problem(file: &File, said: SaidVersion, begin: Span) -> Option<Diagnostic> {
    let wrong = |message: String| Diagnostic::new(Code::SpecVersion, message);
    match &file.spec {
        Some(version) if version.value == VERSION => None,
        Some(version) => Some(
            wrong(format!("the file is of format {}, this program reads format {VERSION}", version.value))
                .at(version.span, "")
                .help("update linkwear, or write `spec = 1` and follow docs/spec-reference.md"),
        ),
        None => match said {
            SaidVersion::Yes => None,
            SaidVersion::Misspelt(key) => Some(
                wrong("the file does not say which format it is in".into())
                    .at(key, "")
                    .help("did you mean `spec`? write `spec = 1`"),
            ),
            SaidVersion::No => Some(
                wrong("the file does not say which format it is in".into())
                    .at(begin, "")
                    .help("put `spec = 1` in the first line"),
            ),
        },
    }
}
