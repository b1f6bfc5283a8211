//! Errors and warnings about a file: what is wrong, where, why, and what to do about it.
//! In: [`crate::source`]. Out: [`Diagnostic`] and the collector [`Diagnostics`]. Never knows mechanics.

use std::fmt;

use serde::Serialize;

use crate::source::{SourceFile, Span};

mod code;
mod render;

pub use code::{Code, Severity};

/// A place in the file with what there is to say about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label {
    /// Where.
    pub span: Span,
    /// A few words; may be empty.
    pub text: String,
    /// The place of the fault itself, not just something related.
    pub primary: bool,
}

/// One error or warning.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Which fault.
    pub code: Code,
    /// Error or warning.
    pub severity: Severity,
    /// One sentence without a full stop.
    pub message: String,
    /// Places, the primary one first.
    pub labels: Vec<Label>,
    /// What to do about it.
    pub help: Vec<String>,
}

impl Diagnostic {
    /// A diagnostic without a place yet.
    #[must_use]
    pub fn new(code: Code, message: impl Into<String>) -> Self {
        Self {
            code,
            severity: code.severity(),
            message: message.into(),
            labels: Vec::new(),
            help: Vec::new(),
        }
    }

    /// Adds the place of the fault.
    #[must_use]
    pub fn at(mut self, span: Span, text: impl Into<String>) -> Self {
        self.labels.push(Label { span, text: text.into(), primary: true });
        self
    }

    /// Adds a related place.
    #[must_use]
    pub fn also(mut self, span: Span, text: impl Into<String>) -> Self {
        self.labels.push(Label { span, text: text.into(), primary: false });
        self
    }

    /// Adds advice.
    #[must_use]
    pub fn help(mut self, text: impl Into<String>) -> Self {
        self.help.push(text.into());
        self
    }

    /// Adds "did you mean" if one of `known` is close to `wrong`.
    #[must_use]
    pub fn did_you_mean<'a>(self, wrong: &str, known: impl IntoIterator<Item = &'a str>) -> Self {
        match nearest(wrong, known) {
            Some(name) => self.help(format!("did you mean `{name}`?")),
            None => self,
        }
    }

    /// Where the fault is, if anywhere.
    #[must_use]
    pub fn span(&self) -> Option<Span> {
        self.labels.iter().find(|label| label.primary).map(|label| label.span)
    }
}

/// The known name that a person most likely meant, if any is close.
#[must_use]
pub fn nearest<'a>(wrong: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let folded = wrong.to_lowercase();
    let mut best: Option<(usize, &str)> = None;
    for name in known {
        let distance = strsim::osa_distance(&folded, &name.to_lowercase());
        // A third of the letters may be wrong: more is a guess, not help.
        let close = distance * 3 <= wrong.chars().count().max(name.chars().count()).max(3);
        if close && best.is_none_or(|(least, _)| distance < least) {
            best = Some((distance, name));
        }
    }
    best.map(|(_, name)| name)
}

/// All that is wrong with a file, in the order of the file once located.
#[derive(Clone, Debug, Default)]
pub struct Diagnostics {
    list: Vec<Diagnostic>,
    source: Option<SourceFile>,
}

/// One diagnostic as machines read it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Entry {
    /// Code, e.g. `E0204`.
    pub code: &'static str,
    /// File as the user named it.
    pub file: String,
    /// Line from 1.
    pub line: usize,
    /// Column from 1, in characters.
    pub column: usize,
    /// What is wrong.
    pub message: String,
    /// What to do about it.
    pub help: String,
}

impl Diagnostics {
    /// An empty collector.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// A collector that holds `list`.
    #[must_use]
    pub fn from_list(list: Vec<Diagnostic>) -> Self {
        Self { list, source: None }
    }

    /// Adds one.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        self.list.push(diagnostic);
    }

    /// Says which file the spans belong to, and sorts by place.
    #[must_use]
    pub fn located(mut self, source: &SourceFile) -> Self {
        self.source = Some(source.clone());
        self.list.sort_by_key(|diagnostic| diagnostic.span().map_or(usize::MAX, |span| span.start));
        self
    }

    /// The diagnostics.
    #[must_use]
    pub fn list(&self) -> &[Diagnostic] {
        &self.list
    }

    /// Whether there is nothing to say.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Whether any of them is an error.
    #[must_use]
    pub fn has_errors(&self) -> bool {
        self.list.iter().any(|diagnostic| diagnostic.severity == Severity::Error)
    }

    /// The same as data, for `--format json`. A fault without a place is put at line 1, column 1.
    #[must_use]
    pub fn entries(&self) -> Vec<Entry> {
        let entry = |diagnostic: &Diagnostic| {
            let start = diagnostic.span().map_or(0, |span| span.start);
            let (line, column) = self.source.as_ref().map_or((1, 1), |source| source.line_column(start));
            Entry {
                code: diagnostic.code.as_str(),
                file: self.source.as_ref().map_or(String::new(), |source| source.name.clone()),
                line,
                column,
                message: diagnostic.message.clone(),
                help: diagnostic.help.join("; "),
            }
        };
        self.list.iter().map(entry).collect()
    }
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (position, diagnostic) in self.list.iter().enumerate() {
            if position > 0 {
                formatter.write_str("\n\n")?;
            }
            formatter.write_str(&render::plain(diagnostic, self.source.as_ref()))?;
        }
        Ok(())
    }
}

impl std::error::Error for Diagnostics {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearest_name_forgives_a_slip_but_not_another_word() {
        assert_eq!(nearest("crnak", ["coupler", "crank"]), Some("crank"));
        assert_eq!(nearest("rocker", ["coupler", "crank"]), None);
        assert_eq!(nearest("x", ["y", "xx"]), Some("y"));
    }

    #[test]
    fn entries_count_lines_and_characters_from_one() {
        let source = SourceFile { name: "a.toml".into(), text: "x = 1\nµ = y\n".into() };
        let mut all = Diagnostics::new();
        all.push(
            Diagnostic::new(Code::UnknownName, "no `y`")
                .at(Span { start: 11, end: 12 }, "")
                .help("h1")
                .help("h2"),
        );
        let entry = &all.located(&source).entries()[0];
        assert_eq!((entry.line, entry.column), (2, 5));
        assert_eq!((entry.code, entry.help.as_str()), ("E0204", "h1; h2"));
    }

    #[test]
    fn a_file_is_shown_in_the_order_of_its_text() {
        let source = SourceFile { name: "a.toml".into(), text: "abcdef".into() };
        let mut all = Diagnostics::new();
        all.push(Diagnostic::new(Code::ZeroAxis, "second").at(Span { start: 3, end: 4 }, ""));
        all.push(Diagnostic::new(Code::ZeroAxis, "first").at(Span { start: 1, end: 2 }, ""));
        let all = all.located(&source);
        assert_eq!(all.list()[0].message, "first");
    }
}
