//! The properties that fuzzing asks for, with a few drawn inputs and with every input that ever failed.

#[path = "../fuzz/src/lib.rs"]
mod properties;

use std::fs;
use std::path::{Path, PathBuf};

use proptest::prelude::*;

/// A property by the name of its fuzz target.
type Property = (&'static str, fn(&str));

const PROPERTIES: [Property; 6] = [
    ("mechanism", properties::mechanism),
    ("expression", properties::expression),
    ("readings", properties::readings),
    ("modal_data", properties::modal_data),
    ("fit_file", properties::fit_file),
    ("journal", |text| properties::journal(text.as_bytes())),
];

fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten();
    entries.map(|entry| entry.expect("an entry").path()).filter(|path| path.is_file()).collect()
}

#[test]
fn what_once_failed_does_so_no_more() {
    for (name, property) in PROPERTIES {
        for path in files(&Path::new("fuzz/regressions").join(name)) {
            let bytes = fs::read(&path).expect("a file");
            match String::from_utf8(bytes) {
                Ok(text) => property(&text),
                Err(error) => properties::journal(error.as_bytes()),
            }
        }
    }
}

#[test]
fn every_fuzz_target_is_asked_here_too() {
    let mut targets: Vec<String> = files(Path::new("fuzz/fuzz_targets"))
        .iter()
        .map(|path| path.file_stem().unwrap_or_default().to_string_lossy().into_owned())
        .collect();
    targets.sort();
    let mut known: Vec<&str> = PROPERTIES.iter().map(|(name, _)| *name).collect();
    known.sort_unstable();
    assert_eq!(targets, known);
}

/// Small inputs that are right.
fn seeds(property: &str) -> Vec<String> {
    let read = |path: &str| fs::read_to_string(path).expect("a shipped file");
    match property {
        "mechanism" => ["pendulum", "slider_crank", "four_bar"]
            .iter()
            .map(|name| read(&format!("mechanisms/{name}.toml")))
            .collect(),
        "expression" => ["2*pi*3 Hz*t", "0.1 m + a", "sqrt(4 m^2)", "-(a/2)^2", "tanh(R1.v/(1 rad/s))*1 N"]
            .map(str::to_owned)
            .to_vec(),
        "readings" => vec![
            "unit,wear,exposure\na,0,0\na,1.5,10\na,2.5,20\nb,0,0\nb,2,10\nb,4.5,20\n".to_owned(),
            "unit,wear,exposure\na,0.5,1\na,0.5,2\na,1,3\nb,1,1\nb,1,2\nb,2.5,3\n".to_owned(),
        ],
        "modal_data" => vec![read("tests/data/slider_crank_rod.toml")],
        "fit_file" => vec![
            "{\"process\": \"gamma\", \"alpha\": 2.5, \"beta\": 1.5, \"covariance\": [[0.1, 0.02], [0.02, 0.1]]}".to_owned(),
            "{\"process\": \"wiener\", \"drift\": 2.5, \"diffusion\": 1.5, \"exponent\": 0.7}".to_owned(),
        ],
        _ => vec!["0123456789abcdef {\"run\":{\"a\":1}}\n".to_owned()],
    }
}

/// What is put into an input: pieces that mean something somewhere.
const PIECES: [&str; 24] = [
    "",
    "0",
    "-1",
    "nan",
    "inf",
    "1e308",
    "1e-320",
    "\"\"",
    "\n",
    ",",
    "=",
    "[",
    "{",
    "}",
    "\"",
    "\\",
    "µ",
    "\u{0}",
    "[0, 0, 0]",
    "\"t\"",
    "\"1/0\"",
    "null",
    "(((((",
    "^99",
];

fn damaged(mut text: Vec<char>, damages: &[(f64, usize, &str)]) -> String {
    for (place, length, piece) in damages {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a place in a short text")]
        let start = (place * text.len() as f64) as usize;
        let end = (start + length).min(text.len());
        text.splice(start..end, piece.chars());
    }
    text.into_iter().collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 120, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_damaged_input_is_answered_or_refused(
        which in 0..PROPERTIES.len(),
        seed in 0usize..8,
        damages in prop::collection::vec((0.0..1.0, 0usize..9, prop::sample::select(&PIECES[..])), 1..4),
    ) {
        let (name, property) = PROPERTIES[which];
        let seeds = seeds(name);
        property(&damaged(seeds[seed % seeds.len()].chars().collect(), &damages));
    }
}
