//! Names that are unique within one function or list. In: names as a language allows them. Out: the same, or with a number.

use rustc_hash::FxHashMap;

/// Hands out names, each once.
#[derive(Default)]
pub struct Unique {
    /// The last number that was tried for a name.
    numbers: FxHashMap<String, u32>,
}

impl Unique {
    /// The name, or the name with a number if it is taken.
    pub fn of(&mut self, base: String) -> String {
        let Some(last) = self.numbers.get(&base) else {
            self.numbers.insert(base.clone(), 1);
            return base;
        };
        let mut number = *last;
        loop {
            number += 1;
            let name = format!("{base}_{number}");
            if !self.numbers.contains_key(&name) {
                self.numbers.insert(name.clone(), 1);
                self.numbers.insert(base, number);
                return name;
            }
        }
    }
}

/// A name of letters, digits and underscores that does not begin with a digit.
pub fn plain(name: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let mut text: String = if name.bytes().all(|byte| is_plain(char::from(byte))) {
        name.to_owned()
    } else {
        name.chars().map(|c| if is_plain(c) { c } else { '_' }).collect()
    };
    if text.is_empty() || text.starts_with(|c: char| c.is_ascii_digit()) || text == "_" {
        text.insert(0, 'n');
    }
    text
}
