//! `fit`: Gamma processes of measured wear from the command line.

mod command;

use std::fs;
use std::path::PathBuf;

use command::linkwear;
use serde_json::Value;

const HEAVY: &str = "examples/data/sliding_wear_100g.csv";
const COLUMNS: [&str; 6] = ["--unit", "unit", "--wear", "wear_um", "--exposure", "cycles"];

fn fit(file: &str, more: &[&str]) -> Value {
    linkwear(&[&["fit", file], &COLUMNS[..], more, &["--format", "json"]].concat()).json()
}

#[track_caller]
fn close(found: &Value, expected: f64, tolerance: f64) {
    let found = found.as_f64().expect("a number");
    assert!((found / expected - 1.0).abs() <= tolerance, "{found} for {expected}");
}

/// A data file that this process alone uses.
fn written(name: &str, text: &str) -> PathBuf {
    let path = std::env::temp_dir().join(format!("linkwear-fit-{}-{name}.csv", std::process::id()));
    fs::write(&path, text).expect("a temporary file");
    path
}

/// The one error of data that cannot be fitted.
fn refused(name: &str, rows: &str, more: &[&str]) -> Value {
    let path = written(name, &format!("unit,cycles,wear_um\n{rows}"));
    let file = path.display().to_string();
    let answer = linkwear(&[&["fit", &file], &COLUMNS[..], more, &["--format", "json"]].concat());
    fs::remove_file(path).expect("the file");
    assert_eq!(answer.code, 1);
    let error = answer.errors()[0].clone();
    assert_eq!(error["file"], file.as_str());
    assert_eq!(error["code"], "C0011");
    assert!(!error["help"].as_str().expect("a text").is_empty());
    error
}

#[test]
fn sliding_wear_has_its_exponent() {
    let found = fit(HEAVY, &["--from-zero", "--power-law", "--compare"]);
    // Roots of the likelihood equations by mpmath; the text of JSON is exact.
    close(&found["exponent"], 0.206_019_983_598_03, 1e-10);
    close(&found["alpha"], 27.458_294_614_152, 1e-10);
    close(&found["beta"], 2.594_459_464_416_3, 1e-10);
    close(&found["log_likelihood"], -51.281_265_004_615, 1e-12);
    close(&found["aic"], 2.0 * 3.0 + 2.0 * 51.281_265_004_615, 1e-12);
    assert_eq!(found["n"], 32);
    assert_eq!(found["covariance"].as_array().expect("a matrix").len(), 3);
    assert!(found["se_alpha"].is_number() && found["se_beta"].is_number());
    assert_eq!(found["comparison"][1]["process"], "Wiener");
    close(&fit(HEAVY, &["--power-law"])["log_likelihood"], -44.166_706_950_88, 1e-12);
}

#[test]
fn the_two_shrinking_scars_of_the_whole_set_are_named() {
    let file = "gamma/tests/data/sliding_wear.csv";
    let answer = linkwear(&[&["fit", file], &COLUMNS[..], &["--format", "json"]].concat());
    assert_eq!(answer.code, 1);
    let error = answer.errors()[0].clone();
    let message = error["message"].as_str().expect("a text");
    assert!(message.contains("unit 104") && message.contains("unit 105"), "{message}");
    assert!(message.starts_with("2 increment(s)") && error["line"].is_number(), "{error}");
}

#[test]
fn groups_are_fitted_alone_and_together() {
    let file = "gamma/tests/data/gaas_lasers.csv";
    let text = fs::read_to_string(file).expect("the table");
    let grouped = text.lines().map(|line| match line.split(',').next() {
        Some("unit") => format!("{line},half\n"),
        Some(unit) if line.starts_with('#') || unit.is_empty() => format!("{line}\n"),
        Some(unit) => format!("{line},{}\n", if unit.len() > 1 { "late" } else { "early" }),
        None => String::new(),
    });
    let path = written("groups", &grouped.collect::<String>());
    let shown = path.display().to_string();
    let columns =
        ["fit", &shown, "--unit", "unit", "--wear", "current_increase_percent", "--exposure", "hours"];
    let found = linkwear(&[&columns[..], &["--groups", "half", "--format", "json"]].concat()).json();
    fs::remove_file(path).expect("the file");
    // Published per 1000 hours, 28.75350606.
    close(&found["alpha"], 28.753_506_06e-3, 1e-8);
    close(&found["beta"], 14.114_459_33, 1e-8);
    assert_eq!(found["groups"].as_array().expect("a list").len(), 2);
    assert_eq!(found["group_test"]["degrees"], 2);
}

#[test]
fn bad_data_are_named_with_line_and_cure() {
    let cases = [
        ("unsorted", "a,2,1\na,1,2\n", 3, "goes back"),
        ("twice", "a,2,1\na,2,2\n", 3, "twice"),
        ("single", "a,1,1\n", 2, "one reading"),
        ("increment", "a,1,1\na,2,2\n", 3, "1 increment"),
        ("constant", "a,1,1\na,2,1\na,3,1\n", 2, "constant"),
        ("nan", "a,1,1\na,2,NaN\n", 3, "not a finite number"),
        ("units", "a,1,1\na,2 h,2\n", 3, "a number with a unit"),
        ("short", "a,1,1\na,2\n", 3, "no CSV table"),
    ];
    for (name, rows, line, words) in cases {
        let error = refused(name, rows, &[]);
        assert_eq!(error["line"], line, "{error}");
        assert!(error["message"].as_str().expect("a text").contains(words), "{error}");
    }
}

#[test]
fn a_misspelt_column_is_suggested() {
    let answer = linkwear(&["fit", HEAVY, "--unit", "unit", "--wear", "wear_mu", "--exposure", "cycles"]);
    assert_eq!(answer.code, 1);
    assert!(answer.err.contains("did you mean `wear_um`?"), "{}", answer.err);
}

#[test]
fn the_bootstrap_repeats_its_bits_and_the_fit_is_written_whole() {
    let out = std::env::temp_dir().join(format!("linkwear-fit-{}-out.json", std::process::id()));
    let shown = out.display().to_string();
    let more = ["--power-law", "--bootstrap", "50", "--seed", "3", "--out", &shown];
    let first = fit(HEAVY, &more);
    assert_eq!(first, fit(HEAVY, &more));
    let written: Value = serde_json::from_str(&fs::read_to_string(&out).expect("the fit")).expect("JSON");
    fs::remove_file(out).expect("the file");
    for key in ["alpha", "beta", "exponent", "covariance", "n", "wear_unit", "exposure_unit"] {
        assert_eq!(written[key], first[key], "{key}");
    }
}
