//! The book's own mechanisms: nothing about them has to be excused, and the schema that editors use takes them.

use std::fs;

use serde_json::Value;

use super::command::linkwear;
use super::schema::faults;
use super::stems;

#[test]
fn every_mechanism_of_the_book_passes_check_without_a_warning() {
    let names = stems("book/src/mechanisms", "toml");
    assert!(names.len() >= 10, "{names:?}");
    for name in names {
        let answer =
            linkwear(&["check", &format!("book/src/mechanisms/{name}.toml"), "--format", "json"]).json();
        assert_eq!(answer["name"], Value::from(name.as_str()));
        assert_eq!(answer["warnings"], Value::Array(Vec::new()), "{name}");
    }
}

#[test]
fn every_mistake_of_the_book_is_one() {
    for name in stems("book/src/mechanisms/mistakes", "toml") {
        let answer = linkwear(&["check", &format!("book/src/mechanisms/mistakes/{name}.toml")]);
        assert!(answer.code == 1 || answer.err.contains("warning[W"), "{name}: nothing is wrong with it");
    }
}

fn shipped_schema() -> Value {
    let text = fs::read_to_string("docs/linkwear.schema.json").expect("the schema");
    serde_json::from_str(&text).expect("JSON")
}

fn read(path: &str) -> Value {
    toml::from_str(&fs::read_to_string(path).expect("a mechanism")).expect("TOML")
}

#[test]
fn the_schema_takes_every_mechanism_there_is() {
    let schema = shipped_schema();
    for folder in ["mechanisms", "book/src/mechanisms"] {
        for name in stems(folder, "toml") {
            let found = faults(&schema, &read(&format!("{folder}/{name}.toml")));
            assert!(found.is_empty(), "{name}: {found:#?}");
        }
    }
}

#[test]
fn the_schema_marks_a_number_without_its_unit() {
    let (schema, pump) = (shipped_schema(), read("book/src/mechanisms/pump.toml"));
    let places = [
        ("/clearance/pin/journal_radius", Value::from(10)),
        ("/clearance/pin/journal_radius", Value::from("10.5")),
        ("/wear/pin/hardness", Value::from(1.2e9)),
        ("/points/A/0", Value::from(40)),
        ("/gravity/1", Value::from(-9.81)),
        ("/bodies/arm/radius", Value::from(12)),
        ("/joints/guide/force", Value::from(800)),
    ];
    for (place, number) in places {
        let mut wrong = pump.clone();
        *wrong.pointer_mut(place).unwrap_or_else(|| panic!("{place}")) = number;
        assert!(!faults(&schema, &wrong).is_empty(), "{place}");
    }
    for (place, number) in [
        ("/points/A/0", Value::from(0)),
        ("/wear/pin/coefficient", Value::from(1e-9)),
        ("/clearance/pin/radial", Value::from("0 m")),
    ] {
        let mut right = pump.clone();
        *right.pointer_mut(place).unwrap_or_else(|| panic!("{place}")) = number;
        assert!(faults(&schema, &right).is_empty(), "{place}");
    }
}
