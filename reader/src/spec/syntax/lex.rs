//! A formula's text as tokens. In: text. Out: tokens with byte ranges.

use std::ops::Range;

use super::expression::{Relation, SyntaxError, fault};

/// What a token is.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Kind {
    /// A number, not yet with its unit.
    Number(f64),
    /// A name, a unit or a function.
    Word(String),
    /// One of `+-*/^(),.`
    Mark(char),
    /// A comparison.
    Relation(Relation),
}

/// A token and its place.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Token {
    /// What it is.
    pub kind: Kind,
    /// Where it stands.
    pub range: Range<usize>,
}

/// Takes the text apart.
pub(super) fn tokens(text: &str) -> Result<Vec<Token>, SyntaxError> {
    let mut tokens = Vec::new();
    let mut at = 0;
    while let Some(next) = text[at..].chars().next() {
        let start = at;
        let kind = if next.is_whitespace() {
            at += next.len_utf8();
            continue;
        } else if next.is_ascii_digit() || (next == '.' && digit_follows(text, at + 1)) {
            at = number_end(text, at);
            Kind::Number(number(text, start..at)?)
        } else if next.is_alphabetic() || next == '_' || next == '%' {
            at = word_end(text, at);
            Kind::Word(text[start..at].to_owned())
        } else if "+-*/^(),.".contains(next) {
            at += 1;
            Kind::Mark(next)
        } else if let Some(relation) = relation(&text[at..]) {
            at += if matches!(relation, Relation::Less | Relation::Greater) { 1 } else { 2 };
            Kind::Relation(relation)
        } else {
            let message = format!("`{next}` has no meaning in a formula");
            return Err(fault(message, start..start + next.len_utf8()).advise(in_place_of(next)));
        };
        tokens.push(Token { kind, range: start..at });
    }
    Ok(tokens)
}

/// What to write for a character that no formula has.
fn in_place_of(character: char) -> &'static str {
    match character {
        '=' | '!' => "two sides are compared by `<`, `<=`, `>` or `>=`, as in `if(t < 1 s, 0, 1)`",
        '&' | '|' | '?' | ':' => {
            "cases are told apart by `if(a < b, then, else)`, one in another where there are more"
        }
        '#' => "a comment stands behind the closing quote, or on a line of its own",
        '"' | '\'' | '`' => "names and units stand in a formula as they are, without quotes of their own",
        '[' | ']' | '{' | '}' => "brackets in a formula are round, `(` and `)`",
        '×' | '·' | '∙' | '⋅' => "a product is written with `*`",
        '÷' => "a quotient is written with `/`",
        '−' | '–' | '—' => "write the minus of the keyboard, `-`",
        '°' => "an angle in degrees is written `30 deg`",
        '²' | '³' => "powers are written with `^`, as in `x^2`",
        '√' => "a root is written `sqrt(x)`",
        ';' => "arguments are separated by commas, and a number has a point: `max(1.5, 2)`",
        _ => {
            "a formula has numbers with units, names, functions, `+ - * / ^`, round brackets and comparisons"
        }
    }
}

/// The comparison that a text begins with.
fn relation(text: &str) -> Option<Relation> {
    let known = [
        ("<=", Relation::AtMost),
        (">=", Relation::AtLeast),
        ("<", Relation::Less),
        (">", Relation::Greater),
    ];
    known.into_iter().find(|(mark, _)| text.starts_with(mark)).map(|(_, relation)| relation)
}

fn number(text: &str, range: Range<usize>) -> Result<f64, SyntaxError> {
    match text[range.clone()].parse() {
        Ok(value) if f64::is_finite(value) => Ok(value),
        _ => {
            let message = format!("`{}` is not a number that a computer can hold", &text[range.clone()]);
            Err(fault(message, range).advise("the largest number is 1.8e308"))
        }
    }
}

fn digit_follows(text: &str, at: usize) -> bool {
    text.as_bytes().get(at).is_some_and(u8::is_ascii_digit)
}

/// Digits, a point, digits, and an exponent only if digits follow: `2 e` is no exponent.
fn number_end(text: &str, start: usize) -> usize {
    let bytes = text.as_bytes();
    let digits = |mut at: usize| {
        while digit_follows(text, at) {
            at += 1;
        }
        at
    };
    let mut at = digits(start);
    if bytes.get(at) == Some(&b'.') {
        at = digits(at + 1);
    }
    if matches!(bytes.get(at), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(at + 1), Some(b'+' | b'-')));
        if digit_follows(text, at + 1 + sign) {
            at = digits(at + 1 + sign);
        }
    }
    at
}

fn word_end(text: &str, start: usize) -> usize {
    if text[start..].starts_with('%') {
        return start + 1;
    }
    let length = text[start..].find(|c: char| !(c.is_alphanumeric() || c == '_'));
    length.map_or(text.len(), |length| start + length)
}
