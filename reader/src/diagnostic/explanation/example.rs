//! An explanation of a code, and the whole files of its example. In: lines. Out: a mechanism file. Never knows codes.

use crate::diagnostic::Code;

/// What a code means, and an example.
#[derive(Debug)]
pub struct Explanation {
    /// The code.
    pub code: Code,
    /// What it means and why it is a fault, in a few sentences.
    pub text: &'static str,
    /// The file in which the lines are tried.
    pub(super) file: File,
    /// Lines with the fault: those of a mechanism file that replace or add to the ones of the example, a whole file from
    /// `spec =` on, or `--set` of a command line. A line in comment marks takes the key away.
    pub wrong: &'static str,
    /// The same lines, cured.
    pub right: &'static str,
}

/// A mechanism that is right.
#[derive(Clone, Copy, Debug)]
pub enum File {
    /// A pendulum.
    Swing,
    /// A crank-rocker in a plane.
    FourBar,
    /// A slider-crank with a crank pin that wears.
    Press,
}

impl File {
    pub const fn text(self) -> &'static str {
        match self {
            Self::Swing => include_str!("swing.toml"),
            Self::FourBar => include_str!("four_bar.toml"),
            Self::Press => include_str!("press.toml"),
        }
    }
}

/// Modal data that examples name.
const BESIDE: [(&str, &str); 2] = [
    ("rod_of_two_masses.toml", include_str!("rod_of_two_masses.toml")),
    ("rod_of_other_mass.toml", include_str!("rod_of_other_mass.toml")),
];

impl Explanation {
    /// Files that lines of the example name, with their texts: they lie beside it.
    pub fn beside(lines: &str) -> impl Iterator<Item = (&'static str, &'static str)> {
        BESIDE.into_iter().filter(move |(name, _)| lines.contains(name))
    }

    /// The whole file of some lines of the example: [`Self::wrong`] or [`Self::right`].
    pub fn file(&self, lines: &str) -> String {
        if lines.starts_with("spec = 1\n") {
            return lines.to_owned();
        }
        let mut file: Vec<(String, Vec<String>)> = sections(self.file.text());
        if lines.starts_with("--set ") {
            return joined(&file);
        }
        for (header, changed) in sections(lines) {
            let at = file.iter().position(|(known, _)| *known == header).unwrap_or_else(|| {
                file.push((header, Vec::new()));
                file.len() - 1
            });
            for line in changed {
                let known = &mut file[at].1;
                let gone = line.strip_prefix("# ");
                let key = key(gone.unwrap_or(&line)).to_owned();
                let place = known.iter().position(|other| self::key(other) == key);
                match (place, gone) {
                    (Some(place), None) => known[place] = line,
                    (Some(place), Some(_)) => drop(known.remove(place)),
                    (None, None) => known.push(line),
                    (None, Some(_)) => {}
                }
            }
        }
        joined(&file)
    }
}

/// The tables of a file by their headers, the top level under none.
fn sections(text: &str) -> Vec<(String, Vec<String>)> {
    let mut sections = vec![(String::new(), Vec::new())];
    for line in text.lines().filter(|line| !line.is_empty()) {
        if line.starts_with('[') {
            sections.push((line.to_owned(), Vec::new()));
        } else if let Some((_, lines)) = sections.last_mut() {
            lines.push(line.to_owned());
        }
    }
    sections
}

fn joined(file: &[(String, Vec<String>)]) -> String {
    let tables = file.iter().map(|(header, lines)| {
        let header = if header.is_empty() { String::new() } else { format!("{header}\n") };
        format!("{header}{}\n", lines.join("\n"))
    });
    tables.collect::<Vec<_>>().join("\n")
}

/// What stands before the equals sign.
fn key(line: &str) -> &str {
    line.split_once('=').map_or(line, |(key, _)| key).trim()
}
