//! `life` says how far its numbers may be off, and how long they are in hours.

use crate::command::{Folder, linkwear};
use serde_json::Value;

const RSSR: &str = "mechanisms/rssr.toml";

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

fn life(more: &[&str]) -> Value {
    linkwear(&[&["life", RSSR, "--step", "5e-5", "--format", "json"], more].concat()).json()
}

#[test]
fn the_budget_holds_what_turns_that_had_not_settled_do_to_the_life() {
    let hasty = life(&["--mean", "--settle", "1"]);
    let settled = life(&["--mean", "--settle", "8"]);
    let part = |life: &Value, name: &str| number(&life["error_budget"]["half_widths_95"][name]);
    let error = (number(&hasty["mean"]) - number(&settled["mean"])).abs();
    // What is wrong is within the bound, which is no empty one: the motion settles by two thirds a turn or more.
    let bound = part(&hasty, "settling");
    assert!(error <= bound && bound < 10.0 * error, "{error} {bound}");
    assert!(part(&settled, "settling") < 1e-6 && part(&settled, "averaging") < 1e-6, "{settled}");

    // Nothing to compare with: not zero.
    let blind = life(&["--mean", "--settle", "0"]);
    let budget = &blind["error_budget"];
    let [settling, total] = [&budget["half_widths_95"]["settling"], &budget["total"]];
    assert_eq!((settling, total), (&Value::Null, &Value::Null));
}

#[test]
fn a_few_lives_have_wide_intervals_and_every_life_a_time() {
    let few = life(&["--settle", "1", "--trajectories", "5"]);
    let interval = |name: &str| {
        let ends = &few["intervals95"][name];
        [number(&ends["lower"]), number(&ends["upper"])]
    };
    // The law's own numbers: mean 25.1, and 1/sqrt(beta W_crit) = 3.03 % of it. Five lives know s by a factor 0.6 to 2.9.
    let ([low, high], std) = (interval("std"), number(&few["std"]));
    assert!(low < 0.76 && high > 0.76, "{low} {high}");
    assert!((low / std - 0.599).abs() < 1e-3 && (high / std - 2.874).abs() < 2e-3, "{low} {high} {std}");
    let [low, high] = interval("mean");
    // Student's law of four degrees of freedom.
    let half = 2.776 * number(&few["standard_errors"]["mean"]);
    assert!(low < 25.1 && high > 25.1 && (high - low - 2.0 * half).abs() < 1e-3, "{low} {high} {half}");
    let quantiles = &few["intervals95"]["quantiles"];
    assert_eq!((&quantiles["p10"]["lower"], &quantiles["p50"]["lower"]), (&Value::Null, &Value::Null));
    assert!(number(&few["standard_errors"]["quantiles"]["p50"]) > 0.0);

    // 4.9e6 turns a cycle at 2 Hz.
    let time = &few["time"];
    assert!((number(&time["seconds_per_cycle"]) - 2.45e6).abs() < 1e-3, "{time}");
    assert!((number(&time["mean"]["hours"]) - number(&few["mean"]) * 2.45e6 / 3600.0).abs() < 1e-6, "{time}");
    assert!(
        (number(&time["quantiles"]["p50"]["years"]) * 8766.0 * 3600.0 / 2.45e6
            - number(&few["quantiles"]["p50"]))
        .abs()
            < 1e-9
    );
}

/// A rotor on one journal, with a drive; more of its [wear], and what stands before its [joints].
fn rotor(folder: &Folder, (drive, wear, clock): (&str, &str, [&str; 2])) -> String {
    let [hand, clock] = clock;
    let text = format!(
        "spec = 1\nname = \"rotor\"\ngravity = [0, 0, \"-9.81 m/s^2\"]\n[points]\nO = [0, 0, 0]\n[bodies]\n{hand}\n\
         rotor = {{ mass = \"50 kg\", centre = \"O\", inertia = [\"0.02 kg m^2\", \"0.02 kg m^2\", \"0.02 kg m^2\"] }}\n[joints]\n{clock}\n\
         R1 = {{ revolute = [\"ground\", \"rotor\"], at = \"O\", axis = [0, 1, 0], drive = \"{drive}\" }}\n[clearance.R1]\n\
         radial = \"20 um\"\njournal_radius = \"10 mm\"\nlength = \"20 mm\"\nmodulus = \"100 GPa\"\nrestitution = 0.5\n\
         friction = 1e-4\n[wear.R1]\ncoefficient = 1e-7\nhardness = \"1 GPa\"\nthreshold = \"50 um\"\narea = \"projected\"\n{wear}\n"
    );
    folder.write("rotor.toml", &text)
}

const TURNS: &str = "2*pi*2 Hz*t";

/// A revolution a cycle, which is the default, makes more cycles than are lived.
#[test]
fn a_life_of_too_many_cycles_says_how_many_revolutions_a_cycle_should_have() {
    let folder = Folder::new("life-long");
    let file = rotor(&folder, (TURNS, "", ["", ""]));
    // k F s / (H A): 490.5 N, 20 pi mm a turn, an area of 2 r L.
    let exact = 50e-6 / (1e-7 * 490.5 * 0.02 * std::f64::consts::PI / (1e9 * 4e-4));
    for coupling in ["table", "full"] {
        let answer = linkwear(&["life", &file, "--mean", "--coupling", coupling, "--format", "json"]);
        assert_eq!(answer.code, 1, "{}", answer.out);
        let error = &answer.errors()[0];
        let text = |key: &str| error[key].as_str().expect("a text").to_owned();
        let (message, help) = (text("message"), text("help"));
        assert!(message.contains(&format!("joint `R1` fails after {exact:.3e}")), "{message}");
        assert!(help.contains("`revolutions_per_cycle = 1e5` in [wear.R1]"), "{help}");
        assert!(help.contains("for some 65 cycles"), "{help}");
        let lived = message.split(" cycles").next().and_then(|text| text.split(' ').next_back());
        let lived = lived.expect("a number of cycles");
        assert!(help.contains(&format!("{lived} cycles were completed")), "{message} {help}");
        // What the dynamics at every step cost is told before, and this with it.
        assert_eq!(answer.err.contains("revolutions_per_cycle = 1e5"), coupling == "full", "{}", answer.err);
    }
    let file = rotor(&folder, (TURNS, "revolutions_per_cycle = 1e5", ["", ""]));
    let life = linkwear(&["life", &file, "--mean", "--format", "json"]).json();
    assert!((number(&life["revolutions"]) / exact - 1.0).abs() < 1e-2, "{life}");
}

#[test]
fn a_machine_in_which_nothing_turns_lives_by_a_clock_beside_it() {
    let folder = Folder::new("life-clock");
    let hand =
        "hand = { mass = \"1 g\", centre = \"O\", inertia = [\"1 g mm^2\", \"1 g mm^2\", \"1 g mm^2\"] }";
    let clock = format!(
        "clock = {{ revolute = [\"ground\", \"hand\"], at = \"O\", axis = [0, 1, 0], drive = \"{TURNS}\" }}"
    );
    let (swings, wear) = ("30 deg*sin(2*pi*2 Hz*t)", "revolutions_per_cycle = 1e6");
    let alone = rotor(&folder, (swings, wear, ["", ""]));
    for command in [&["life"][..], &["life", "--coupling", "full"]] {
        let answer = linkwear(&[command, &[&alone, "--mean", "--format", "json"]].concat());
        assert_eq!(answer.code, 1, "{}", answer.out);
        let error = &answer.errors()[0];
        let text = |key: &str| error[key].as_str().expect("a text").to_owned();
        let (message, help) = (text("message"), text("help"));
        assert!(message.contains("0.0833 of a turn") && !message.contains("time span"), "{message}");
        assert!(help.contains("first in [joints]") && help.contains("once a period"), "{help}");
    }
    let file = rotor(&folder, (swings, wear, [hand, &clock]));
    let life = linkwear(&["life", &file, "--mean", "--format", "json"]).json();
    // 120 degrees a period in place of 360.
    let exact = 3.0 * 50e-6 / (1e-7 * 490.5 * 0.02 * std::f64::consts::PI / (1e9 * 4e-4));
    assert!((number(&life["revolutions"]) / exact - 1.0).abs() < 1e-2, "{exact} {life}");
}

#[test]
fn two_lives_do_not_tell_how_far_their_scatter_is_off() {
    let two = life(&["--settle", "1", "--trajectories", "2"]);
    let errors = &two["standard_errors"];
    assert_eq!((&errors["std"], &errors["cov"]["standard_error"]), (&Value::Null, &Value::Null));
    assert!(number(&errors["mean"]) > 0.0 && number(&errors["cov"]["value"]) > 0.0, "{errors}");
    let text = linkwear(&["life", RSSR, "--step", "5e-5", "--settle", "1", "--trajectories", "2"]).out;
    let row = |name: &str| text.lines().find(|line| line.contains(name)).expect("a row").to_owned();
    for name in ["standard deviation", "coefficient of variation"] {
        assert!(row(name).contains("+- ?"), "{}", row(name));
    }
}

#[test]
fn a_drive_of_uneven_turns_has_a_life_without_hours() {
    let folder = Folder::new("life-uneven");
    let text = std::fs::read_to_string(RSSR).expect("the case study");
    let uneven = text.replace("drive = \"2*pi*speed*t\"", "drive = \"2*pi*speed*t + 0.2*sin(3*speed*t)\"");
    assert_ne!(uneven, text);
    let file = folder.write("uneven.toml", &uneven);
    let arguments = ["life", &file, "--rigid", "--step", "5e-5", "--settle", "0", "--mean", "--no-feedback"];
    let json = linkwear(&[&arguments[..], &["--format", "json"]].concat()).json();
    assert_eq!(json["time"], Value::Null);
    assert!(number(&json["mean"]) > 0.0);
}

#[test]
fn a_life_by_the_dynamics_says_before_it_begins_what_it_costs_and_what_a_table_would() {
    let folder = Folder::new("life-cost");
    let text = std::fs::read_to_string(RSSR).expect("the case study");
    // Two cycles and a half, and a worn profile that is fed back.
    let worn = text.replace("[wear.R1]", "[wear.R1]\nprofile = true\nmeasure = \"maximum\"");
    let worn = folder.write("worn.toml", &worn);
    let hurry = ["--rigid", "--set", "W_crit=4 um", "--step", "5e-5", "--settle", "0", "--mean"];
    let full = linkwear(&[&["life", RSSR, "--coupling", "full"], &hurry[..]].concat());
    assert_eq!(full.code, 0, "{}", full.err);
    // The first revolution begins at rest and wears less than a settled one, 1.66 um a cycle.
    for said in [
        "full coupling",
        "would have 3 cycles: 9 to 130 measurements",
        "--coupling table takes 17 measurements",
    ] {
        assert!(full.err.contains(said), "{said}: {}", full.err);
    }
    let short =
        linkwear(&[&["life", RSSR, "--coupling", "full"], &hurry[..], &["--set", "W_crit=.5 um"]].concat());
    assert!(short.err.contains("would have less than a cycle: "), "{}", short.err);
    let profile = linkwear(&[&["life", &worn], &hurry[..]].concat());
    assert!(profile.err.contains("has no table. Without `profile = true`"), "{}", profile.err);
    let table = linkwear(&[&["life", RSSR], &hurry[..]].concat());
    assert!(!table.err.contains("coupling"), "{}", table.err);
}

#[test]
fn check_and_life_say_what_wear_is_and_when_to_take_another_measure() {
    let folder = Folder::new("life-measure");
    let text = std::fs::read_to_string(RSSR).expect("the case study");
    let kinds = [
        ("depth", "", false, "one place as large as the contact"),
        ("maximum", "measure = \"maximum\"", true, "deepest place"),
        ("mean", "measure = \"mean\"", true, "on average"),
        ("mean", "profile = true", true, "on average"),
    ];
    for (name, line, conserves, assumes) in kinds {
        let file = folder.write("measure.toml", &text.replace("[wear.R1]", &format!("[wear.R1]\n{line}")));
        let check = linkwear(&["check", &file]);
        assert!(check.out.contains("Wear W of R1 is ") && check.out.contains(assumes), "{}", check.out);
        let entry = linkwear(&["check", &file, "--format", "json"]).json()["wear_measures"][0].clone();
        assert_eq!((&entry["joint"], &entry["measure"]), (&"R1".into(), &name.into()));
        assert_eq!(entry["conserves_volume"], conserves);
    }
    let short = ["--rigid", "--set", "W_crit=4 um", "--step", "5e-5", "--settle", "0", "--mean"];
    let life = linkwear(&[&["life", RSSR], &short[..]].concat());
    assert!(life.out.contains("one place as large as the contact"), "{}", life.out);
    assert!(!linkwear(&["check", "mechanisms/rssr_rigid.toml"]).out.contains("Wear W"));
}
