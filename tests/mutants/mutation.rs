//! Shipped files made wrong, by a number: the same number gives the same file on every machine.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// Fragments that mean something somewhere.
const PIECES: &[&str] = &[
    "",
    "0",
    "-1",
    "nan",
    "inf",
    "\"\"",
    "\"ground\"",
    "\"0 mm\"",
    "\"t\"",
    "\"1/0\"",
    "[]",
    "{}",
    "[0, 0, 0]",
    "true",
    "cut = true,",
    "µ",
    "\\",
    "=",
    "\n",
    "sqrt(-1)",
    "1e308",
    "\u{0}",
];
/// What a number is multiplied by.
const FACTORS: &[f64] = &[
    0.0, -1.0, 0.5, 0.9, 0.999_999, 1.000_001, 1.1, 2.0, 10.0, 0.1, 1e3, 1e-3, 1e6, 1e-6, 1e12, 1e-12, 1e40,
];
const UNITS: &[&str] = &[
    "mm", "m", "um", "km", "deg", "rad", "kg", "g", "Hz", "rpm", "rad/s", "MPa", "GPa", "N m", "N", "s",
    "1/um", "kg/m^3",
];

/// The dice of one mutant.
pub struct Dice(ChaCha8Rng);

impl Dice {
    pub fn new(number: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(number))
    }

    pub fn below(&mut self, end: usize) -> usize {
        let end = u64::try_from(end).expect("a count");
        usize::try_from(self.0.next_u64() % end).expect("below a count")
    }

    fn pick<'a, T: ?Sized>(&mut self, list: &[&'a T]) -> &'a T {
        list[self.below(list.len())]
    }
}

/// One to three changes.
pub fn mutate(text: &str, dice: &mut Dice) -> String {
    let changes = [1, 1, 1, 2, 2, 3][dice.below(6)];
    (0..changes).fold(text.to_owned(), |text, _| {
        let change = dice.below(20);
        let changed = match change {
            0..=9 => number(&text, dice),
            10 => unit(&text, dice),
            11..=13 => name(&text, dice),
            14 => line(&text, dice),
            15 => table(&text, dice),
            16..=18 => component(&text, dice),
            _ => Some(piece(&text, dice)),
        };
        changed.unwrap_or(text)
    })
}

/// What of the text is no comment, as byte ranges of its words: runs of letters, digits, `_` and `.`.
fn words(text: &str, keep: impl Fn(&str) -> bool) -> Vec<(usize, usize)> {
    let mut found = Vec::new();
    let mut at = 0;
    for line in text.split_inclusive('\n') {
        let code = line.split('#').next().unwrap_or_default();
        let mut begin = None;
        for (place, letter) in code.char_indices().chain([(code.len(), ' ')]) {
            let inside = letter.is_ascii_alphanumeric() || letter == '_' || letter == '.';
            match (begin, inside) {
                (None, true) => begin = Some(place),
                (Some(from), false) => {
                    if keep(&code[from..place]) {
                        found.push((at + from, at + place));
                    }
                    begin = None;
                }
                _ => {}
            }
        }
        at += line.len();
    }
    found
}

fn replaced(text: &str, (from, to): (usize, usize), by: &str) -> String {
    format!("{}{by}{}", &text[..from], &text[to..])
}

/// A number times a factor.
fn number(text: &str, dice: &mut Dice) -> Option<String> {
    let numbers = words(text, |word| word.parse::<f64>().is_ok_and(f64::is_finite));
    let place = *numbers.get(dice.below(numbers.len().max(1)))?;
    let value: f64 = text[place.0..place.1].parse().ok()?;
    let factor = FACTORS[dice.below(FACTORS.len())];
    let value = if value == 0.0 { factor } else { value * factor };
    Some(replaced(text, place, &format!("{value:?}")))
}

/// One unit for another.
fn unit(text: &str, dice: &mut Dice) -> Option<String> {
    let units = words(text, |word| UNITS.contains(&word));
    let place = *units.get(dice.below(units.len().max(1)))?;
    Some(replaced(text, place, dice.pick(UNITS)))
}

/// A name for another name of the file.
fn name(text: &str, dice: &mut Dice) -> Option<String> {
    let names = words(text, |word| {
        word.starts_with(|letter: char| letter.is_ascii_alphabetic()) && !UNITS.contains(&word)
    });
    let place = *names.get(dice.below(names.len().max(1)))?;
    let other = *names.get(dice.below(names.len().max(1)))?;
    Some(replaced(text, place, &text[other.0..other.1]))
}

/// A line left out, said twice or moved.
fn line(text: &str, dice: &mut Dice) -> Option<String> {
    let mut lines: Vec<&str> = text.lines().collect();
    let places: Vec<usize> =
        (0..lines.len()).filter(|at| !lines[*at].is_empty() && !lines[*at].starts_with('#')).collect();
    let from = *places.get(dice.below(places.len().max(1)))?;
    let to = *places.get(dice.below(places.len().max(1)))?;
    match dice.below(4) {
        0 | 1 => drop(lines.remove(from)),
        2 => lines.insert(to, lines[from]),
        _ => lines.swap(from, to),
    }
    Some(lines.join("\n"))
}

/// A table left out.
fn table(text: &str, dice: &mut Dice) -> Option<String> {
    let mut tables: Vec<&str> = text.split("\n[").collect();
    (tables.len() > 1).then(|| {
        tables.remove(1 + dice.below(tables.len() - 1));
        tables.join("\n[")
    })
}

/// A component of a direction or point a little or wholly off.
fn component(text: &str, dice: &mut Dice) -> Option<String> {
    let zeros = words(text, |word| word == "0" || word == "1");
    let place = *zeros.get(dice.below(zeros.len().max(1)))?;
    Some(replaced(text, place, dice.pick(&["1e-12", "1e-9", "1e-7", "1e-5", "1e-3", "0.1", "1", "-1", "0"])))
}

/// A fragment anywhere.
fn piece(text: &str, dice: &mut Dice) -> String {
    let mut letters: Vec<char> = text.chars().collect();
    let from = dice.below(letters.len());
    let to = (from + dice.below(12)).min(letters.len());
    letters.splice(from..to, dice.pick(PIECES).chars());
    letters.into_iter().collect()
}
