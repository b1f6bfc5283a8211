//! Generated code is a product: a change of a single byte of it is meant, or it does not pass.
//! One line for each file and closure: SHA-256 of its source, statements, operations. The files are the shipped
//! mechanisms, and those of `data/`, which have every kind of joint in every role.

use std::fmt::Write as _;
use std::path::Path;

use linkwear_codegen::compile::{Compiled, Options, compile};
use linkwear_codegen::model::Closure;
use linkwear_codegen::source::SourceFile;

fn compiled(path: &Path, closure: Closure) -> Compiled {
    let name = path.file_name().expect("a name").to_string_lossy();
    let text = std::fs::read_to_string(path).expect("a mechanism file");
    let source = SourceFile { name: format!("mechanisms/{name}"), text };
    let options = Options { closure: Some(closure), ..Options::default() };
    compile(&source, &options).unwrap_or_else(|errors| panic!("{}: {errors}", path.display()))
}

/// One line for each mechanism file of a folder and each closure.
fn hashes(folder: &str) -> String {
    let entries = std::fs::read_dir(folder).expect("a folder of mechanisms");
    let mut files: Vec<_> = entries.map(|entry| entry.expect("an entry").path()).collect();
    files.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    files.sort();
    let mut lines = String::new();
    for file in &files {
        for closure in [Closure::Joint, Closure::Log] {
            let compiled = compiled(file, closure);
            let counts = compiled.operations();
            let statements: usize = counts.iter().map(|count| count.statements).sum();
            let operations: u64 = counts.iter().map(|count| count.operations.total).sum();
            let name = file.file_stem().expect("a name").to_string_lossy();
            // The first line carries the version.
            let source = compiled.rust_source();
            let body = source.split_once('\n').expect("several lines").1;
            let hash = &SourceFile { name: String::new(), text: body.to_owned() }.sha256()[..16];
            writeln!(lines, "{name:24} {closure:?}  {hash}  {statements:6} {operations:6}")
                .expect("text takes it");
        }
    }
    lines
}

#[test]
fn every_shipped_mechanism_generates_the_same_bytes() {
    insta::assert_snapshot!(hashes(concat!(env!("CARGO_MANIFEST_DIR"), "/../mechanisms")));
}

#[test]
fn every_kind_of_joint_in_every_role_generates_the_same_bytes() {
    insta::assert_snapshot!(hashes(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data")));
}
