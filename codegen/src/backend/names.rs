//! Names that are unique within one function or list. In: names as a language allows them. Out: the same, or with a number.

use std::collections::{HashMap, HashSet};

/// Hands out names, each once.
#[derive(Default)]
pub struct Unique {
    used: HashSet<String>,
    /// The last number that was tried for a name.
    numbers: HashMap<String, u32>,
}

impl Unique {
    /// The name, or the name with a number if it is taken.
    pub fn of(&mut self, base: String) -> String {
        if self.used.insert(base.clone()) {
            return base;
        }
        let number = self.numbers.entry(base.clone()).or_insert(1);
        loop {
            *number += 1;
            let name = format!("{base}_{number}");
            if self.used.insert(name.clone()) {
                return name;
            }
        }
    }
}

/// A name of letters, digits and underscores that does not begin with a digit.
pub fn plain(name: &str) -> String {
    let mut text: String =
        name.chars().map(|c| if c.is_ascii_alphanumeric() || c == '_' { c } else { '_' }).collect();
    if text.is_empty() || text.starts_with(|c: char| c.is_ascii_digit()) || text == "_" {
        text.insert(0, 'n');
    }
    text
}
