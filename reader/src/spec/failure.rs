//! The error of one value while a file is read: serde's errors, said so that a user understands them.

use std::fmt;

use serde::de::{Error, Expected, Unexpected};

use crate::diagnostic::{Code, Diagnostic, nearest};
use crate::source::Span;

/// An error of one value, with its place once known.
#[derive(Debug)]
pub(super) struct Failure {
    code: Code,
    message: String,
    help: Option<String>,
    span: Option<Span>,
    /// The text that stands where a list is needed; empty if it is no text.
    in_place_of_list: Option<String>,
    /// It is among the diagnostics already.
    pub reported: bool,
}

impl Failure {
    fn of(code: Code, message: String) -> Self {
        Self { code, message, help: None, span: None, in_place_of_list: None, reported: false }
    }

    /// For the callers of a value whose fault is among the diagnostics.
    pub(super) fn already_reported() -> Self {
        Self { reported: true, ..Self::of(Code::WrongType, String::new()) }
    }

    pub(super) fn advise(self, help: &str) -> Self {
        Self { help: Some(help.to_owned()), ..self }
    }

    /// Says which list belongs under `key`.
    pub(super) fn under(mut self, key: &str) -> Self {
        let Some(text) = self.in_place_of_list.take() else { return self };
        let list = match (key, text.as_str()) {
            ("gravity", _) => r#"["0 m/s^2", "0 m/s^2", "-9.81 m/s^2"]"#,
            ("rod" | "tube" | "box", _) => r#"["A", "B"]"#,
            ("axes", _) => "[[1, 0, 0], [0, 1, 0]]",
            (_, "x") => "[1, 0, 0]",
            (_, "y") => "[0, 1, 0]",
            (_, "z") => "[0, 0, 1]",
            _ if key.contains("axis") || key == "normal" => "[0, 0, 1]",
            _ => return self,
        };
        self.help = Some(format!("write it in brackets: `{key} = {list}`"));
        self
    }

    /// Takes the place of the key, if that is what is wrong.
    pub(super) fn at_key(self, span: Span) -> Self {
        if self.code == Code::UnknownKey { Self { span: Some(span), ..self } } else { self }
    }

    pub(super) fn or_at(mut self, span: Span) -> Self {
        self.span.get_or_insert(span);
        self
    }

    pub(super) fn diagnostic(&self, fallback: Span) -> Diagnostic {
        let diagnostic =
            Diagnostic::new(self.code, self.message.clone()).at(self.span.unwrap_or(fallback), "");
        match &self.help {
            Some(help) => diagnostic.help(help.clone()),
            None => diagnostic,
        }
    }
}

/// What is told of a key that a table does not have.
pub fn unknown_key(key: &str) -> String {
    format!("the key `{key}` means nothing here")
}

/// The key that was meant, or all.
pub(super) fn known_keys(key: &str, known: &[&str]) -> String {
    nearest(key, known.iter().copied()).map_or_else(
        || {
            format!(
                "known keys here: {}",
                known.iter().map(|key| format!("`{key}`")).collect::<Vec<_>>().join(", ")
            )
        },
        |name| format!("did you mean `{name}`?"),
    )
}

impl fmt::Display for Failure {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.message)
    }
}

impl std::error::Error for Failure {}

impl Error for Failure {
    fn custom<T: fmt::Display>(message: T) -> Self {
        Self::of(Code::WrongType, message.to_string())
    }
    fn invalid_type(found: Unexpected<'_>, expected: &dyn Expected) -> Self {
        let text = if let Unexpected::Str(text) = found { text } else { "" }.to_owned();
        let found = match found {
            Unexpected::Seq => "a list".to_owned(),
            Unexpected::Map => "a table".to_owned(),
            Unexpected::Str(text) => format!("the text \"{text}\""),
            Unexpected::Bool(value) => value.to_string(),
            Unexpected::Signed(value) => format!("the number {value}"),
            Unexpected::Float(value) => format!("the number {value}"),
            other => other.to_string(),
        };
        let expected = expected.to_string();
        let (expected, cure) = match expected.as_str() {
            "a sequence" => ("a list", Some("write it in brackets, `[..]`")),
            "a boolean" => ("true or false", Some("write `true` or `false` without quotes")),
            "a string" => ("a text", Some("write one text in quotes")),
            "i64" => ("a whole number", Some("write a whole number without quotes")),
            other if other.starts_with("struct ") || other == "a table" => {
                ("a table", Some("write a table, `{ key = value }`"))
            }
            other if other.starts_with("enum ") => ("a word", Some("write a word in quotes")),
            other if other.starts_with("a quantity") => (
                other,
                Some(
                    "write a number with its unit in quotes, `\"120 mm\"`, a formula in quotes, or a bare number",
                ),
            ),
            // Entries of tables, and what tables stand for.
            other => {
                (other, Some("write what is needed there; `linkwear schema` has all keys with their types"))
            }
        };
        let mut failure = Self::of(Code::WrongType, format!("found {found} where {expected} is needed"));
        failure.help = cure.map(str::to_owned);
        failure.in_place_of_list = (expected == "a list").then_some(text);
        failure
    }
    /// Of tables, which may have any number of entries but this.
    fn invalid_length(_: usize, expected: &dyn Expected) -> Self {
        Self::of(Code::WrongCount, format!("found an empty table where {expected} is needed"))
            .advise("write `[0, 0, 1]` for all, or `{ crank = [0, 0, 1], rocker = [0, 0, 1] }`")
    }
    fn unknown_field(key: &str, expected: &'static [&'static str]) -> Self {
        let mut failure = Self::of(Code::UnknownKey, unknown_key(key));
        failure.help = Some(known_keys(key, expected));
        failure
    }
    fn unknown_variant(variant: &str, expected: &'static [&'static str]) -> Self {
        let allowed = expected.iter().map(|word| format!("\"{word}\"")).collect::<Vec<_>>().join(" or ");
        let mut failure = Self::of(Code::BadChoice, format!("\"{variant}\" is not {allowed}"));
        failure.help = nearest(variant, expected.iter().copied())
            .map_or(Some("choose one of them".to_owned()), |word| Some(format!("did you mean \"{word}\"?")));
        failure
    }
}
