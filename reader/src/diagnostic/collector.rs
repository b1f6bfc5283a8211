//! Everything there is to say about one file, as text and as data.

use std::collections::HashSet;
use std::fmt;

use annotate_snippets::Renderer;
use serde::Serialize;

use super::brief::bounded;
use super::code::Severity;
use super::render;
use crate::diagnostic::{Diagnostic, Label};
use crate::source::{SourceFile, Sources, Span};

/// Faults that are shown as text: more than anybody reads.
const SHOWN: usize = 100;
/// Faults that are given as data.
const LISTED: usize = 1_000;

/// All that is wrong with a file, in the order of the file once located.
#[derive(Clone, Debug, Default)]
#[must_use]
pub struct Diagnostics {
    list: Vec<Diagnostic>,
    source: Option<SourceFile>,
    /// With the files that it includes, if it does.
    sources: Option<Box<Sources>>,
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
    /// What to do about it, or what is said at the place.
    pub help: String,
}

impl Diagnostics {
    /// An empty collector.
    pub fn new() -> Self {
        Self::default()
    }

    /// A collector that holds `list`.
    pub fn from_list(list: Vec<Diagnostic>) -> Self {
        Self { list, source: None, sources: None }
    }

    /// Adds one.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        self.list.push(diagnostic);
    }

    /// Says which file the spans belong to, and sorts by place. What is said twice of one place, as of the edge of a
    /// square, which is both of its edges, is said once.
    pub fn located(mut self, source: &SourceFile) -> Self {
        self.source = Some(source.clone());
        let mut said = HashSet::new();
        self.list.retain(|diagnostic| {
            said.insert((diagnostic.code, diagnostic.span(), diagnostic.message.clone()))
        });
        self.list.sort_by_key(|diagnostic| diagnostic.span().map_or(usize::MAX, |span| span.start));
        self
    }

    /// As [`Self::located`], where the places are in a file and those that it includes.
    pub fn located_in(mut self, sources: &Sources) -> Self {
        self.sources = sources.has_parts().then(|| Box::new(sources.clone()));
        self.located(sources.whole())
    }

    /// The diagnostic in the file that it is about; what it says of other files is advice there.
    fn in_its_file(&self, diagnostic: &Diagnostic) -> (Diagnostic, Option<SourceFile>) {
        let Some(sources) = &self.sources else { return (diagnostic.clone(), self.source.clone()) };
        let (file, start) = sources.file_at(diagnostic.span().map_or(0, |span| span.start));
        let mut own = Diagnostic { labels: Vec::new(), ..diagnostic.clone() };
        for label in &diagnostic.labels {
            let (other, begin) = sources.file_at(label.span.start);
            if begin == start {
                let span =
                    Span { start: label.span.start - start, end: label.span.end.saturating_sub(start) };
                own.labels.push(Label { span, ..label.clone() });
            } else {
                let (line, _) = other.line_column(label.span.start - begin);
                own.help.push(format!(
                    "{}:{line}: {}",
                    other.name,
                    if label.text.is_empty() { "see here" } else { &label.text }
                ));
            }
        }
        (own, Some(file))
    }

    /// The diagnostics.
    pub fn list(&self) -> &[Diagnostic] {
        &self.list
    }

    /// Whether there is nothing to say.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Whether any of them is an error.
    pub fn has_errors(&self) -> bool {
        self.list.iter().any(|diagnostic| diagnostic.severity == Severity::Error)
    }

    /// The first thousand as data, for `--format json`. A fault without a place is put at line 1, column 1.
    pub fn entries(&self) -> Vec<Entry> {
        let entry = |diagnostic: &Diagnostic| {
            let (diagnostic, source) = self.in_its_file(diagnostic);
            let start = diagnostic.span().map_or(0, |span| span.start);
            let label = diagnostic.labels.first().map_or("", |label| &label.text);
            let help = if diagnostic.help.is_empty() { label.to_owned() } else { diagnostic.help.join("; ") };
            let (line, column) = source.as_ref().map_or((1, 1), |source| source.line_column(start));
            Entry {
                code: diagnostic.code.as_str(),
                file: source.map_or(String::new(), |source| source.name),
                line,
                column,
                message: bounded(&diagnostic.message),
                help: bounded(&help),
            }
        };
        self.list.iter().take(LISTED).map(entry).collect()
    }
}

impl Diagnostics {
    /// The text of [`Display`](fmt::Display) in colours, for terminals.
    pub fn in_colours(&self) -> String {
        self.text(&Renderer::styled())
    }

    fn text(&self, renderer: &Renderer) -> String {
        let shown = self.list.iter().take(SHOWN);
        let texts = shown.map(|diagnostic| {
            let (diagnostic, source) = self.in_its_file(diagnostic);
            render::text(&diagnostic, source.as_ref(), renderer)
        });
        let text = texts.collect::<Vec<_>>().join("\n\n");
        match self.list.len().saturating_sub(SHOWN) {
            0 => text,
            more => format!("{text}\n\n... and {more} more: {} faults in all", self.list.len()),
        }
    }
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.text(&Renderer::plain()))
    }
}

impl std::error::Error for Diagnostics {}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnostic::Code;

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
    fn colours_change_no_letter() {
        let source = SourceFile { name: "a.toml".into(), text: "abc = \u{1b}[31m".into() };
        let mut all = Diagnostics::new();
        all.push(
            Diagnostic::new(Code::ZeroAxis, "no axis").at(Span { start: 0, end: 3 }, "here").help("add it"),
        );
        let all = all.located(&source);
        let (plain, coloured) = (all.to_string(), all.in_colours());
        assert!(!plain.contains('\u{1b}') && coloured.contains("\u{1b}["), "{coloured:?}");
        let mut rest = coloured.as_str();
        let mut bare = String::new();
        while let Some((before, after)) = rest.split_once("\u{1b}[") {
            bare.push_str(before);
            rest = after.split_once('m').expect("the end of a style").1;
        }
        assert_eq!(bare + rest, plain);
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
