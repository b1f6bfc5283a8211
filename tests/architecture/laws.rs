//! A law of contact or wear is named in one file only, so that another one touches one.

use std::collections::BTreeSet;
use std::fmt::Debug;
use std::path::Path;

use linkwear_runtime::contact::{Onset, Restitution, Stiffness, Strength};
use linkwear_runtime::wear::Area;

use crate::source::{code, rust_files};

/// Files of the product in which one of the texts stands outside comments and tests.
fn files_with(texts: &[String]) -> BTreeSet<String> {
    let roots = ["codegen/src", "reader/src", "runtime/src", "gamma/src", "src"];
    let files = roots.iter().flat_map(|root| rust_files(Path::new(root)));
    let files = files.filter(|file| {
        !file.ends_with("tests.rs") && !file.components().any(|part| part.as_os_str() == "tests")
    });
    let found = files.filter(|file| {
        let code = code(file);
        texts.iter().any(|text| code.contains(text))
    });
    found.map(|file| file.display().to_string()).collect()
}

/// A law as other files would name it: `Strength::Coulomb`.
fn path(kind: &str, law: impl Debug) -> String {
    let law = format!("{law:?}");
    format!("{kind}::{}", law.split([' ', '(']).next().unwrap_or_default())
}

fn assert_in_one_file(file: &str, texts: &[String]) {
    assert!(texts.len() > 1);
    let found = files_with(texts);
    assert!(found.iter().all(|found| found == file), "{texts:?} are for {file}, found in {found:?}");
}

#[test]
fn a_law_with_a_word_stands_in_one_file() {
    let word = |word: &str| format!("\"{word}\"");
    let laws = Restitution::ALL.iter().flat_map(|law| [word(law.name()), path("Restitution", law)]);
    assert_in_one_file("runtime/src/contact/restitution.rs", &laws.collect::<Vec<_>>());
    let areas = Area::ALL.iter().flat_map(|area| [word(area.name()), path("Area", area)]);
    assert_in_one_file("runtime/src/wear/area.rs", &areas.collect::<Vec<_>>());
}

#[test]
fn a_law_with_constants_stands_in_one_file() {
    let strengths = [Strength::new(0.1, None), Strength::new(0.1, Some((0.2, 0.01)))];
    let onsets = [Onset::new(1e-3, None), Onset::new(1e-4, Some(1e-3))];
    let friction =
        strengths.map(|law| path("Strength", law)).into_iter().chain(onsets.map(|law| path("Onset", law)));
    assert_in_one_file("runtime/src/contact/friction.rs", &friction.collect::<Vec<_>>());
    let stiffness = [Stiffness::new(Some(1e9), 1e11), Stiffness::new(None, 1e11)];
    assert_in_one_file("runtime/src/contact/stiffness.rs", &stiffness.map(|law| path("Stiffness", law)));
}
