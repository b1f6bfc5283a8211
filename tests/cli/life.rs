//! `life`: the coupled wear of the case study from the command line.

use std::process::Command;

use crate::command::{Answer, Folder, linkwear};
use linkwear_gamma::life::{Bands, Clock, Estimate, FirstPassage, Law, Lifetime, Method, OperatingState};
use linkwear_gamma::process::Gamma;
use linkwear_gamma::series::{SeriesSystem, SharedFactor};
use serde_json::Value;

const RSSR: &str = "mechanisms/rssr.toml";

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

#[test]
fn the_case_study_lives_about_twenty_five_cycles_with_the_scatter_of_its_process() {
    let folder = Folder::new("life");
    let out = folder.path("lives");
    let life = linkwear(&["life", RSSR, "--seed", "7", "--out", &out, "--format", "json"]).json();
    // The file's revolutions per cycle make the mean path 25.1, by a hand calculation good to a tenth of a cycle.
    let path = &life["mean_path"];
    assert!((number(&path["cycles"]) - 25.1).abs() < 0.1 && path["whole_cycles"] == 26, "{path}");
    let cycles = life["cycles"].as_array().expect("a list");
    assert_eq!(cycles.len(), 26);
    let clearance = |at: usize| number(&cycles[at]["joints"][0]["clearance_m"]);
    assert!(clearance(25) > clearance(0));
    // Half of the table against all of it, which the resonances of the coupler bound.
    assert!(number(&life["table_error"]) < 5e-3);

    // 1000 lives: beta W_crit = 1092 gives 1/sqrt(1092) = 3.03 %, known to 2.2 % of itself; four standard errors.
    assert_eq!((&life["trajectories"], &life["seed"]), (&Value::from(1000), &Value::from(7)));
    assert!((number(&life["cov"]) / 0.0303 - 1.0).abs() < 4.0 * 0.022, "{}", life["cov"]);
    assert!((number(&life["mean"]) - 25.1).abs() < 0.2);
    // Whole cycles add the half of one.
    assert!((number(&life["mean_whole_cycles"]) - number(&life["mean"]) - 0.5).abs() < 0.05);
    let reliability = life["reliability"].as_array().expect("a list");
    let part = |point: &Value| number(&point["reliability"]);
    assert!(part(&reliability[0]) == 1.0 && part(reliability.last().expect("a point")) == 0.0);
    assert!(reliability.windows(2).all(|pair| part(&pair[1]) <= part(&pair[0])));
    assert!(
        number(&life["error_budget"]["total"])
            > number(&life["error_budget"]["half_widths_95"]["monte_carlo"])
    );

    // The folder holds the same, and is not written to again.
    let text = |name: &str| std::fs::read_to_string(folder.path(&format!("lives/{name}"))).expect("a file");
    let kept: Value = serde_json::from_str(&text("life.json")).expect("JSON");
    assert_eq!(kept, life);
    assert_eq!((text("cycles.csv").lines().count(), text("lives.csv").lines().count()), (27, 1001));
    let again = linkwear(&["life", RSSR, "--out", &out, "--format", "json"]);
    assert_eq!((again.code, &again.errors()[0]["code"]), (1, &Value::from("C0004")));
}

#[test]
fn threads_change_no_bit_and_the_mean_path_has_no_scatter() {
    // Coarse steps: only bits are compared.
    let with = |more: &[&str]| {
        let mut arguments = vec!["life", RSSR, "--step", "5e-5", "--settle", "1", "--format", "json"];
        arguments.extend(more);
        linkwear(&arguments).json()
    };
    let lives = |threads| with(&["--trajectories", "40", "--threads", threads]);
    let one = lives("1");
    assert_eq!(one, lives("2"));
    // A system without room for a further stack: all is lived on the one thread there is.
    let mut program = Command::new("env");
    let starved =
        program.arg("RUST_MIN_STACK=1152921504606846976").arg(env!("CARGO_BIN_EXE_linkwear")).args([
            "life",
            RSSR,
            "--step",
            "5e-5",
            "--settle",
            "1",
            "--format",
            "json",
            "--trajectories",
            "40",
            "--threads",
            "4",
        ]);
    let starved = Answer::of(starved.output().expect("the program runs"));
    // A remark on the machine is no part of the result.
    assert!(starved.err.contains("the system gave 1 of 4 threads"), "{}", starved.err);
    assert_eq!(starved.json(), one);
    let mean = with(&["--mean"]);
    assert_eq!(
        (&mean["trajectories"], &mean["std"], &mean["random"]),
        (&Value::from(1), &Value::from(0.0), &Value::from(false))
    );
    assert_eq!(mean["mean"], mean["mean_path"]["cycles"]);
}

#[test]
fn a_mechanism_that_cannot_wear_says_what_is_missing() {
    let answer = linkwear(&["life", "mechanisms/rssr_rigid.toml", "--format", "json"]);
    assert_eq!(answer.code, 1);
    let help = answer.errors()[0]["help"].as_str().expect("a text").to_owned();
    assert!(help.contains("[wear.R1]"), "{help}");
}

/// A life of the rigid case study, in a hurry, that cannot be lived: its first error and all it says.
fn refused(file: &str, parameter: &str) -> (String, Value) {
    let hurry = ["--rigid", "--coupling", "full", "--step", "5e-5", "--settle", "1", "--format", "json"];
    let mut arguments = vec!["life", file, "--set", parameter];
    arguments.extend(hurry);
    let answer = linkwear(&arguments);
    assert_eq!(answer.code, 1, "{}", answer.out);
    let message = answer.errors()[0]["message"].as_str().expect("a text").to_owned();
    (message, serde_json::from_str(&answer.out).expect("one JSON object"))
}

#[test]
fn bad_input_and_bad_physics_have_their_own_words() {
    let (message, answer) = refused(RSSR, "c0=11 mm");
    assert!(message.contains("not less than its journal's radius"), "{message}");
    assert!(answer["errors"][0]["line"].is_number(), "{answer}");
    let (message, _) = refused(RSSR, "W_crit=0.5 um");
    assert!(message.contains("the first cycle wears") && message.contains("threshold"), "{message}");
}

#[test]
fn a_life_that_stops_early_keeps_the_cycles_it_had() {
    let folder = Folder::new("life-early");
    let text = std::fs::read_to_string(RSSR).expect("the case study");
    let fast = text.replace("revolutions_per_cycle = 4.9e6", "revolutions_per_cycle = 1e9");
    assert_ne!(fast, text);
    std::fs::write(folder.path("fast.toml"), fast).expect("a file");
    // The clearance grows by fractions of a millimetre a cycle, until the journal flies through it.
    let (message, answer) = refused(&folder.path("fast.toml"), "W_crit=15 mm");
    assert!(message.contains("without contact") || message.contains("journal radius"), "{message}");
    let cycles = answer["cycles"].as_array().expect("a list");
    assert!(!cycles.is_empty() && number(&cycles[0]["joints"][0]["wear_m"]) > 1e-4, "{answer}");
    let help = answer["errors"][0]["help"].as_str().expect("a text");
    assert!(help.contains(&format!("{} cycles were completed", cycles.len())), "{help}");
}

/// A life without feedback, in a hurry: wear per cycle is a constant, so there is a closed form.
fn steady(more: &[&str]) -> Answer {
    let hurry = ["life", RSSR, "--rigid", "--no-feedback", "--step", "5e-5", "--settle", "1"];
    linkwear(&[&hurry[..], more].concat())
}

/// Wear per cycle [um] and the threshold of the case study [um].
fn pace(life: &Value) -> (f64, f64) {
    (1e6 * number(&life["cycles"][0]["joints"][0]["dLambda_m"]), 80.0)
}

/// Wear a tenth faster than physics says; standard errors of a tenth, correlation 0.9.
const FITTED: &str = r#"{ "alpha": 15.0, "beta": 13.6, "over_lambda": true,
  "covariance": [[2.25, 1.836], [1.836, 1.8496]] }"#;

#[test]
fn a_fit_gives_the_scatter_and_its_uncertainty_enters_the_budget() {
    let folder = Folder::new("life-fit");
    let fit = folder.write("fit.json", FITTED);
    let lives = ["--trajectories", "400", "--format", "json", "--fit"];
    let life = steady(&[&lives[..], &[&fit]].concat()).json();
    let named = steady(&[&lives[..], &[&format!("R1={fit}")]].concat()).json();
    assert_eq!(life, named);
    assert_eq!(
        (&life["parameters"][0]["from"], &life["parameters"][0]["joint"]),
        (&fit.clone().into(), &"R1".into())
    );

    let (rate, threshold) = pace(&life);
    let estimate = Estimate::new(&Gamma, [15.0, 13.6], None).expect("positive");
    let estimate =
        estimate.with_log_covariance(&[vec![0.01, 0.009], vec![0.009, 0.01]]).expect("a covariance");
    let situation = OperatingState::new(threshold).and_then(|new| new.at_rate(rate)).expect("positive");
    let exact = situation.life(&estimate).and_then(|life| life.whole_cycles()).expect("finite");
    // Three standard errors of 400 lives.
    let (mean, error) = (number(&life["mean_whole_cycles"]), number(&life["standard_errors"]["mean"]));
    assert!((mean - exact.mean).abs() < 3.0 * error, "{mean} {exact:?}");
    // The mean path wears by alpha / beta too; its crossing of the threshold is that of a straight line.
    let path = number(&life["mean_path"]["cycles"]);
    assert!((path / (threshold / rate * 13.6 / 15.0) - 1.0).abs() < 1e-6, "{path}");

    let bands = Bands::new(&estimate, &situation, 0.95, Method::Delta).expect("bands");
    let expected = bands.mean().expect("finite").half_width();
    let budget = &life["error_budget"];
    let found = number(&budget["half_widths_95"]["parameters"]);
    // Steps of 2 %, 200 lives with their random numbers in common: some parts in a hundred at most.
    assert!((found / expected - 1.0).abs() < 0.03, "{found} {expected}");
    assert!(number(&budget["total"]) > found);

    // Without random lives the mean path has a budget too: it goes as beta / alpha, 1.96 sqrt(0.002) of it.
    let mean = steady(&["--mean", "--format", "json", "--fit", &fit]).json();
    let half = &mean["error_budget"]["half_widths_95"];
    assert_eq!((&mean["random"], number(&half["monte_carlo"])), (&Value::from(false), 0.0));
    // The covariance in the file is exact to rounding.
    assert!(
        (number(&half["parameters"]) / (1.959_963_984_540_054 * 0.002_f64.sqrt() * path) - 1.0).abs() < 1e-9
    );
}

#[test]
fn parameters_without_uncertainty_are_called_known() {
    let folder = Folder::new("life-known");
    let fit = folder.write("fit.json", r#"{ "alpha": 15.0, "beta": 13.6 }"#);
    let of_file = steady(&["--trajectories", "10"]);
    assert!(of_file.out.contains("taken as known from the mechanism's file"), "{}", of_file.out);
    let of_fit = steady(&["--trajectories", "10", "--fit", &fit]);
    assert!(
        of_fit.out.contains("the fit gives no covariance") && of_fit.out.contains("R1: alpha 15"),
        "{}",
        of_fit.out
    );
    assert!(of_fit.out.contains("warning: the fit has no `covariance`"), "{}", of_fit.out);
}

#[test]
fn a_fit_that_does_not_do_for_a_life_is_refused() {
    let folder = Folder::new("life-unfit");
    let ask = |text: &str, flag: &str| {
        let file = folder.write("fit.json", text);
        let answer = steady(&["--format", "json", "--fit", &flag.replace("FILE", &file)]);
        let error = answer.errors()[0].clone();
        let text = |key: &str| error[key].as_str().expect("a text").to_owned();
        (answer.code, text("message"), text("help"))
    };
    let cases = [
        (r#"{ "alpha": 15, "beta": 13, "exponent": 0.9 }"#, "an exponent"),
        (
            r#"{ "alpha": 15, "beta": 13, "covariates": [{ "name": "load", "coefficient": 1 }] }"#,
            "covariates",
        ),
        (r#"{ "alpha": 15, "beta": 13, "over_lambda": false }"#, "per um of Lambda"),
        (r#"{ "alpha": 15, "beta": 13e6, "over_lambda": true }"#, "times as fast as Lambda"),
    ];
    for (fit, words) in cases {
        let (code, message, help) = ask(fit, "FILE");
        assert!(code == 1 && message.contains(words), "{message}");
        assert!(help.contains("um"), "{help}");
    }
    let (code, message, help) = ask(FITTED, "R9=FILE");
    assert!(
        code == 2 && message.contains("does not say for which") && help.contains("R1"),
        "{message} {help}"
    );
}

#[test]
fn several_wearing_joints_have_a_fit_each() {
    let folder = Folder::new("life-two");
    let fit = folder.write("fit.json", FITTED);
    let other = folder.write("other.json", FITTED);
    let with = |fits: &[String]| {
        let mut arguments =
            vec!["life", "mechanisms/four_bar_wear.toml", "--settle", "1", "--format", "json"];
        arguments.extend(["--trajectories", "50"]);
        fits.iter().for_each(|text| arguments.extend(["--fit", text]));
        linkwear(&arguments)
    };
    let both = with(&[format!("R3={other}"), format!("R2={fit}")]).json();
    let from: Vec<&Value> =
        both["parameters"].as_array().expect("a list").iter().map(|joint| &joint["from"]).collect();
    assert_eq!(from, [&Value::from(fit.clone()), &Value::from(other.clone())]);
    // R2 ends every life. Whether R3 errs with it or apart matters only by what R3's wear does to R2.
    assert_eq!(both["failed_first"]["R2"], 1.0);
    let part = |life: &Value| number(&life["error_budget"]["half_widths_95"]["parameters"]);
    let together = with(&[format!("R2={fit}"), format!("R3={fit}")]).json();
    assert!((part(&both) / part(&together) - 1.0).abs() < 0.1, "{} {}", part(&both), part(&together));

    let refused = |fits: &[String], code| {
        let answer = with(fits);
        assert_eq!(answer.code, code, "{}", answer.out);
        answer.errors()[0]["message"].as_str().expect("a text").to_owned()
    };
    assert!(refused(std::slice::from_ref(&fit), 2).contains("for which wearing joint"));
    assert!(refused(&[format!("R2={fit}"), format!("R2={other}")], 2).contains("two fits"));
    assert!(refused(&[format!("R2={fit}")], 1).contains("`R3` has no Gamma process"));
}

#[test]
fn a_shared_factor_spreads_lives_as_the_closed_form_says() {
    let lives = ["--trajectories", "2000", "--format", "json", "--shared-factor"];
    let life = steady(&[&lives[..], &["0.2"]].concat()).json();
    let (rate, threshold) = pace(&life);
    let law = Law::new(&Gamma, [13.65, 13.65]).expect("positive");
    let joint = FirstPassage::new(law, Clock::linear(rate).expect("positive"), threshold).expect("positive");
    let system = SeriesSystem::sharing(vec![joint], SharedFactor::Gamma { cov: 0.2 }).expect("one joint");
    let exact = system.whole_cycles().expect("finite");
    // Three standard errors; whole cycles add 1/12 to the variance, out of some 27.
    let (mean, errors) = (number(&life["mean_whole_cycles"]), &life["standard_errors"]);
    assert!((mean - exact.mean).abs() < 3.0 * number(&errors["mean"]), "{mean} {exact:?}");
    let std = (number(&life["std"]).powi(2) + 1.0 / 12.0).sqrt();
    assert!((std - exact.std).abs() < 3.0 * number(&errors["std"]), "{std} {exact:?}");

    let wide = steady(&["--shared-factor", "0.8", "--format", "json"]);
    assert_eq!(wide.code, 2);
    assert!(wide.errors()[0]["message"].as_str().expect("a text").contains("not finite"));
    let none = steady(&["--shared-factor", "0.2", "--coupling", "full"]);
    assert!(none.code == 2 && none.err.contains("--trajectories"), "{}", none.err);
}

#[test]
fn mechanisms_without_a_life_are_told_what_they_lack() {
    let ask = |file: &str| {
        let answer = linkwear(&["life", file, "--format", "json"]);
        assert_eq!(answer.code, 1);
        let text = |key: &str| answer.errors()[0][key].as_str().expect("a text").to_owned();
        (text("message"), text("help"))
    };
    let (message, help) = ask("mechanisms/pendulum.toml");
    assert!(
        message.contains("no joint of this mechanism wears") && help.contains("[wear.R1]"),
        "{message} {help}"
    );
    let folder = Folder::new("life-undriven");
    let text = std::fs::read_to_string(RSSR).expect("the case study");
    let undriven = folder.write("undriven.toml", &text.replace(", drive = \"2*pi*speed*t\"", ""));
    let (message, help) = ask(&undriven);
    assert!(message.contains("no revolute joint is driven") && help.contains("drive = "), "{message} {help}");
}

#[test]
fn a_journal_that_rests_under_a_steady_load_wears_as_archard_says() {
    // Without friction nothing goes through such a contact, so that its balance of energy is nothing but error.
    let folder = Folder::new("life-steady-load");
    for restitution in [0.3, 0.9] {
        let text = format!(
            "spec = 1\nname = \"loaded\"\ngravity = [0, 0, 0]\n[points]\nO = [0, 0, 0]\n\
             A = [\"200 mm\", 0, 0]\nB = [\"-200 mm\", 0, 0]\n[bodies]\n\
             arm = {{ rod = [\"B\", \"A\"], radius = \"8 mm\", density = \"7850 kg/m^3\" }}\n[joints]\n\
             R1 = {{ revolute = [\"ground\", \"arm\"], at = \"O\", axis = [0, 1, 0], drive = \"2*pi*1 Hz*t\" }}\n\
             [forces]\nL = {{ force = \"arm\", at = \"O\", components = [0, 0, \"-500 N\"] }}\n[clearance.R1]\n\
             radial = \"20 um\"\njournal_radius = \"10 mm\"\nlength = \"20 mm\"\nmodulus = \"115 GPa\"\n\
             law = \"flores\"\nrestitution = {restitution}\n[wear.R1]\ncoefficient = 1e-7\nhardness = \"1 GPa\"\n\
             threshold = \"50 um\"\narea = \"projected\"\nrevolutions_per_cycle = 1e3\nalpha = \"5 1/um\"\n"
        );
        let file = folder.write("loaded.toml", &text);
        let answer = linkwear(&["life", &file, "--mean", "--format", "json"]);
        assert_eq!(answer.code, 0, "{restitution}: {}", answer.err);
        // k F 2 pi r over H 2 r L a revolution.
        let per_revolution = 1e-7 * 500.0 * std::f64::consts::TAU * 0.01 / (1e9 * 2.0 * 0.01 * 0.02);
        let expected = 50e-6 / per_revolution / 1e3;
        let life = number(&answer.json()["mean_path"]["cycles"]);
        // The load of the contact is that of the journal but for its turning away from the line through a few micrometres.
        assert!((life / expected - 1.0).abs() < 1e-5, "{restitution}: {life} for {expected}");
    }
}
