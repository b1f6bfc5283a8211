//! `plan`: replacement, looks, spares, by the command line, from a fit and from lives.

use crate::command::{Folder, linkwear};
use serde_json::Value;

/// Wear of a Gamma process: mean 2 per unit of exposure, threshold 20 in the tests.
const FIT: &str = r#"{ "alpha": 2.0, "beta": 1.0, "exponent": null }"#;

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

fn plan(file: &str, more: &[&str]) -> Value {
    let costs = ["plan", file, "--preventive", "100", "--failure", "900", "--format", "json"];
    linkwear(&[&costs[..], more].concat()).json()
}

#[test]
fn a_fit_gives_ages_looks_and_spares_that_agree_with_each_other() {
    let folder = Folder::new("plan-fit");
    let fit = folder.write("fit.json", FIT);
    let base = ["--threshold", "20"];
    let told = plan(&fit, &[&base[..], &["--inspection", "2", "--parts", "5", "--horizon", "30"]].concat());
    // The mean life of `predict` gives the cost of waiting.
    let life = linkwear(&["predict", &fit, "--threshold", "20", "--format", "json"]).json();
    let waiting = number(&told["at_failure"]["cost_rate"]);
    assert!((waiting - 900.0 / number(&life["mean"])).abs() < 1e-9 * waiting);
    let (age, looks) = (&told["by_age"], &told["by_looks"]);
    assert!(number(&age["cost_rate"]) < waiting && number(&age["age"]) < number(&life["mean"]), "{told}");
    // Cheap looks save more than an age.
    assert!(number(&looks["cost_rate"]) < number(&age["cost_rate"]), "{told}");
    assert_eq!(looks["failures"], "at once");
    let spares = &told["spares"];
    assert!(number(&spares["by_age"]["mean"]) > number(&spares["at_failure"]["mean"]));
    for policy in ["at_failure", "by_age"] {
        assert!(number(&spares[policy]["enough"]) >= 0.95, "{spares}");
        assert!(number(&spares[policy]["needed"]) >= number(&spares[policy]["mean"]).floor(), "{spares}");
    }
    // Twice the exposure in a unit of time: half the times, twice the rates.
    let fast = plan(&fit, &[&base[..], &["--rate", "2", "--inspection", "2"]].concat());
    assert!((number(&fast["by_age"]["age"]) / number(&age["age"]) - 0.5).abs() < 1e-5);
    assert!((number(&fast["at_failure"]["cost_rate"]) / waiting - 2.0).abs() < 1e-9);
    // What only a look finds costs more than what shows at once.
    let hidden = plan(&fit, &[&base[..], &["--inspection", "2", "--downtime", "50"]].concat());
    assert_eq!(hidden["by_looks"]["failures"], "at a look");
    assert!(number(&hidden["by_looks"]["cost_rate"]) > number(&looks["cost_rate"]), "{hidden}");
    assert!(number(&hidden["by_looks"]["unnoticed"]) > 0.0);
    // A plan of one's own costs no less than the best.
    let own = [&base[..], &["--inspection", "2", "--interval", "4", "--replace-from", "10"]].concat();
    let own = plan(&fit, &own);
    assert_eq!((number(&own["by_looks"]["interval"]), number(&own["by_looks"]["threshold"])), (4.0, 10.0));
    assert!(number(&own["by_looks"]["cost_rate"]) >= number(&looks["cost_rate"]));
    // Looks that find what failed, and next to nothing else, save nothing, and are not told to save -0.00 %.
    let late = ["--inspection", "0.0001", "--interval", "1", "--replace-from", "20"];
    let told = linkwear(
        &[&["plan", &fit, "--preventive", "100", "--failure", "900"], &base[..], &late[..]].concat(),
    );
    let row = told.out.lines().find(|line| line.contains("look every 1")).expect("the plan").to_owned();
    assert!(row.contains("  0.00 %") && !row.contains("-0.00"), "{row}");
    // A look long before any failure is worth little, one at the right time something.
    let look = |at: &str| {
        let told = plan(&fit, &[&base[..], &["--look-at", at, "--current", "8"]].concat());
        number(&told["look"]["value"])
    };
    assert!(look("0.01") >= 0.0 && look("2") > look("0.01"), "{} {}", look("0.01"), look("2"));
}

#[test]
fn lives_give_the_plan_of_their_law() {
    let folder = Folder::new("plan-lives");
    // 999 quantiles of a Weibull law of shape 2.5 and scale 1000, whose best age is published: 493.05 (Python package
    // `reliability`, version 0.5) for costs of 1 and 5.
    let mut table = "trajectory,life [cycles],whole cycles,failed joint\n".to_owned();
    for k in 0..999 {
        let life = 1000.0 * (-(-(f64::from(k) + 0.5) / 999.0).ln_1p()).powf(0.4);
        table.push_str(&format!("{k},{life},{},R1\n", life.ceil()));
    }
    let file = folder.write("lives.csv", &table);
    let ask = |path: &str| {
        linkwear(&["plan", path, "--preventive", "1", "--failure", "5", "--format", "json"]).json()
    };
    let told = ask(&file);
    // Steps of 1 % in the lives; the minimum is flat.
    assert!((number(&told["by_age"]["age"]) / 493.05 - 1.0).abs() < 0.05, "{told}");
    assert!((number(&told["by_age"]["cost_rate"]) / 0.003_462 - 1.0).abs() < 0.005, "{told}");
    let folder_told = ask(file.trim_end_matches("/lives.csv"));
    assert_eq!(told["by_age"], folder_told["by_age"]);
}

#[test]
fn looks_find_what_has_failed_among_lives() {
    let folder = Folder::new("plan-hidden");
    // Quantiles of an exponential law of mean 500: what works is as good as new, and the cost has a closed form.
    let mut table = "life [cycles]\n".to_owned();
    for k in 0..2000 {
        table.push_str(&format!("{}\n", -500.0 * (-(f64::from(k) + 0.5) / 2000.0).ln_1p()));
    }
    let file = folder.write("lives.csv", &table);
    let looks = ["--inspection", "10", "--downtime", "3"];
    let told = plan(&file, &looks);
    let found = &told["by_looks"];
    let (tau, rate) = (number(&found["interval"]), number(&found["cost_rate"]));
    let looked = 1.0 / -(-tau / 500.0).exp_m1();
    let expected = (10.0 * looked + 3.0 * (tau * looked - 500.0) + 900.0) / (tau * looked);
    // The last of 2000 quantiles is at 8.3 means, and the mean a thousandth too short.
    assert!((rate / expected - 1.0).abs() < 0.005, "{found} {expected}");
    // d rate / d tau = 0: (3 * 500 - 900) (1 - (1 + x) exp(-x)) = 10 at x = 0.1942.
    assert!((tau / (0.1942 * 500.0) - 1.0).abs() < 0.1, "{found}");
    assert!(found["threshold"].is_null() && found["failures"] == "at a look", "{found}");
    // An interval of one's own costs no less.
    let own = plan(&file, &[&looks[..], &["--interval", "200"]].concat());
    assert!(number(&own["by_looks"]["interval"]) == 200.0 && number(&own["by_looks"]["cost_rate"]) > rate);
}

const DATA: &str = "examples/data/sliding_wear_100g.csv";

#[test]
fn a_fit_of_data_tells_what_it_leaves_open_and_its_readings_decide_how_much() {
    let folder = Folder::new("plan-bands");
    let columns =
        ["--unit", "unit", "--wear", "wear_um", "--exposure", "cycles", "--from-zero", "--power-law"];
    let fit = |name: &str, data: &str| {
        let out = folder.path(name);
        let told = linkwear(&[&["fit", data, "--out", &out], &columns[..]].concat());
        assert_eq!(told.code, 0, "{}", told.err);
        out
    };
    let all = fit("all.json", DATA);
    // The same readings without half of the four units.
    let text = std::fs::read_to_string(DATA).expect("shipped");
    let few: Vec<&str> =
        text.lines().filter(|line| !["111,", "112,"].iter().any(|unit| line.starts_with(unit))).collect();
    let few = fit("few.json", &folder.write("few.csv", &few.join("\n")));
    let picture = folder.path("plan.svg");
    let told = plan(&all, &["--threshold", "50", "--plot", &picture]);
    let less = plan(&few, &["--threshold", "50"]);
    let width = |told: &Value, band: &str| {
        let ends = &told["by_age"][band];
        (number(&ends["upper"]) / number(&ends["lower"])).ln()
    };
    for (band, value) in [("age_band", "age"), ("cost_rate_band", "cost_rate")] {
        let (own, ends) = (number(&told["by_age"][value]), &told["by_age"][band]);
        assert!(number(&ends["lower"]) < own && own < number(&ends["upper"]), "{told}");
        assert!(width(&less, band) > width(&told, band), "{band}: {less} {told}");
    }
    let band = &told["at_failure"]["cost_rate_band"];
    assert!(number(&band["lower"]) < number(&told["at_failure"]["cost_rate"]), "{told}");
    assert_eq!(told["by_age"]["pays"], 1.0);
    // Looks: with the interval given, what is open is the threshold.
    let looks = ["--threshold", "50", "--inspection", "30", "--interval", "500"];
    let looked = plan(&all, &looks)["by_looks"].clone();
    assert!(looked["interval_band"].is_null(), "{looked}");
    for (band, value) in [("threshold_band", "threshold"), ("cost_rate_band", "cost_rate")] {
        let (own, ends) = (number(&looked[value]), &looked[band]);
        assert!(number(&ends["lower"]) < own && own < number(&ends["upper"]), "{looked}");
    }
    let drawn = std::fs::read_to_string(&picture).expect("drawn");
    assert!(drawn.contains("what the fit leaves open, 95 %") && !drawn.contains("NaN"), "{drawn}");
    // Parameters that are taken as known leave nothing open, and a warning says why.
    let known = plan(&folder.write("known.json", FIT), &["--threshold", "20"]);
    assert!(known["by_age"]["age_band"].is_null() && known["at_failure"]["cost_rate_band"].is_null());
    assert!(known["warnings"].to_string().contains("not told"), "{known}");
}

#[test]
fn an_interval_that_is_given_is_told_as_it_is() {
    let folder = Folder::new("plan-interval");
    let fit = folder.write("fit.json", FIT);
    // By its logarithm 3 came out as 2.9999999999999996, 0.1 as 0.10000000000000002.
    for interval in ["3.0", "0.1"] {
        let told = plan(&fit, &["--threshold", "20", "--inspection", "5", "--interval", interval]);
        assert_eq!(told["by_looks"]["interval"].to_string(), interval);
    }
    let lives: String = (1..=200).map(|life| format!("{life}\n")).collect();
    let lives = folder.write("lives.csv", &format!("life [cycles]\n{lives}"));
    for (file, more) in [(&fit, ["--threshold", "20"]), (&lives, ["--downtime", "3"])] {
        let costs = ["--preventive", "100", "--failure", "900", "--inspection", "5", "--interval", "0.0001"];
        let told = linkwear(&[&["plan", file], &more[..], &costs].concat());
        assert!(told.err.contains("with a look every 0.0001, parts"), "{}", told.err);
    }
}

#[test]
fn what_cannot_be_planned_is_refused_with_the_reason() {
    let folder = Folder::new("plan-wrong");
    let fit = folder.write("fit.json", FIT);
    let refused = |arguments: &[&str]| {
        let answer = linkwear(&[&["plan"], arguments].concat());
        assert_ne!(answer.code, 0, "{}", answer.out);
        (answer.code, answer.err.clone())
    };
    let costs = ["--preventive", "100", "--failure", "900"];
    let (code, text) = refused(&[&[fit.as_str()], &costs[..]].concat());
    assert!(code == 2 && text.contains("--threshold"), "{text}");
    let (code, text) = refused(&[&fit, "--threshold", "20", "--preventive", "100", "--failure", "90"]);
    assert!(code == 2 && text.contains("pays only where a failure costs more"), "{text}");
    let failed = ["--threshold", "20", "--look-at", "1", "--current", "20"];
    let (code, text) = refused(&[&[fit.as_str()], &failed[..], &costs[..]].concat());
    assert!(code == 2 && text.contains("present wear 20 has reached"), "{text}");
    let wiener = r#"{ "process": "wiener", "drift": 2.0, "spread": 1.0, "exponent": null }"#;
    let wiener = folder.write("wiener.json", wiener);
    let looks = [&[wiener.as_str(), "--threshold", "20", "--inspection", "5"], &costs[..]].concat();
    let look = [&[wiener.as_str(), "--threshold", "20", "--look-at", "5"], &costs[..]].concat();
    for looks in [looks, look] {
        let (code, text) = refused(&looks);
        assert!(code == 1 && text.contains("never falls") && text.contains("--look-at"), "{text}");
    }
    let lives = folder.write("lives.csv", "life [cycles]\n3\n4\n");
    let (code, text) = refused(&[&[lives.as_str(), "--inspection", "5"], &costs[..]].concat());
    assert!(code == 2 && text.contains("lives tell nothing of the wear"), "{text}");
    let from = ["--inspection", "5", "--downtime", "1", "--replace-from", "3"];
    let (code, text) = refused(&[&[lives.as_str()], &from[..], &costs[..]].concat());
    assert!(code == 2 && text.contains("--replace-from"), "{text}");
    let bad = folder.write("bad.csv", "life [cycles]\n3\n-4\n");
    let (code, text) = refused(&[&[bad.as_str()], &costs[..]].concat());
    assert!(code == 1 && text.contains("bad.csv:3"), "{text}");
    // The folder of a life that was lived by its mean path alone.
    folder.write("life.json", "{}");
    std::fs::remove_file(&lives).expect("written above");
    let mean = lives.trim_end_matches("/lives.csv");
    let (code, text) = refused(&[&[mean], &costs[..]].concat());
    assert!(code == 1 && text.contains("no random lives") && text.contains("--trajectories"), "{text}");
    let above = ["--threshold", "20", "--inspection", "5", "--replace-from", "21"];
    let (code, text) = refused(&[&[fit.as_str()], &above[..], &costs[..]].concat());
    assert!(code == 2 && text.contains("from wear 21 on") && text.contains("--replace-from"), "{text}");
    let none = ["--threshold", "20", "--parts", "0", "--horizon", "5"];
    let (code, text) = refused(&[&[fit.as_str()], &none[..], &costs[..]].concat());
    assert!(code == 2 && text.contains("--parts") && text.contains("1..=1000000"), "{text}");
}
