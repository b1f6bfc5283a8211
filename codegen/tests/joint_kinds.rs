//! A kind of joint stands in two files: as a row of the table, and as a key of the mechanism file.

use std::fs;
use std::path::{Path, PathBuf};

use linkwear_codegen::model::JOINT_KINDS;

fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    let (folders, files): (Vec<_>, Vec<_>) = entries.partition(|path| path.is_dir());
    let inner = folders.iter().filter(|path| !path.ends_with("tests")).flat_map(|path| rust_files(path));
    files.into_iter().filter(|path| path.extension().is_some_and(|end| end == "rs")).chain(inner).collect()
}

/// Files of the generator and of the command line in which some text stands outside comments and tests.
fn files_with(texts: &[String]) -> Vec<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let files =
        [root.join("codegen/src"), root.join("src")].into_iter().flat_map(|folder| rust_files(&folder));
    let found = files.filter(|path| {
        let text = fs::read_to_string(path).expect("a source file");
        let code = text.split("#[cfg(test)]\nmod tests").next().unwrap_or_default();
        let mut lines = code.lines().map(|line| line.split("//").next().unwrap_or_default());
        !path.ends_with("derive/tests.rs") && lines.any(|line| texts.iter().any(|text| line.contains(text)))
    });
    let mut names: Vec<String> =
        found.map(|path| path.strip_prefix(&root).expect("below the root").display().to_string()).collect();
    names.sort();
    names
}

#[test]
fn a_kind_is_named_in_the_table_and_in_the_file_format_only() {
    let names: Vec<String> = JOINT_KINDS.iter().map(|kind| format!("\"{}\"", kind.name)).collect();
    assert_eq!(files_with(&names), ["codegen/src/model/joint_kind.rs", "codegen/src/spec/joint.rs"]);
}

#[test]
fn what_a_kind_consists_of_is_matched_in_two_files_besides_the_table() {
    assert_eq!(
        files_with(&["Primitive::".to_owned()]),
        [
            "codegen/src/derive/joint_coordinates.rs",
            "codegen/src/derive/linkage_build.rs",
            "codegen/src/model/joint_kind.rs"
        ]
    );
}
