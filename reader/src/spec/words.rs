//! Names in the text of a formula, and names that a group makes. In: a text. Out: where names stand in it. Never knows what they are of.

use super::syntax::{Expression, Form};

/// Stands for the braces of a name that a group makes.
const BRACES: char = '\u{1}';

/// Where names stand in a formula, as far as they reach before a member; the member that follows.
pub(super) fn roots(text: &str, expression: &Expression, found: &mut Vec<(usize, String, Option<String>)>) {
    // The range of what stands in brackets is that of the brackets.
    let start = expression.range.start;
    let at = text[start..]
        .find(|letter: char| letter != '(' && !letter.is_whitespace())
        .map_or(start, |more| start + more);
    match &expression.form {
        Form::Number { .. } => {}
        Form::Name(name) => found.push((at, name.clone(), None)),
        Form::Member(name, member) => found.push((at, name.clone(), Some(member.clone()))),
        Form::Neg(inner) | Form::Power(inner, _) => roots(text, inner, found),
        Form::Binary(_, left, right) => {
            roots(text, left, found);
            roots(text, right, found);
        }
        Form::Call(name, arguments) => {
            found.push((at, name.clone(), None));
            arguments.iter().for_each(|argument| roots(text, argument, found));
        }
        Form::Compare(_, both) => both.iter().for_each(|side| roots(text, side, found)),
    }
}

/// The same of a formula with braces, which is none before they are replaced: words with their braces that follow neither a number, as
/// units do, nor a point, as members do.
pub(super) fn words(text: &str) -> Vec<(usize, String, Option<String>)> {
    let mut found = Vec::new();
    let mut at = 0;
    let mut before = ' ';
    while let Some(next) = text[at..].chars().next() {
        if next == '{' {
            // What stands there is no name of the file, and what follows is a unit as behind a number.
            at = text[at..].find('}').map_or(text.len(), |end| at + end + 1);
            before = '0';
            continue;
        }
        if !(next.is_alphabetic() || next == '_') {
            if !next.is_whitespace() {
                before = next;
            }
            at += next.len_utf8();
            continue;
        }
        let mut inside = false;
        let length = text[at..].find(|letter: char| {
            inside = (inside || letter == '{') && letter != '}';
            !(inside || letter == '}' || letter.is_alphanumeric() || letter == '_')
        });
        let end = length.map_or(text.len(), |length| at + length);
        if before != '.' && !before.is_ascii_digit() {
            let member = text[end..].strip_prefix('.').map(str::to_owned);
            found.push((at, text[at..end].to_owned(), member));
        }
        before = 'a';
        at = end;
    }
    found
}

/// A name with every `{..}` as one letter.
pub(super) fn without_braces(name: &str) -> String {
    let mut result = String::new();
    let mut rest = name;
    while let Some((before, after)) = rest.split_once('{') {
        let Some((_, behind)) = after.split_once('}') else { break };
        result.push_str(before);
        result.push(BRACES);
        rest = behind;
    }
    result + rest
}

pub(super) fn fits_one(patterns: &[String], word: &str) -> bool {
    let word = without_braces(word);
    patterns.iter().any(|pattern| *pattern == word || fits(pattern, &word))
}

/// Whether a name is one that a pattern makes.
fn fits(pattern: &str, word: &str) -> bool {
    let Some((before, after)) = pattern.split_once(BRACES) else { return pattern == word };
    let Some(rest) = word.strip_prefix(before) else { return false };
    let digits = rest.bytes().take_while(u8::is_ascii_digit).count();
    (1..=digits).any(|end| fits(after, &rest[end..]))
}
