//! Names that a mechanism file may use, each once. In: names of another format. Never knows what they are of.

use std::collections::HashSet;

/// Words with a meaning of their own in formulas.
const TAKEN: [&str; 18] = [
    "t", "pi", "energy", "ground", "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh",
    "tanh", "exp", "ln", "sqrt", "spec",
];
/// What a body's centre of mass is called: its name and this.
const CENTRE: &str = "_centre";

/// Names given so far.
#[derive(Debug, Default)]
pub struct Names {
    given: HashSet<String>,
}

impl Names {
    /// A name as [`plain`] writes it; with a number behind if it is taken.
    pub fn fresh(&mut self, wanted: &str) -> String {
        let name = plain(wanted);
        let is_free = |name: &str| {
            let centre = format!("{name}{CENTRE}");
            !TAKEN.contains(&name) && !self.given.contains(name) && !self.given.contains(&centre)
        };
        let numbered = (2_u64..).map(|number| format!("{name}_{number}"));
        let own = std::iter::once(name.clone()).chain(numbered).find(|name| is_free(name)).unwrap_or(name);
        self.given.insert(own.clone());
        self.given.insert(format!("{own}{CENTRE}"));
        own
    }
}

/// Letters, digits and `_`, a letter first.
pub fn plain(wanted: &str) -> String {
    let mut name: String =
        wanted.chars().map(|letter| if letter.is_ascii_alphanumeric() { letter } else { '_' }).collect();
    if !name.starts_with(|first: char| first.is_ascii_alphabetic()) {
        name.insert_str(0, "x_");
    }
    name
}
