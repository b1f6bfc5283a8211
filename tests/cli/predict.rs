//! `predict`: remaining life from a fit file and from inspections, by the command line.

use crate::command::{Folder, linkwear};
use linkwear_gamma::life::{Bands, Clock, Estimate, FirstPassage, Law, Lifetime, Method, OperatingState};
use linkwear_gamma::process::Gamma;
use serde_json::Value;

/// GaAs lasers (Meeker & Escobar 1998, table C.17), fit published with the R package `gammaprocesses`; exposure is
/// hours/1000. The covariance is the inverse of the information, which needs alpha, beta and the 240 steps of 0.25 alone.
const LASERS: &str = r#"{
  "alpha": 28.75350606,
  "beta": 14.11445933,
  "exponent": null,
  "se_alpha": 2.566,
  "se_beta": 1.305,
  "covariance": [[6.585490176522216, 3.232671280875349], [3.232671280875349, 1.7023213304378222]]
}"#;

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

fn lasers(folder: &Folder) -> String {
    folder.write("fit.json", LASERS)
}

/// Message and line of the only error.
fn refusal(arguments: &[&str]) -> (String, Option<u64>) {
    let answer = linkwear(arguments);
    assert_eq!(answer.code, 1, "{}{}", answer.out, answer.err);
    let error = answer.errors()[0].clone();
    assert!(error["file"].is_string(), "{error}");
    (error["message"].as_str().expect("a text").to_owned(), error["line"].as_u64())
}

#[test]
fn lasers_have_the_published_quantiles_and_band() {
    let folder = Folder::new("predict-lasers");
    let fit = lasers(&folder);
    let life = linkwear(&["predict", &fit, "--threshold", "10", "--format", "json"]).json();
    for (key, expected) in [("p10", 4.40056787), ("p50", 4.92036645), ("p90", 5.45921661)] {
        // Published to eight decimals.
        assert!((number(&life["quantiles"][key]) - expected).abs() < 1e-8, "{key}");
        let band = &life["bands"]["quantiles"][key];
        assert!(number(&band["lower"]) < expected && expected < number(&band["upper"]));
    }
    let course = life["reliability"].as_array().expect("a list");
    let first = &course[0];
    assert_eq!((number(&first["time"]), number(&first["reliability"])), (0.0, 1.0));
    for pair in course.windows(2) {
        assert!(number(&pair[0]["reliability"]) >= number(&pair[1]["reliability"]));
        assert!(number(&pair[1]["lower"]) <= number(&pair[1]["reliability"]));
        assert!(number(&pair[1]["upper"]) >= number(&pair[1]["reliability"]));
    }
    for key in ["mean", "std", "mean_whole_cycles"] {
        assert!(life[key].is_number(), "{key}");
    }
    let parameters = number(&life["budget"]["parameters"]["half_width"]);
    assert_eq!(number(&life["budget"]["total"]), parameters);
    assert!(parameters > 0.0);
}

#[test]
fn huge_times_have_an_exponent_in_tables() {
    let folder = Folder::new("predict-huge");
    let text =
        linkwear(&["predict", &lasers(&folder), "--threshold", "1e300", "--reliability-at", "1e299"]).out;
    let row = text.lines().find(|line| line.contains("B50")).expect("a row");
    assert!(row.contains("4.908779e299"), "{row}");
    let longest = text.lines().filter(|line| !line.starts_with("warning")).map(str::len).max();
    assert!(longest.is_some_and(|longest| longest < 100), "{text}");
}

#[test]
fn a_worn_unit_counts_from_now_and_in_the_time_asked_for() {
    let folder = Folder::new("predict-worn");
    let fit = lasers(&folder);
    let common = ["predict", &fit, "--threshold", "10", "--current", "5", "--format", "json"];
    let life = linkwear(&common).json();
    // Published to eight decimals: SurPyval 0.25, `predict_rul`.
    assert!((number(&life["quantiles"]["p50"]) - 2.46597232).abs() < 1e-8);
    assert!((number(&life["interval95"]["lower"]) - 1.91631198).abs() < 1e-8);
    assert!((number(&life["interval95"]["upper"]) - 3.06025256).abs() < 1e-8);
    // A file of an older program does not hold its increments.
    assert_eq!(life["interval95"]["kind"], "plug-in");
    assert!(life["warnings"][0].as_str().expect("a text").contains("as known"), "{}", life["warnings"]);
    let hours = linkwear(&[&common[..], &["--rate", "0.001"]].concat()).json();
    assert!((number(&hours["quantiles"]["p50"]) - 2465.97232).abs() < 1e-5);
    let drawn = linkwear(&[&common[..], &["--draws", "500", "--seed", "3"]].concat());
    let again = linkwear(&[&common[..], &["--draws", "500", "--seed", "3"]].concat());
    assert_eq!(drawn.out, again.out);
}

#[test]
fn inspections_move_the_prediction() {
    let folder = Folder::new("predict-inspections");
    let fit = lasers(&folder);
    // A unit that wears twice as fast as the fit: some 4 percent in 1000 hours.
    let log = "# unit 7\nhours,percent\n0,0\n250,1.1\n500,2.0\n750,3.1\n1000,4.0\n";
    let log = folder.write("log.csv", log);
    let inspections = ["--inspections", &log, "--time", "hours", "--wear", "percent", "--rate", "0.001"];
    let common = ["predict", &fit, "--threshold", "10", "--format", "json"];
    let learned = linkwear(&[&common[..], &inspections[..]].concat()).json();
    let flat = linkwear(&[&common[..], &inspections[..], &["--flat-prior"]].concat()).json();
    let blind = ["--current", "4", "--at", "1", "--rate", "0.001"];
    let blind = linkwear(&[&common[..], &blind[..]].concat()).json();
    let median = |life: &Value| number(&life["quantiles"]["p50"]);
    // 6 percent are left: 1500 h at the unit's own pace, 2950 h at the fit's.
    assert!(median(&flat) < 1700.0, "{}", median(&flat));
    assert!(median(&flat) < median(&learned) && median(&learned) < median(&blind));
    assert_eq!(learned["current"], 4.0);
    // With so poor a gauge a unit that wears as the fit says, a reading that falls among them.
    let log = folder.write("noisy.csv", "hours,percent\n250,0.6\n500,0.5\n750,1.9\n1000,2.2\n");
    let noisy =
        ["--inspections", &log, "--time", "hours", "--wear", "percent", "--rate", "0.001", "--gauge", "0.5"];
    let gauge = linkwear(&[&common[..], &noisy[..]].concat()).json();
    // About 2.1 of 10 percent worn in 1000 h: some 3900 h are left; readings may move that by a fifth.
    assert!((3100.0..4700.0).contains(&median(&gauge)), "{}", median(&gauge));
    assert_eq!(gauge["budget"]["monte_carlo"]["kind"], "random");
}

#[test]
fn a_wrong_fit_file_is_named_with_place_and_cure() {
    let folder = Folder::new("predict-fit");
    let case = |text: &str| {
        let file = folder.write("wrong.json", text);
        refusal(&["predict", &file, "--threshold", "10", "--format", "json"])
    };
    let (message, line) = case("{\n \"alpha\": 2,\n oops");
    assert!(message.starts_with("not JSON") && line == Some(3), "{message} {line:?}");
    assert_eq!(case("{\"beta\": 2}"), ("`alpha` is missing".to_owned(), Some(1)));
    let (message, line) = case("{\n \"alpha\": 2,\n \"beta\": -1 }");
    assert!(message.contains("`beta` is -1") && line == Some(3), "{message}");
    let (message, _) = case(r#"{"alpha": 2, "beta": 1, "covariance": [[1, 2], [2, 1]]}"#);
    assert!(message.contains("negative in some direction"), "{message}");
    let (message, _) = case(r#"{"alpha": 2, "beta": 1, "se_alpha": 3, "covariance": [[1, 0], [0, 1]]}"#);
    assert!(message.contains("`se_alpha` is 3"), "{message}");
    let known = folder.write("known.json", r#"{"alpha": 2, "beta": 1}"#);
    let life = linkwear(&["predict", &known, "--threshold", "10", "--format", "json"]).json();
    assert!(life["warnings"][0].as_str().expect("a text").contains("covariance"));
    let text = linkwear(&["predict", &folder.path("none.json"), "--threshold", "10"]);
    assert!(text.code == 1 && text.err.contains("none.json"), "{}", text.err);
}

#[test]
fn questions_without_an_answer_are_refused() {
    let folder = Folder::new("predict-questions");
    let fit = lasers(&folder);
    let power = folder.write("power.json", r#"{"alpha": 27.5, "beta": 2.6, "exponent": 0.2}"#);
    let ask = |more: &[&str]| refusal(&[&["predict", "--format", "json"], more].concat()).0;
    // Wrong whatever the fit is: these were told as mistakes of its file.
    let log = folder.write("log.csv", "t,w\n0,0\n1,2\n");
    let readings = ["--inspections", &log, "--time", "t", "--wear", "w"];
    for (more, cause) in [
        (&["--threshold", "4", "--current", "5"][..], "present wear 5 has reached the threshold 4"),
        (
            &["--threshold", "9", "--also", &format!("{fit}:4:5")],
            "present wear 5 has reached the threshold 4",
        ),
        (&["--threshold", "9", "--unit", "1", "--current", "5"], "give --current and --at, or none"),
        (&[&["--threshold", "9", "--catalogue", "0..2"], &readings[..]].concat(), "two positive numbers"),
    ] {
        let wrong = linkwear(&[&["predict", &fit], more].concat());
        assert!(wrong.code == 2 && wrong.err.contains(cause), "{more:?}: {}", wrong.err);
    }
    let message = ask(&[&[fit.as_str(), "--threshold", "2"], &readings[..]].concat());
    assert!(message.contains("present wear 2 has reached the threshold 2"), "{message}");
    let message = ask(&[&power, "--threshold", "40", "--current", "5"]);
    assert!(message.contains("give the present exposure"), "{message}");
    let wrong = linkwear(&["predict", &fit]);
    assert!(wrong.code == 2 && wrong.err.contains("--threshold"), "{}", wrong.err);
    let life = linkwear(&["predict", &power, "--threshold", "40", "--current", "25", "--at", "300"]);
    assert!(life.code == 0 && life.out.contains("B50") && life.out.contains("error budget"), "{}", life.out);
}

#[test]
fn wrong_inspections_are_named_by_line() {
    let folder = Folder::new("predict-readings");
    let fit = lasers(&folder);
    let case = |text: &str, wear: &str| {
        let log = folder.write("log.csv", text);
        let more = ["--inspections", &log, "--time", "hours", "--wear", wear, "--format", "json"];
        refusal(&[&["predict", &fit, "--threshold", "10"], &more[..]].concat())
    };
    let (message, line) = case("hours,um\n0,0\n\n1,2\n2,1.5\n", "um");
    assert!(message.contains("wear falls from 2 to 1.5") && line == Some(5), "{message} {line:?}");
    let (message, line) = case("hours,um\n0,0\n2,1\n1,2\n", "um");
    assert!(message.contains("sort the readings") && line == Some(4), "{message} {line:?}");
    let (_, line) = case("# um\nhours,um\n# new\n\n0,0\n2,1\n\n# late\n1,2\n", "um");
    assert_eq!(line, Some(9));
    let (message, line) = case("hours,um\n0,0\n1,two\n", "um");
    assert!(message.contains("`um` is `two`, not a finite number") && line == Some(3), "{message} {line:?}");
    let (message, line) = case("hours,um\n0,0\n1,NaN\n", "um");
    assert!(message.contains("`um` is `NaN`, not a finite number") && line == Some(3), "{message} {line:?}");
    let (message, _) = case("hours,um\n0,0\n", "um");
    assert!(message.contains("at least 2 are needed"), "{message}");
    let (message, line) = case("hours,um\n0,0\n", "mu");
    assert!(message.contains("no column `mu`") && line == Some(1), "{message}");
    assert_eq!(case("", "um").0, "the file is empty");
}

#[test]
fn a_fit_goes_over_into_its_prediction() {
    let folder = Folder::new("predict-pipe");
    let fit = folder.path("fit.json");
    let data = "examples/data/sliding_wear_100g.csv";
    let columns = ["--unit", "unit", "--wear", "wear_um", "--exposure", "cycles"];
    let model = ["--from-zero", "--power-law", "--out", &fit, "--format", "json"];
    let found = linkwear(&[&["fit", data], &columns[..], &model[..]].concat()).json();
    let asked = ["predict", &fit, "--threshold", "50", "--current", "30", "--at", "400", "--format", "json"];
    let life = linkwear(&asked).json();

    let [alpha, beta, exponent] = ["alpha", "beta", "exponent"].map(|key| number(&found[key]));
    let law = Law::new(&Gamma, [alpha, beta]).expect("positive");
    let clock = Clock::power(1.0, exponent).expect("positive");
    let closed = FirstPassage::from(law, clock, 50.0, 30.0, 400.0).expect("wear is left");
    let row = |row: &Value| row.as_array().expect("a row").iter().map(number).collect();
    let covariance: Vec<Vec<f64>> =
        found["covariance"].as_array().expect("a matrix").iter().map(row).collect();
    let estimate = Estimate::new(&Gamma, [alpha, beta], Some(exponent)).expect("positive");
    let estimate = estimate.with_covariance(&covariance).expect("a covariance");
    let situation = OperatingState::new(50.0).and_then(|new| new.worn(30.0, 400.0)).expect("wear is left");
    let bands = Bands::new(&estimate, &situation, 0.95, Method::Delta).expect("bands");
    // The same functions of the same numbers but for exp(ln alpha): rounding, and roots good to 1e-12.
    let close = |found: &Value, expected: f64| {
        assert!((number(found) / expected - 1.0).abs() < 1e-9, "{found} {expected}");
    };
    for (key, p) in [("p10", 0.1), ("p50", 0.5), ("p90", 0.9)] {
        close(&life["quantiles"][key], closed.quantile(p).expect("a quantile"));
        let band = bands.quantile(p).expect("a band");
        close(&life["bands"]["quantiles"][key]["lower"], band.lower);
        close(&life["bands"]["quantiles"][key]["upper"], band.upper);
    }
    // The interval of lives is that of the data, wider than that of the fitted law.
    let ends = [0.025, 0.975].map(|p| closed.quantile(p).expect("a quantile"));
    assert_eq!(life["interval95"]["kind"], "predictive");
    assert!(number(&life["interval95"]["lower"]) < 0.97 * ends[0], "{}", life["interval95"]);
    assert!(number(&life["interval95"]["upper"]) > 1.03 * ends[1], "{}", life["interval95"]);
    let text = std::fs::read_to_string(&fit).expect("the fit").replacen("\"to\":", "\"till\":", 1);
    let torn =
        refusal(&["predict", &folder.write("torn.json", &text), "--threshold", "50", "--format", "json"]);
    assert!(torn.0.contains("`increments`") && torn.1.is_some(), "{torn:?}");
    close(&life["mean"], closed.moments().expect("finite").mean);
    // At the median the mean wear of the closed form stands at the threshold, but for the skew of the law.
    let median = number(&life["quantiles"]["p50"]);
    let worn = 30.0 + alpha / beta * ((400.0 + median).powf(exponent) - 400.0_f64.powf(exponent));
    assert!((worn - 50.0).abs() < 0.5 / beta, "{worn}");
}

#[test]
fn a_covariate_far_outside_the_data_is_warned_of() {
    let folder = Folder::new("predict-far");
    let mut rows = String::from("unit,h,um,load\n");
    for unit in 0..6 {
        let load = if unit % 2 == 0 { 2 } else { 5 };
        let mut wear = 0;
        for step in 0..5 {
            rows.push_str(&format!("{unit},{step},{wear},{load}\n"));
            wear += load + (3 * unit + 5 * step) % 7;
        }
    }
    let (data, fit) = (folder.write("data.csv", &rows), folder.path("fit.json"));
    let columns = ["--unit", "unit", "--exposure", "h", "--wear", "um", "--covariate", "load"];
    let fitted = linkwear(&[&["fit", &data, "--out", &fit], &columns[..]].concat());
    assert_eq!(fitted.code, 0, "{}", fitted.err);
    let costs = ["--preventive", "100", "--failure", "900"];
    for (load, is_far) in [("load=3", false), ("load=500", true)] {
        let predict = ["predict", &fit, "--threshold", "100", "--covariate", load];
        let also = format!("{fit}:50");
        let of_machine = [&predict[..], &["--also", &also]].concat();
        let plan = [&["plan", &fit, "--threshold", "100", "--covariate", load], &costs[..]].concat();
        for arguments in [&predict[..], &of_machine, &plan] {
            let is_told = |text: &str| text.contains("`load` = 500 is far outside the data");
            let told = linkwear(arguments);
            assert_eq!((told.code, is_told(&told.out)), (0, is_far), "{}{}", told.out, told.err);
            let told = linkwear(&[arguments, &["--format", "json"]].concat()).json();
            assert_eq!(is_told(&told["warnings"].to_string()), is_far, "{told}");
        }
    }
    // Of two fits that know the load, 12 is far outside the data of the second alone: it is named.
    let near = folder.write("near.csv", &rows.replace(",5\n", ",3\n"));
    let other = folder.path("near.json");
    let fitted = linkwear(&[&["fit", &near, "--out", &other], &columns[..]].concat());
    assert_eq!(fitted.code, 0, "{}", fitted.err);
    let warned = |first: &str, also: &str| {
        let also = format!("{also}:50");
        let load = ["--threshold", "100", "--covariate", "load=12", "--also", &also, "--format", "json"];
        let told = linkwear(&[&["predict", first], &load[..]].concat()).json();
        let warnings = told["warnings"].as_array().expect("a list");
        warnings.iter().map(ToString::to_string).collect::<Vec<_>>()
    };
    for warnings in [warned(&fit, &other), warned(&other, &fit)] {
        let far: Vec<_> = warnings.iter().filter(|text| text.contains("far outside")).collect();
        assert!(far.len() == 1 && far[0].contains("near.json: covariate"), "{warnings:?}");
    }
    // Joints by one fit are told of it once.
    let far = warned(&other, &other).into_iter().filter(|text| text.contains("far outside"));
    assert_eq!(far.count(), 1);
}

/// A fit with a covariate, ln alpha and its power uncertain and correlated.
const LOADED: &str = r#"{
  "alpha": 20.0,
  "beta": 10.0,
  "covariates": [{ "name": "load", "coefficient": 0.5 }],
  "covariance": [[4.0, 1.0, 0.02], [1.0, 1.0, 0.0], [0.02, 0.0, 0.0009]]
}"#;

#[test]
fn covariates_of_a_fit_are_asked_for_and_count() {
    let folder = Folder::new("predict-covariate");
    let fit = folder.write("fit.json", LOADED);
    let at = |load: &str| {
        let covariate = format!("load={load}");
        linkwear(&["predict", &fit, "--threshold", "10", "--covariate", &covariate, "--format", "json"])
            .json()
    };
    let (one, four) = (at("1"), at("4"));
    // 4 to the power 0.5: wear goes twice as fast, life is half as long. Roots are good to 1e-12.
    let median = |life: &Value| number(&life["quantiles"]["p50"]);
    assert!((median(&one) / median(&four) / 2.0 - 1.0).abs() < 1e-10);
    assert!(four["from"].as_str().expect("a text").contains("load = 4"), "{}", four["from"]);
    // ln alpha + ln 4 b: variance 4/20^2 + 2 ln 4 0.02/20 + ln 4^2 0.0009, covariance with ln beta 1/(20 10).
    let ln = 4.0_f64.ln();
    let variance = 0.01 + 2.0 * ln * 0.001 + ln * ln * 0.0009;
    let estimate = Estimate::new(&Gamma, [40.0, 10.0], None).expect("positive");
    let estimate =
        estimate.with_log_covariance(&[vec![variance, 0.005], vec![0.005, 0.01]]).expect("positive");
    let situation = OperatingState::new(10.0).expect("positive");
    let bands = Bands::new(&estimate, &situation, 0.95, Method::Delta).expect("bands");
    let band = bands.quantile(0.5).expect("a band");
    let found = &four["bands"]["quantiles"]["p50"];
    assert!((number(&found["lower"]) / band.lower - 1.0).abs() < 1e-9, "{found} {band:?}");
    assert!((number(&found["upper"]) / band.upper - 1.0).abs() < 1e-9, "{found} {band:?}");
    // The power is known least far from 1.
    let width = |life: &Value| number(&life["budget"]["parameters"]["half_width"]) / number(&life["mean"]);
    assert!(width(&four) > 1.1 * width(&one), "{} {}", width(&four), width(&one));

    let ask = |more: &[&str]| {
        let answer = linkwear(&[&["predict", &fit, "--threshold", "10", "--format", "json"], more].concat());
        assert_eq!(answer.code, 1, "{}", answer.out);
        let error = answer.errors()[0].clone();
        (
            error["message"].as_str().expect("a text").to_owned(),
            error["help"].as_str().expect("a text").to_owned(),
        )
    };
    let (message, help) = ask(&[]);
    assert!(
        message.contains("a covariate `load`") && help.contains("--covariate load=VALUE"),
        "{message} {help}"
    );
    let (message, help) = ask(&["--covariate", "laod=3"]);
    assert!(message.contains("no covariate `laod`") && help.contains("`load`"), "{message} {help}");
    let (message, _) = ask(&["--covariate", "load=3", "--covariate", "load=4"]);
    assert!(message.contains("given twice"), "{message}");
    let wrong = linkwear(&["predict", &fit, "--threshold", "10", "--covariate", "load=-3"]);
    assert!(wrong.code == 2 && wrong.err.contains("positive"), "{}", wrong.err);
    // The same file, now without covariates.
    assert_eq!(lasers(&folder), fit);
    let (message, help) = ask(&["--covariate", "load=3"]);
    assert!(
        message.contains("no covariate `load`") && help.contains("leave --covariate out"),
        "{message} {help}"
    );
    let small = LOADED
        .replace("[[4.0, 1.0, 0.02], [1.0, 1.0, 0.0], [0.02, 0.0, 0.0009]]", "[[4.0, 1.0], [1.0, 1.0]]");
    folder.write("fit.json", &small);
    assert!(ask(&["--covariate", "load=3"]).0.contains("not one of 3 parameters"));
}

#[test]
fn other_processes_are_predicted_from_as_they_are_fitted() {
    let folder = Folder::new("predict-process");
    let fit = folder.path("fit.json");
    let data = "gamma/tests/data/gaas_lasers.csv";
    let columns = ["--unit", "unit", "--wear", "current_increase_percent", "--exposure", "hours"];
    // Log-likelihoods given to seven and to four digits. Mean lives from 4 to 10 percent in closed form: left / drift, and
    // left / drift + drift / (2 spread) but for Phi(-left / drift sqrt(spread / left)).
    for (process, log_likelihood, digits) in [("wiener", 45.567_70, 1e-5), ("inverse-gaussian", 75.03, 5e-3)]
    {
        let model = ["--process", process, "--out", &fit, "--format", "json"];
        let found = linkwear(&[&["fit", data], &columns[..], &model[..]].concat()).json();
        assert_eq!(found["process"], process);
        assert!((number(&found["log_likelihood"]) - log_likelihood).abs() < digits, "{process}");
        let asked = ["predict", &fit, "--threshold", "10", "--current", "4", "--format", "json"];
        let life = linkwear(&asked).json();
        let (drift, spread) = (number(&found["drift"]), number(&found["spread"]));
        let more = if process == "wiener" { 0.0 } else { 0.5 * drift / spread };
        assert!(
            (number(&life["mean"]) / (6.0 / drift + more) - 1.0).abs() < 1e-8,
            "{process}: {}",
            life["mean"]
        );
        assert!(number(&life["budget"]["parameters"]["half_width"]) > 0.0);
        // A wrong name is refused with the right ones.
        let wrong = linkwear(&["fit", data, "--process", "levy"]);
        assert!(wrong.code == 2 && wrong.err.contains("inverse-gaussian"), "{}", wrong.err);
    }
    folder.write("fit.json", r#"{ "process": "levy", "drift": 1, "spread": 1 }"#);
    let (message, line) = refusal(&["predict", &fit, "--threshold", "10", "--format", "json"]);
    assert!(message.contains("`process` is \"levy\"") && line == Some(1), "{message}");
}

#[test]
fn a_fit_of_an_older_program_has_an_interval_by_the_covariance_and_says_so_after_few_increments() {
    // Its increments have no loads.
    let fit = |increments: usize| {
        let column = |of: &dyn Fn(usize) -> usize| (0..increments).map(of).collect::<Vec<_>>();
        let [from, to] = [column(&|at| at % 4), column(&|at| at % 4 + 1)];
        serde_json::json!({
            "alpha": 2.0, "beta": 2.0, "covariates": [{ "name": "load", "coefficient": 0.5 }],
            "covariance": [[0.2, 0.2, 0.0], [0.2, 0.3, 0.0], [0.0, 0.0, 0.1]],
            "increments": { "from": from, "to": to, "wear": vec![1.0; increments] },
        })
    };
    let folder = Folder::new("predict-few");
    let warnings = |increments| {
        let file = folder.write("fit.json", &fit(increments).to_string());
        let life =
            linkwear(&["predict", &file, "--threshold", "20", "--covariate", "load=2", "--format", "json"])
                .json();
        assert_eq!(life["interval95"]["kind"], "normal");
        life["warnings"].as_array().expect("a list").len()
    };
    assert_eq!((warnings(8), warnings(40)), (1, 0));
}

#[test]
fn after_covariates_and_rounded_readings_the_interval_counts_in_what_the_increments_leave_open() {
    let folder = Folder::new("predict-informed");
    let mut csv = "unit,t,w,load\n".to_owned();
    for unit in 0..4 {
        let mut wear = 0.0;
        for t in 0..=4 {
            csv += &format!("{unit},{t},{wear},{}\n", 1 + unit % 2);
            wear += 0.5 * [3.0, 1.0, 2.0, 4.0][(t + unit) % 4] * (1 + unit % 2) as f64;
        }
    }
    let data = folder.write("wear.csv", &csv);
    let file = folder.path("fit.json");
    let base = ["fit", &data, "--unit", "unit", "--exposure", "t", "--wear", "w", "--out", &file];
    for (fitted, asked) in
        [(["--covariate", "load"], &["--covariate", "load=1"][..]), (["--resolution", "0.5"], &[])]
    {
        assert_eq!(linkwear(&[&base[..], &fitted].concat()).code, 0);
        let ask = || {
            let base = ["predict", &file, "--threshold", "20", "--format", "json"];
            linkwear(&[&base[..], asked].concat()).json()
        };
        let life = ask();
        assert_eq!(life["interval95"]["kind"], "predictive", "{life}");
        // Increments that the fit is not of.
        let text = std::fs::read_to_string(&file).expect("written");
        let mut fit: Value = serde_json::from_str(&text).expect("JSON");
        for wear in fit["increments"]["wear"].as_array_mut().expect("a column") {
            *wear = (2.0 * wear.as_f64().expect("a number")).into();
        }
        std::fs::write(&file, fit.to_string()).expect("writable");
        let (message, _) =
            refusal(&[&["predict", &file, "--threshold", "20", "--format", "json"], asked].concat());
        assert!(message.contains("not those that the parameters"), "{message}");
        std::fs::remove_file(&file).expect("there");
    }
}
