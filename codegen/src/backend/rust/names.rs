//! Identifiers for generated code: unique, valid, as close to the reader's names as possible.
//! In: labels. Out: identifiers.

use std::collections::HashSet;

use proc_macro2::{Ident, Span};

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
    "PARAMETERS",
    "COORDINATES",
    "SPEEDS",
    "MOTIONS",
    "QUATERNIONS",
    "ROWS",
    "DRIVERS",
    "CONTACTS",
    "CHANNELS",
    "DESCRIPTION",
    // Functions that are called beside the user's names.
    "angle_over_sine",
    "log_coefficient",
];

/// A valid identifier made of a name; keywords get an underscore.
fn clean(name: &str) -> String {
    let mut text: String =
        name.chars().map(|c| if c.is_ascii_alphanumeric() || c == '_' { c } else { '_' }).collect();
    if text.is_empty() || text.starts_with(|c: char| c.is_ascii_digit()) || text == "_" {
        text.insert(0, 'n');
    }
    if syn::parse_str::<Ident>(&text).is_err() || TAKEN.contains(&text.as_str()) {
        text.push('_');
    }
    text
}

/// Hands out names that are unique within one function or struct.
#[derive(Default)]
pub struct Names {
    used: HashSet<String>,
}

impl Names {
    /// The name, or the name with a number if it is taken.
    pub fn unique(&mut self, wanted: &str) -> Ident {
        let base = clean(wanted);
        let mut name = base.clone();
        let mut number = 2;
        while !self.used.insert(name.clone()) {
            name = format!("{base}_{number}");
            number += 1;
        }
        Ident::new(&name, Span::call_site())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keywords_digits_and_repeats_become_valid_names() {
        let mut names = Names::default();
        assert_eq!(names.unique("type").to_string(), "type_");
        assert_eq!(names.unique("2nd").to_string(), "n2nd");
        assert_eq!(names.unique("a-b").to_string(), "a_b");
        assert_eq!(names.unique("a-b").to_string(), "a_b_2");
        assert_eq!(names.unique("x").to_string(), "x_");
        assert_eq!(names.unique("x_").to_string(), "x__2");
        assert_eq!(names.unique("gen").to_string(), "gen_");
        assert_eq!(names.unique("ROWS").to_string(), "ROWS_");
    }
}
