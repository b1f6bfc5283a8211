//! The book's own mechanisms: nothing about them has to be excused, and the schema that editors use takes them.

use serde_json::Value;

use super::command::linkwear;
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
