//! Identifiers for generated code: unique, valid, as close to the reader's names as possible.
//! In: labels. Out: identifiers.

use proc_macro2::{Ident, Span};

use super::super::names::{Unique, plain};

/// Words that are Rust identifiers to `syn` but cannot be bound in generated code. A name of the user's that is one of
/// them gets an underscore, as a keyword does; a test compiles a mechanism with all of them.
const TAKEN: &[&str] = &[
    // Arguments of the functions.
    "x",
    "y",
    "w",
    // A keyword since edition 2024.
    "gen",
    // Constants, statics and constructors: as a pattern each of these is compared, not bound.
    "None",
    "Some",
    "Ok",
    "Err",
    "SIZES",
    "SOURCE_SHA256",
    "MASS_IS_LEFT_OUT",
    "PARAMETERS",
    "INPUTS",
    "COORDINATES",
    "SPEEDS",
    "MOTIONS",
    "QUATERNIONS",
    "ROWS",
    "DRIVERS",
    "CONTACTS",
    "MISSIONS",
    "CHANNELS",
    "TABLES",
    "JOURNALS",
    "COEFFICIENTS",
    // Functions that are called beside the user's names.
    "angle_over_sine",
    "log_coefficient",
];

/// A valid identifier made of a name; keywords get an underscore.
fn clean(name: &str) -> String {
    let mut text = plain(name);
    // As most are: a letter and the number of a value.
    if text.len() > 1 && text.as_bytes()[1..].iter().all(u8::is_ascii_digit) {
        return text;
    }
    // No keyword has a digit or an underscore inside; most names here have, and are not parsed.
    let may_be_keyword = text.bytes().all(|byte| byte.is_ascii_alphabetic());
    if (may_be_keyword && syn::parse_str::<Ident>(&text).is_err()) || TAKEN.contains(&text.as_str()) {
        text.push('_');
    }
    text
}

/// Hands out names that are unique within one function or struct.
#[derive(Default)]
pub struct Names(Unique);

impl Names {
    /// The name, or the name with a number if it is taken.
    pub fn unique(&mut self, wanted: &str) -> String {
        self.0.of(clean(wanted))
    }

    /// The same of a name that is a valid identifier and no word of the language.
    pub fn unique_clean(&mut self, wanted: String) -> String {
        self.0.of(wanted)
    }

    /// The same as a token.
    pub fn identifier(&mut self, wanted: &str) -> Ident {
        Ident::new(&self.unique(wanted), Span::call_site())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keywords_digits_and_repeats_become_valid_names() {
        let mut names = Names::default();
        assert_eq!(names.unique("type"), "type_");
        assert_eq!(names.unique("2nd"), "n2nd");
        assert_eq!(names.unique("a-b"), "a_b");
        assert_eq!(names.unique("a-b"), "a_b_2");
        assert_eq!(names.unique("x"), "x_");
        assert_eq!(names.unique("x_"), "x__2");
        assert_eq!(names.unique("gen"), "gen_");
        assert_eq!(names.unique("ROWS"), "ROWS_");
    }
}
