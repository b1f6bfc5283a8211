//! `predict`: what can be asked beyond the usual: any quantile, times, missions, dates, machines of several joints.

use crate::command::{Folder, linkwear};
use linkwear_gamma::life::{Clock, FirstPassage, Law, Lifetime};
use linkwear_gamma::process::Gamma;
use serde_json::Value;

const LASERS: &str = "examples/data/gaas_lasers.csv";

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

fn fit(folder: &Folder, name: &str, more: &[&str]) -> String {
    let file = folder.path(name);
    let mut words = vec!["fit", LASERS, "--unit", "unit", "--wear", "percent", "--exposure", "khours"];
    words.extend(["--from-zero", "--out", &file]);
    words.extend(more);
    assert_eq!(linkwear(&words).code, 0);
    file
}

/// The fitted law itself, from wear and exposure on.
fn law(fit: &str, wear: f64, exposure: f64) -> FirstPassage {
    let json: Value =
        serde_json::from_str(&std::fs::read_to_string(fit).expect("it is there")).expect("JSON");
    let law = Law::new(&Gamma, [number(&json["alpha"]), number(&json["beta"])]).expect("valid");
    FirstPassage::from(law, Clock::linear(1.0).expect("valid"), 10.0, wear, exposure).expect("valid")
}

fn asked(words: &[&str]) -> Value {
    let mut all = vec!["predict"];
    all.extend(words);
    all.extend(["--format", "json"]);
    linkwear(&all).json()
}

/// Answers and formulas are the same but for the last digits of sums.
fn near(value: &Value, expected: f64) {
    let value = number(value);
    assert!((value / expected - 1.0).abs() < 1e-9, "{value} {expected}");
}

#[test]
fn every_answer_is_that_of_the_law() {
    let folder = Folder::new("predict-questions");
    let fit = fit(&folder, "fit.json", &[]);
    let life = law(&fit, 5.0, 2.5);
    let words =
        ["--threshold", "10", "--current", "5", "--at", "2.5", "--quantile", "1%", "--quantile", "0.25"];
    let more = ["--reliability-at", "2", "--mission", "1..2", "--survived", "0.5"];
    let told = asked(&[&[fit.as_str()], &words[..], &more[..]].concat());
    let alive = |t: f64| life.reliability(0.5 + t) / life.reliability(0.5);
    near(&told["missions"][0]["survival"], alive(2.0) / alive(1.0));
    near(&told["asked_times"][0]["reliability"], alive(2.0));
    near(&told["asked_times"][0]["hazard"], life.hazard(2.5));
    for (at, p) in [(0, 0.01), (1, 0.25)] {
        let quantile = &told["asked_quantiles"][at];
        assert_eq!(number(&quantile["p"]), p);
        assert!((alive(number(&quantile["time"])) - (1.0 - p)).abs() < 1e-11);
        assert!(number(&quantile["lower"]) < number(&quantile["time"]));
    }
    let rest = number(&told["asked_times"][0]["mean_residual_life"]);
    assert!(rest > 0.0 && rest < number(&told["mean"]), "{rest}");
    // Without the questions nothing is added.
    let usual = asked(&[&fit, "--threshold", "10"]);
    for key in ["asked_quantiles", "asked_times", "missions", "dates", "machine"] {
        assert!(usual.get(key).is_none(), "{key}");
    }
}

#[test]
fn a_machine_fails_with_the_first_of_its_joints() {
    let folder = Folder::new("predict-machine");
    let (left, right) = (fit(&folder, "left.json", &[]), fit(&folder, "right.json", &["--seed", "2"]));
    let also = format!("{right}:10:4:2");
    let told = asked(&[&left, "--threshold", "10", "--also", &also, "--reliability-at", "2.5"]);
    let (a, b) = (law(&left, 0.0, 0.0), law(&right, 4.0, 2.0));
    near(&told["machine"]["asked_times"][0]["reliability"], a.reliability(2.5) * b.reliability(2.5));
    let first = told["machine"]["first_to_fail"].as_array().expect("two");
    let names: Vec<&str> = first.iter().map(|one| one["joint"].as_str().expect("a name")).collect();
    assert_eq!(names, ["left", "right"]);
    near(&Value::from(first.iter().map(|one| number(&one["probability"])).sum::<f64>()), 1.0);
    assert!(number(&told["machine"]["mean"]) < number(&told["mean"]));
    // The other joint has its own faults.
    let worn = format!("{right}:10:11");
    let answer = linkwear(&["predict", &left, "--threshold", "10", "--also", &worn]);
    assert_eq!(answer.code, 2);
    assert!(answer.err.contains("right.json") && answer.err.contains("has failed"), "{}", answer.err);
    let twice = linkwear(&["predict", &left, "--threshold", "10", "--also", &format!("{left}:10")]);
    assert!(twice.out.contains("the same fit"), "{}", twice.out);
}

#[test]
fn dates_follow_the_calendar() {
    let folder = Folder::new("predict-dates");
    let fit = fit(&folder, "fit.json", &[]);
    let words =
        ["--threshold", "10", "--from", "2026-11-23", "--per-day", "0.016", "--working-days", "mon-fri"];
    let told = asked(&[&[fit.as_str()], &words[..]].concat());
    // B50 of 4.92 khours is the 308th working day: 61 weeks of five and the third day after.
    assert_eq!(told["dates"]["quantiles"]["p50"], "2028-01-26");
    for bad in [
        &["--from", "2026-11-23"][..],
        &["--from", "yesterday", "--per-day", "1"],
        &["--per-day", "1"],
        &["--from", "2026-11-23", "--per-day", "0"],
        &["--from", "2026-11-23", "--per-day", "1", "--pause", "2026-12-24"],
    ] {
        let answer = linkwear(&[&["predict", &fit, "--threshold", "10"], bad].concat());
        assert_eq!(answer.code, 2, "{bad:?} {}", answer.err);
    }
}

#[test]
fn a_catalogue_stands_in_for_other_units() {
    let folder = Folder::new("predict-catalogue");
    let fit = fit(&folder, "fit.json", &[]);
    let log = folder.write("log.csv", "kh,percent\n0,0\n0.25,0.6\n0.5,1.1\n0.75,1.4\n1,2.1\n");
    let words = [&fit, "--threshold", "10", "--inspections", &log, "--time", "kh", "--wear", "percent"];
    let alone = asked(&[&words[..], &["--flat-prior"]].concat());
    let slow = asked(&[&words[..], &["--catalogue", "0.9..1.1"]].concat());
    assert_eq!(slow["from"], "catalogue and inspections");
    // Seen 2.1 a khour, by the catalogue 1: it lives longer than by its readings, not as long as by the catalogue alone.
    let (alone, slow) = (number(&alone["quantiles"]["p50"]), number(&slow["quantiles"]["p50"]));
    assert!(alone < slow && slow < 8.9, "{alone} {slow}");
    let power = self::fit(&folder, "power.json", &["--power-law"]);
    let answer = linkwear(&[&["predict", &power], &words[1..], &["--catalogue", "0.9..1.1"]].concat());
    assert_eq!(answer.code, 2, "{}", answer.err);
}

#[test]
fn what_cannot_be_asked_is_answered() {
    let folder = Folder::new("predict-no-question");
    let fit = fit(&folder, "fit.json", &[]);
    for bad in [
        &["--quantile", "1"][..],
        &["--quantile", "B1"],
        &["--mission", "2..1"],
        &["--reliability-at", "-1"],
        &["--survived", "nan"],
        &["--also", "other.json"],
        &["--also", "other.json:0"],
        &["--catalogue", "1..2"],
    ] {
        let answer = linkwear(&[&["predict", &fit, "--threshold", "10"], bad].concat());
        assert_eq!(answer.code, 2, "{bad:?} {}", answer.err);
    }
    for (bad, cause) in [
        (&["--survived", "100"][..], "without failing"),
        (&["--mission", "100..101"], "without failing"),
        (&["--also", "missing.json:1"], "missing.json"),
    ] {
        let answer = linkwear(&[&["predict", &fit, "--threshold", "10"], bad].concat());
        assert_eq!(answer.code, 1, "{bad:?} {}", answer.err);
        assert!(answer.err.contains(cause), "{}", answer.err);
    }
}
