//! Diagnostics as text with the lines of the file they are about.
//! In: one [`Diagnostic`] and, if known, its file. Out: text, plain or in colours, without a final newline.

use annotate_snippets::{AnnotationKind, Element, Group, Level, Renderer, Snippet};

use super::brief::bounded;
use super::{Diagnostic, Severity};
use crate::source::SourceFile;

pub(super) fn text(diagnostic: &Diagnostic, source: Option<&SourceFile>, renderer: &Renderer) -> String {
    let level = match diagnostic.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
    };
    let (message, helps) = (bounded(&diagnostic.message), diagnostic.help.iter().map(|help| bounded(help)));
    let helps: Vec<String> = helps.collect();
    let mut group: Group<'_> = level
        .primary_title(message.as_str())
        .id(diagnostic.code.as_str())
        .elements(Vec::<Element<'_>>::new());
    if let Some(source) = source {
        let annotations = diagnostic.labels.iter().map(|label| {
            let kind = if label.primary { AnnotationKind::Primary } else { AnnotationKind::Context };
            let end = label.span.end.min(source.text.len());
            let span = kind.span(label.span.start.min(end)..end);
            if label.text.is_empty() { span } else { span.label(label.text.as_str()) }
        });
        if !diagnostic.labels.is_empty() {
            let snippet = Snippet::source(source.text.as_str()).path(source.name.as_str());
            group = group.element(snippet.annotations(annotations));
        } else {
            group = group.element(annotate_snippets::Origin::path(source.name.as_str()));
        }
    }
    for help in &helps {
        group = group.element(Level::HELP.message(help.as_str()));
    }
    renderer.render(&[group])
}
