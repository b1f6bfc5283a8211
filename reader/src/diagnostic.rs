//! Errors and warnings about a file: what is wrong, where, why, and what to do about it.
//! In: [`crate::source`]. Out: [`Diagnostic`] and the collector [`Diagnostics`]. Never knows mechanics.

use crate::source::Span;

mod brief;
mod code;
mod collector;
mod explanation;
mod render;

pub use brief::{bounded, brief, cut};
pub use code::{Code, Severity};
pub use collector::{Diagnostics, Entry};
pub use explanation::Explanation;

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
#[must_use]
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
    pub fn at(mut self, span: Span, text: impl Into<String>) -> Self {
        self.labels.push(Label { span, text: text.into(), primary: true });
        self
    }

    /// Adds several places of the fault.
    pub fn at_each(self, spans: impl IntoIterator<Item = Span>, text: &str) -> Self {
        spans.into_iter().fold(self, |diagnostic, span| diagnostic.at(span, text))
    }

    /// Adds a related place.
    pub fn also(mut self, span: Span, text: impl Into<String>) -> Self {
        self.labels.push(Label { span, text: text.into(), primary: false });
        self
    }

    /// Adds advice.
    pub fn help(mut self, text: impl Into<String>) -> Self {
        self.help.push(text.into());
        self
    }

    /// Adds "did you mean" if one of `known` is close to `wrong`.
    pub fn did_you_mean<'a>(self, wrong: &str, known: impl IntoIterator<Item = &'a str>) -> Self {
        match nearest(wrong, known) {
            Some(name) => self.help(format!("did you mean `{name}`?")),
            None => self,
        }
    }

    /// Where the fault is, if anywhere.
    pub fn span(&self) -> Option<Span> {
        self.labels.iter().find(|label| label.primary).map(|label| label.span)
    }
}

/// Names that are compared: a thousand faults in a file of thousands of names are told in a moment, too.
const COMPARED: usize = 1000;

/// The known name that a person most likely meant, if any is close.
pub fn nearest<'a>(wrong: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let folded = wrong.to_lowercase();
    let mut best: Option<(usize, &str)> = None;
    // A third of the letters may be wrong: more is a guess, not help.
    let may_be_close = |name: &&str| {
        let (shorter, longer) = (name.len().min(wrong.len()), name.len().max(wrong.len()));
        (longer - shorter) * 3 <= longer.max(3)
    };
    for name in known.into_iter().filter(may_be_close).take(COMPARED) {
        let distance = slips(&folded, &name.to_lowercase());
        let longest = wrong.chars().count().max(name.chars().count());
        // Of a name of one letter nothing is left when that is wrong.
        let close = distance * 3 <= longest.max(3) && distance < longest;
        if close && best.is_none_or(|(least, _)| distance < least) {
            best = Some((distance, name));
        }
    }
    best.map(|(_, name)| name)
}

/// Letters that are wrong, missing, too many or exchanged with the next one: the distance of optimal string alignment. A crate for it
/// would be one more that every embedder builds.
fn slips(one: &str, other: &str) -> usize {
    let other: Vec<char> = other.chars().collect();
    let first: Vec<usize> = (0..=other.len()).collect();
    // The row before the last one, the last one and its letter.
    let (mut above, mut last, mut letter) = (first.clone(), first, None);
    for (i, own) in one.chars().enumerate() {
        let mut row = vec![i + 1];
        for (j, theirs) in other.iter().enumerate() {
            let mut least = (last[j] + usize::from(own != *theirs)).min(last[j + 1] + 1).min(row[j] + 1);
            if j > 0 && own == other[j - 1] && letter == Some(*theirs) {
                least = least.min(above[j - 1] + 1);
            }
            row.push(least);
        }
        (above, last, letter) = (last, row, Some(own));
    }
    last.last().copied().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_are_counted_each_once() {
        for (one, other, number) in [
            ("", "", 0),
            ("", "abc", 3),
            ("abc", "", 3),
            ("crank", "crank", 0),
            ("crnak", "crank", 1),
            ("kitten", "sitting", 3),
            ("ab", "ba", 1),
            ("ca", "abc", 3),
            ("\u{b5}m", "um", 1),
        ] {
            assert_eq!(slips(one, other), number, "{one} {other}");
        }
    }

    #[test]
    fn nearest_name_forgives_a_slip_but_not_another_word() {
        assert_eq!(nearest("crnak", ["coupler", "crank"]), Some("crank"));
        assert_eq!(nearest("rocker", ["coupler", "crank"]), None);
        assert_eq!(nearest("x", ["y", "xx"]), Some("xx"));
        assert_eq!(nearest("b", ["O", "B"]), Some("B"));
    }
}
