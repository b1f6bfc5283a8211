//! A kind of joint stands in two files: as a row of the table, and as a key of the mechanism file.

mod source;

use linkwear_codegen::model::JOINT_KINDS;
use source::files_with;

/// Lines where the word means something else: a keyword of C alone on its line, and the variability of an FMI parameter.
fn is_another_word(line: &str) -> bool {
    line.trim() == "\"inline\"," || line.contains("{ \"fixed\" } else { \"tunable\" }")
}

#[test]
fn a_kind_is_named_in_the_table_and_in_the_file_format_only() {
    let names: Vec<String> = JOINT_KINDS.iter().map(|kind| format!("\"{}\"", kind.name)).collect();
    let named = files_with(|line| !is_another_word(line) && names.iter().any(|name| line.contains(name)));
    assert_eq!(named, ["codegen/src/model/joint_kind.rs", "reader/src/spec/joint.rs"]);
}

#[test]
fn what_a_kind_consists_of_is_matched_by_the_rules_and_in_two_files_besides() {
    assert_eq!(
        files_with(|line| line.contains("Primitive::")),
        [
            "codegen/src/derive/joint_coordinates.rs",
            "codegen/src/derive/linkage_build.rs",
            "codegen/src/model/joint_kind.rs",
            "codegen/src/model/joint_model.rs"
        ]
    );
}
