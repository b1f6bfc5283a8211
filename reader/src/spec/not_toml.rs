//! What the TOML parser refuses, said with what to do about it.

use std::collections::HashSet;

use toml::de::Error;

use crate::diagnostic::{Code, Diagnostic};
use crate::source::{SourceFile, Span};

/// What the parser's message has in it, and the cure; the first that fits counts.
const CURES: &[(&str, &str)] = &[
    ("must be quoted", QUOTES),
    ("opening quote", QUOTES),
    ("invalid float", QUOTES),
    ("invalid integer", QUOTES),
    (
        "between array elements",
        "write a comma between two entries, and a quote at both ends of each text; a list ends with `]`",
    ),
    ("between key-value pairs, expected `,`", "write a comma between two entries; a table ends with `}`"),
    (
        "between key-value pairs, expected `=`",
        "write `key = value`; the text before may lack the quote that ends it",
    ),
    ("unclosed table", "a heading ends with `]`: `[points]`"),
    ("unclosed inline table", "write `}` behind the last entry of the table"),
    ("inline table", "a table is `{ key = value, key = value }`, a list `[1, 2]`"),
    ("unclosed array table", "a heading has one `[` before its name and one `]` behind it: `[points]`"),
    ("unclosed array", "write `]` behind the last entry of the list"),
    ("key with no value", "an entry is `key = value`, a heading `[points]`, a comment begins with `#`"),
    ("unquoted key", "names have letters a to z and A to Z, digits and `_`"),
    ("basic string", "a text ends in its line, with the quote it began with"),
    ("literal string", "a text ends in its line, with the quote it began with"),
    ("escape", "a backslash in a text is written twice, or the text stands in single quotes, `'..'`"),
    ("boolean", "write `true` or `false`, in small letters"),
    ("leading zero", NUMBER),
    ("mantissa", NUMBER),
    ("fraction", NUMBER),
    ("exponent", NUMBER),
];

const QUOTES: &str =
    "quantities and formulas stand in quotes: `L1 = \"120 mm\"`; names of points in lists too";

const NUMBER: &str =
    "write a number as `0.5`, `5.0` or `1e-3`: digits on both sides of the point, no zero before others";

const OTHERWISE: &str =
    "one entry stands in a line, `key = value`; what else is in it is a comment behind `#`";

/// At most one error a line: what follows in a line is usually caused by the first.
pub(super) fn syntax_errors(source: &SourceFile, errors: &[Error]) -> Vec<Diagnostic> {
    let text = source.text.as_str();
    let ends: Vec<usize> = text.match_indices('\n').map(|(at, _)| at).collect();
    let mut seen = HashSet::new();
    let mut list = Vec::new();
    let mut tell = |span: Span, told: &dyn Fn() -> (String, String)| {
        if seen.insert(ends.partition_point(|end| *end < span.start)) {
            let (message, help) = told();
            list.push(Diagnostic::new(Code::NotToml, message).at(span, "").help(help));
        }
    };
    let places = |error: &Error| {
        let at = error.span().map_or(Span::default(), Span::from);
        // The parser tells a bracket that is not closed where the text ends.
        let open = is_unclosed(error.message()).then(|| text.get(..at.start).and_then(innermost)).flatten();
        open.map_or(at, |open| Span { start: open, end: open + 1 })
    };
    let mut errors: Vec<_> = errors.iter().map(|error| (places(error), error.message())).collect();
    // A text without its second quote takes the brackets behind it with it.
    errors.sort_by_key(|(_, message)| !message.contains("basic string"));
    let open = open_before(text, &errors);
    for (span, message) in errors {
        // All that follows an open bracket the parser takes for its entries; that it is open is told below.
        if open.is_none_or(|(open, _)| span.start <= open.start && !is_unclosed(message)) {
            tell(span, &|| told(text, span, message));
        }
    }
    if let Some((span, bracket)) = open {
        tell(span, &|| {
            let (what, bracket) = if bracket == Bracket::List { ("list", ']') } else { ("table", '}') };
            (
                format!("this is not TOML: a {what} is not closed before the next line"),
                format!("write `{bracket}` behind the last entry of the {what}"),
            )
        });
    }
    list
}

fn is_unclosed(message: &str) -> bool {
    message.contains("unclosed inline table")
        || message.contains("unclosed array") && !message.contains("unclosed array table")
}

/// The innermost bracket that a text leaves open; brackets in texts and comments are none.
fn innermost(text: &str) -> Option<usize> {
    let mut open = Vec::new();
    let mut at = 0;
    while let Some(rest) = text.get(at..).filter(|rest| !rest.is_empty()) {
        let length = rest.chars().next().map_or(1, char::len_utf8);
        at += match rest.as_bytes()[0] {
            b'#' => rest.find('\n').unwrap_or(rest.len()),
            b'"' | b'\'' => quoted(rest),
            bracket => {
                match bracket {
                    b'[' | b'{' => open.push(at),
                    b']' | b'}' => drop(open.pop()),
                    _ => {}
                }
                length
            }
        };
    }
    open.pop()
}

/// The length of the text in quotes that this begins with; where its end is missing, that of the line.
fn quoted(text: &str) -> usize {
    let quote = &text[..1];
    let long = quote.repeat(3);
    let is_long = text.starts_with(&long);
    let ends = if is_long { &*long } else { quote };
    let mut at = ends.len();
    while let Some(rest) = text.get(at..).filter(|rest| !rest.is_empty()) {
        if rest.starts_with(ends) {
            return at + ends.len();
        }
        if !is_long && rest.starts_with('\n') {
            return at;
        }
        // In double quotes a backslash takes the next character with it.
        let passed = if quote == "\"" && rest.starts_with('\\') { 2 } else { 1 };
        at += rest.chars().take(passed).map(char::len_utf8).sum::<usize>();
    }
    text.len()
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Bracket {
    List,
    Table,
}

/// Where a bracket should be that is missing, if that is why entries are wrong: lines begin as none does within it.
fn open_before(text: &str, errors: &[(Span, &str)]) -> Option<(Span, Bracket)> {
    let at_begin = errors.iter().filter_map(|(at, message)| {
        let bracket = match message {
            message if message.contains("between array elements") => Bracket::List,
            message if message.contains("between key-value pairs") => Bracket::Table,
            message if message.contains("inline table element") => Bracket::Table,
            _ => return None,
        };
        let (before, rest) = (text.get(..at.start)?, text.get(at.start..)?);
        let is_begin = before[before.rfind('\n')?..].trim().is_empty();
        is_begin.then_some((before, rest.lines().next().unwrap_or_default(), bracket))
    });
    let at_begin: Vec<_> = at_begin.collect();
    let is_outside = |line: &str, bracket| {
        let is_entry = line.split_once('=').is_some_and(|(key, _)| is_name(key.trim()));
        is_heading(line) || bracket == Bracket::List && is_entry
    };
    let (.., open) = at_begin.iter().find(|(_, line, bracket)| is_outside(line, *bracket))?;
    let (before, ..) =
        at_begin.iter().filter(|(.., bracket)| bracket == open).min_by_key(|(before, ..)| before.len())?;
    // Behind a comma a heading is a list for the parser.
    let mut before = *before;
    loop {
        before = before.trim_end();
        match before.rsplit_once('\n') {
            Some((above, line)) if is_heading(line) => before = above,
            _ => return Some((Span { start: before.len(), end: before.len() }, *open)),
        }
    }
}

fn is_name(text: &str) -> bool {
    let is_part = |c: char| c.is_ascii_alphanumeric() || "_.-".contains(c);
    text.starts_with(|c: char| c.is_ascii_alphabetic()) && text.chars().all(is_part)
}

fn is_heading(line: &str) -> bool {
    let name = line.trim_end().strip_prefix('[').and_then(|line| line.strip_suffix(']'));
    name.is_some_and(is_name)
}

/// What is wrong at a place, and the cure.
fn told(text: &str, at: Span, message: &str) -> (String, String) {
    let rest = text.get(at.start..).unwrap_or_default();
    let first = rest.chars().next();
    let line = text.get(..at.start).and_then(|before| before.rsplit('\n').next()).unwrap_or_default();
    if message.contains("duplicate key")
        && let Some(name) = text.get(at.start..at.end).filter(|name| !name.is_empty())
    {
        let name = name.rsplit('.').next().unwrap_or(name).trim_matches(['"', '\'', '[', ']']);
        return (
            format!("the key `{name}` stands twice in one table"),
            "keep one of the two, or give the other a name of its own".to_owned(),
        );
    }
    let (what, cure) = match first {
        _ if message.contains("carriage return") || rest.starts_with('\r') && !rest.starts_with("\r\n") => (
            "a carriage return without a line feed behind it".to_owned(),
            "lines end with a line feed (LF), or with both (CR LF): save the file with such line ends",
        ),
        Some(c) if c.is_control() && !"\t\r\n".contains(c) => (
            format!("the character U+{:04X}, which no text has", u32::from(c)),
            "take it out; a file that is full of them is no text, or saved as UTF-16: save it as UTF-8",
        ),
        Some(c @ ('“' | '”' | '„' | '‘' | '’' | '«' | '»')) => {
            (format!("`{c}` is no quote here"), "write straight quotes: `\"120 mm\"`")
        }
        Some(c) if c.is_whitespace() && !c.is_ascii() => {
            (format!("a blank that is none here, U+{:04X}", u32::from(c)), "write a plain space in its place")
        }
        _ if message.contains("key with no value") && line.trim_end().ends_with(':') => {
            (message.to_owned(), "write `=` between a key and its value")
        }
        _ if line.trim_start().starts_with("//") => (message.to_owned(), "a comment begins with `#`"),
        None | Some('\r' | '\n') if message.contains("must be quoted") => {
            ("a key without a value".to_owned(), "write the value behind `=`")
        }
        _ => {
            let cure = CURES.iter().find(|(part, _)| message.contains(part));
            (message.to_owned(), cure.map_or(OTHERWISE, |(_, cure)| cure))
        }
    };
    (format!("this is not TOML: {what}"), cure.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spec::parse;

    /// Line and column of a fault, and words of what is told with the cure.
    type Fault = ((usize, usize), &'static str);

    #[test]
    fn each_fault_has_the_cure_of_its_cause() {
        let cases: &[(&str, &[Fault])] = &[
            ("a = 1 m", &[((1, 5), "stand in quotes")]),
            ("a = [1 m]", &[((1, 6), "stand in quotes")]),
            ("a = \"x\ry\"", &[((1, 7), "LF")]),
            ("spec = 1\rname = \"a\"\r\n", &[((1, 10), "LF")]),
            ("a = \"x\0y\"", &[((1, 7), "U+0000")]),
            ("# \0\n", &[((1, 3), "UTF-16")]),
            ("a = 2*b*c\"", &[((1, 5), "stand in quotes")]),
            ("a = { b = \"x, c = 1 }", &[((1, 22), "the quote it began with")]),
            ("a = [“1 m”]", &[((1, 6), "straight quotes")]),
            ("a\u{a0}= 1", &[((1, 2), "U+00A0")]),
            ("a: 1", &[((1, 4), "write `=`")]),
            ("// a", &[((1, 4), "begins with `#`")]),
            ("a =\nb = 1", &[((1, 4), "a key without a value")]),
            ("ä = 1", &[((1, 1), "names have letters")]),
            ("a = [1];", &[((1, 8), "one entry stands in a line")]),
            ("a = True", &[((1, 5), "small letters")]),
            ("a = .5", &[((1, 5), "`0.5`")]),
            ("a = [5.]", &[((1, 8), "`0.5`")]),
            ("a = [01]", &[((1, 6), "no zero before")]),
            ("a = \"\\m\"", &[((1, 7), "backslash")]),
            ("[a\nb = 1", &[((1, 3), "heading ends")]),
            // A bracket that is not closed is told where it is, not where the text ends.
            ("a = { b = 1\n", &[((1, 5), "`}`")]),
            ("spec = 1\na = [1,\n2\n\n# ]\n", &[((2, 5), "`]` behind the last entry")]),
            ("a = [[1, 2], [3,\n4\n", &[((1, 14), "`]` behind the last entry")]),
            ("a = { b = ['[', \"\\\"]\", 2\n\n", &[((1, 11), "`]` behind the last entry")]),
            ("a = \"\"\"\n[{\"\"\"\nä = 1\nb = {\n", &[((3, 1), "names have"), ((4, 5), "`}`")]),
            ("a = [1, \"x]\" # ]", &[((1, 5), "`]` behind the last entry")]),
            ("[[zz\nb = 1", &[((1, 5), "a heading has one `[`")]),
            ("[[zz]\nb = 1", &[((1, 6), "a heading has one `[`")]),
            ("a = { b = 1 c = 2 }", &[((1, 15), "comma")]),
            ("a = { b = (1, 2), c = 3 }", &[((1, 17), "a list `[1, 2]`")]),
            ("a = [\"1\" \"2\"]\nb = [1,\n2\n3]", &[((1, 10), "comma"), ((4, 1), "comma")]),
            // What follows a list that is not closed is not wrong itself.
            ("a = [1,\n\n[b]\nc = 1\n[d]\n", &[((1, 8), "a list is not closed")]),
            ("a = { b = 1\n[c]\nd = 1\n[e]", &[((1, 12), "`}`")]),
            ("a = { b = 1\nc = 1\nd = 2\n[e]", &[((1, 12), "a table is not closed")]),
            ("a = { b = 1,\nc = 1\nd = 2 }", &[((3, 1), "comma")]),
            ("a = [\"1 m, 0]\n[b]\nc = 1\n", &[((1, 14), "the quote it began with")]),
            ("a = 1\na = 2\n[b]\n[b]", &[((2, 1), "`a` stands twice"), ((4, 2), "`b` stands twice")]),
        ];
        let mut wrong = Vec::new();
        for (text, faults) in cases {
            let source = SourceFile { name: "m.toml".into(), text: (*text).to_owned() };
            let told = parse(&source).expect_err(text);
            let found: Vec<_> = told.entries().iter().map(|entry| (entry.line, entry.column)).collect();
            let places: Vec<_> = faults.iter().map(|(place, _)| *place).collect();
            let words = told.to_string();
            if found != places || faults.iter().any(|(_, word)| !words.contains(word)) {
                wrong.push(format!("{text:?}: {found:?}\n{words}"));
            }
        }
        assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    }
}
