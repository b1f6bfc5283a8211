//! Identifiers for generated code: unique, valid, as close to the reader's names as possible.
//! In: labels. Out: identifiers.

use std::collections::HashSet;

use proc_macro2::{Ident, Span};

/// A valid identifier made of a name; keywords get an underscore.
pub fn identifier(name: &str) -> Ident {
    Ident::new(&clean(name), Span::call_site())
}

fn clean(name: &str) -> String {
    let mut text: String =
        name.chars().map(|c| if c.is_ascii_alphanumeric() || c == '_' { c } else { '_' }).collect();
    if text.is_empty() || text.starts_with(|c: char| c.is_ascii_digit()) || text == "_" {
        text.insert(0, 'n');
    }
    // Names of this module's own arguments are taken as well.
    let taken = ["x", "y", "w", "self", "Self", "super", "crate"];
    if syn::parse_str::<Ident>(&text).is_err() || taken.contains(&text.as_str()) {
        text.push('_');
    }
    text
}

/// Hands out names that are unique within one function.
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
    }
}
