//! `check`, `equations` and `generate` on shipped mechanisms: fields scripts rely on, and what people read.

use crate::command::{Folder, linkwear};
use serde_json::Value;

/// The fields of an `operations` object, in order.
const OPERATIONS: [&str; 6] = ["mul", "add", "div", "sqrt", "sincos", "total"];

fn assert_operations(value: &Value) {
    let object = value.as_object().expect("an object");
    assert_eq!(object.keys().map(String::as_str).collect::<Vec<_>>(), OPERATIONS);
    let counts: Vec<u64> = object.values().map(|count| count.as_u64().expect("a count")).collect();
    assert_eq!(counts[..5].iter().sum::<u64>(), counts[5]);
}

#[test]
fn check_counts_the_rssr_before_drivers_take_freedoms_away() {
    let answer = linkwear(&["check", "mechanisms/rssr_rigid.toml", "--format", "json"]).json();
    for name in
        ["bodies", "joints", "coordinates", "speeds", "constraint_rows", "independent_rows", "mobility"]
    {
        assert!(answer[name].is_number(), "{name}");
    }
    for name in ["drivers", "idle", "redundant", "warnings"] {
        assert!(answer[name].is_array(), "{name}");
    }
    // Three bars on four joints; cut at S3 (3 rows): R1 1, S2 3, R4 1 speeds, a quaternion for S2.
    assert_eq!((&answer["bodies"], &answer["joints"]), (&3.into(), &4.into()));
    assert_eq!((&answer["coordinates"], &answer["speeds"]), (&6.into(), &5.into()));
    assert_eq!((&answer["constraint_rows"], &answer["independent_rows"]), (&3.into(), &3.into()));
    // The crank's angle and the coupler's spin about its own line.
    assert_eq!(answer["mobility"], 2);
    assert_eq!(answer["idle"].as_array().map(Vec::len), Some(1));
    assert_eq!(answer["drivers"].as_array().map(Vec::len), Some(1));
    assert_eq!(answer["redundant"], Value::Array(Vec::new()));
}

#[test]
fn check_names_the_three_redundant_rows_of_a_planar_four_bar() {
    let answer = linkwear(&["check", "mechanisms/four_bar.toml", "--format", "json"]).json();
    assert_eq!(answer["mobility"], 1);
    let redundant = answer["redundant"].as_array().expect("a list");
    assert_eq!(redundant.len(), 3);
    for row in redundant {
        for field in ["joint", "row", "reason"] {
            assert!(row[field].as_str().is_some_and(|text| !text.is_empty()), "{field}");
        }
    }
}

#[test]
fn check_reads_well() {
    insta::assert_snapshot!("check_pendulum", linkwear(&["check", "mechanisms/pendulum.toml"]).out);
    insta::assert_snapshot!("check_four_bar", linkwear(&["check", "mechanisms/four_bar.toml"]).out);
    insta::assert_snapshot!("check_rssr_rigid", linkwear(&["check", "mechanisms/rssr_rigid.toml"]).out);
}

#[test]
fn equations_lists_every_output_with_its_cost() {
    let answer = linkwear(&["equations", "mechanisms/rssr_rigid.toml", "--format", "json"]).json();
    let outputs = answer["outputs"].as_array().expect("a list");
    assert!(!outputs.is_empty());
    for output in outputs {
        assert!(output["name"].is_string());
        assert!(output["rows"].is_u64() && output["cols"].is_u64());
        assert_operations(&output["operations"]);
        assert_operations(&output["operations_unshared"]);
        let total = |name: &str| output[name]["total"].as_u64();
        assert!(total("operations") <= total("operations_unshared"), "{output}");
    }
}

#[test]
fn cost_counts_and_times_every_entry_point() {
    let file = "mechanisms/pendulum.toml";
    let cost = linkwear(&["cost", file, "--format", "json"]).json();
    let generated = linkwear(&["generate", file, "--format", "json"]).json();
    for expected in generated["entry_points"].as_array().expect("a list") {
        let point = &cost["entry_points"][expected["name"].as_str().expect("a name")];
        assert_operations(&point["operations"]);
        assert_eq!(point["operations"], expected["operations"]);
        let sections = point["sections"].as_array().expect("a list").iter();
        let sum: u64 =
            sections.map(|section| section["operations"]["total"].as_u64().expect("a count")).sum();
        assert_eq!(point["operations"]["total"], sum);
        // A shipped file has both for certain; the others depend on the processor.
        assert!(
            point["ns"]["interpreter"].as_f64() > Some(0.0) && point["ns"]["compiled"].as_f64() > Some(0.0)
        );
        for name in ["native", "lanes4", "lanes8"] {
            assert!(point["ns"][name].is_number() || point["ns"][name].is_null(), "{name}");
        }
    }
    let turn = &cost["turn"];
    assert!(turn["backend"] == "native" || turn["backend"] == "compiled", "{turn}");
    assert!(turn["steps"].as_u64() > Some(0) && turn["milliseconds"].as_f64() > Some(0.0), "{turn}");
}

#[test]
fn cost_of_a_drive_that_swings_is_that_of_a_second() {
    let cost = linkwear(&["cost", "tests/data/delta.toml", "--format", "json"]).json();
    assert_eq!(cost["turn"]["time_s"], 1.0, "{cost}");
    assert!(cost["turn"]["steps"].as_u64() > Some(0), "{cost}");
}

#[test]
fn equations_can_be_narrowed_to_one_output() {
    let all = linkwear(&["equations", "mechanisms/pendulum.toml", "--format", "json"]).json();
    let name = all["outputs"][0]["name"].as_str().expect("a name").to_owned();
    let arguments = ["equations", "mechanisms/pendulum.toml", "--only", &name, "--format", "json"];
    let one = linkwear(&arguments).json();
    let outputs = one["outputs"].as_array().expect("a list");
    assert!(!outputs.is_empty() && outputs.iter().all(|output| output["name"] == name.as_str()));
}

#[test]
fn equations_suggests_a_name_near_the_one_given() {
    let answer = linkwear(&["equations", "mechanisms/pendulum.toml", "--only", "forward_dinamics"]);
    assert_eq!(answer.code, 1);
    assert!(answer.err.contains("did you mean `forward_dynamics`?"), "{}", answer.err);
}

#[test]
fn generate_writes_what_check_then_accepts() {
    let folder = Folder::new("generate");
    let out = folder.path("pendulum.rs");
    let written = linkwear(&["generate", "mechanisms/pendulum.toml", "-o", &out, "--format", "json"]).json();
    assert_operations(&written["operations"]);
    for name in ["functions", "statements", "seconds"] {
        assert!(written[name].is_number(), "{name}");
    }
    assert_eq!(folder.names(), ["pendulum.rs"]);
    let fresh = linkwear(&["generate", "mechanisms/pendulum.toml", "-o", &out, "--check"]);
    assert_eq!(fresh.code, 0, "{}", fresh.err);
    // From wherever the file is named.
    let elsewhere =
        folder.write("pendulum.toml", &std::fs::read_to_string("mechanisms/pendulum.toml").unwrap());
    let fresh = linkwear(&["generate", &elsewhere, "-o", &out, "--check"]);
    assert_eq!(fresh.code, 0, "{}", fresh.err);

    let stale = folder.read("pendulum.rs").replacen("pub ", "pub(crate) ", 1);
    folder.write("pendulum.rs", &stale);
    let answer =
        linkwear(&["generate", "mechanisms/pendulum.toml", "-o", &out, "--check", "--format", "json"]);
    assert_eq!(answer.code, 1);
    assert_eq!(answer.errors()[0]["code"], "C0005");
    assert!(answer.errors()[0]["line"].as_u64() > Some(0));
    assert_eq!(folder.read("pendulum.rs"), stale, "--check writes nothing");
}

#[test]
fn generate_gives_the_same_bytes_in_every_process() {
    let source = || linkwear(&["generate", "mechanisms/rssr_rigid.toml"]).out;
    let first = source();
    assert!(first.len() > 1000);
    assert_eq!(first, source());
}

#[test]
fn generate_refuses_to_write_over_its_input() {
    let folder = Folder::new("over");
    let text = std::fs::read_to_string("mechanisms/pendulum.toml").expect("a file");
    let file = folder.write("pendulum.toml", &text);
    assert_eq!(linkwear(&["generate", &file, "-o", &file]).code, 1);
    assert_eq!(folder.read("pendulum.toml"), text);
}

#[test]
fn check_tells_the_other_way_to_close_the_loops_and_assembly_takes_it() {
    let assembly = |file: &str| linkwear(&["check", file, "--format", "json"]).json()["assembly"].clone();
    let degrees = |value: &Value| value.as_f64().expect("a number").to_degrees();
    // The triangle A-C-D above the ground and below: 55.8 deg and 97.2 deg, by the law of cosines.
    let four_bar = assembly("mechanisms/four_bar.toml");
    let others = four_bar["others"].as_array().expect("a list");
    assert_eq!(others.len(), 1, "a four-bar has two ways");
    for (way, sign) in [(&four_bar["taken"], 1.0), (&others[0], -1.0)] {
        assert!((degrees(&way["R2.q"]) - sign * 55.8).abs() < 0.06, "{way}");
        assert!((degrees(&way["R4.q"]) - sign * 97.2).abs() < 0.06, "{way}");
    }
    let text = linkwear(&["check", "mechanisms/four_bar.toml"]).out;
    let line = text.lines().find(|line| line.trim_start().starts_with("or ")).expect("the other way");
    let copied = line.trim_start().trim_start_matches("or ").trim().replace(", ", "\n");
    let folder = Folder::new("other_way");
    let file = std::fs::read_to_string("mechanisms/four_bar.toml").expect("it is there");
    let (before, _) = file.split_once("R2 = \"56 deg\"").expect("guesses end the file");
    folder.write("four_bar.toml", &format!("{before}{copied}\n"));
    let other = folder.linkwear(&["check", "four_bar.toml", "--format", "json"]).json()["assembly"].clone();
    assert_eq!(other["taken"], others[0]);
    assert_eq!(other["others"][0], four_bar["taken"]);
    let none = assembly("mechanisms/pendulum.toml");
    assert_eq!(none["others"], Value::Array(Vec::new()), "no loop, no choice");
}

#[test]
fn check_lists_couplings_stops_states_and_sensors() {
    let asked = |name: &str| {
        let file = format!("examples/data/{name}.toml");
        (linkwear(&["check", &file]).out, linkwear(&["check", &file, "--format", "json"]).json())
    };
    let (text, gears) = asked("planetary_gear");
    let inner = &gears["couplings"][0];
    assert_eq!(
        (&inner["name"], &inner["kind"], &inner["rigid"]),
        (&"inner".into(), &"gears".into(), &true.into())
    );
    // Wheels of 20 teeth of 2 mm: pitch radii of 20 mm.
    let radii = inner["terms"]
        .as_array()
        .expect("terms")
        .iter()
        .map(|term| term["factor"].as_f64().expect("a number"));
    assert!(
        radii
            .into_iter()
            .all(|radius| (radius.abs() - 0.02).abs() < 1e-12 || (radius.abs() - 0.04).abs() < 1e-12),
        "{inner}"
    );
    assert!(text.contains("\nCouplings\n") && !text.contains("\nStops\n"), "{text}");
    let (text, hammer) = asked("drop_hammer");
    let blow = &hammer["stops"][0];
    assert_eq!(
        (&blow["coordinate"], &blow["upper"], &blow["unit"]),
        (&"guide.q".into(), &0.3.into(), &"m".into())
    );
    assert_eq!((&blow["loss"], &hammer["stops"][1]["loss"]), (&"restitution".into(), &"damping".into()));
    assert!(hammer["stops"][1]["upper"].is_null() && text.contains("\nStops\n"), "{text}");
    let (text, crank) = asked("servo_crank");
    let units: Vec<&Value> =
        crank["states"].as_array().expect("states").iter().map(|state| &state["unit"]).collect();
    assert_eq!(units, ["kg m^2 s^-2"; 3]);
    assert_eq!(
        (&crank["sensors"][0]["name"], &crank["sensors"][0]["unit"]),
        (&"side".into(), &"kg m s^-2".into())
    );
    assert!(text.contains("\nStates\n") && text.contains("\nSensors\n"), "{text}");
    let pendulum = linkwear(&["check", "mechanisms/pendulum.toml", "--format", "json"]).json();
    assert!(["couplings", "stops", "states", "sensors"].iter().all(|key| pendulum[*key].is_null()));
}

#[test]
fn a_hardness_is_given_as_in_the_file() {
    let check = |set: &str| linkwear(&["check", "mechanisms/rssr.toml", "--set", set]);
    for hardness in ["hardness=60 HRC", "hardness=700 HV", "hardness=7 GPa"] {
        let answer = check(hardness);
        assert_eq!(answer.code, 0, "{hardness}: {}", answer.err);
    }
    assert!(check("hardness=60 kg").err.contains("E0303"));
    let folder = Folder::new("hardness");
    let text = std::fs::read_to_string("examples/data/worn_journal.toml").expect("a shipped file");
    assert!(text.contains("hardness_ratio = 0.5"));
    let with = |journal: &str| {
        let file = folder.write("journal.toml", &text.replace("hardness_ratio = 0.5", journal));
        linkwear(&["check", &file])
    };
    let journal = with("journal_hardness = \"700 HV\"");
    assert_eq!(journal.code, 0, "{}", journal.err);
}
