//! Mechanisms as text, compiled and run: what tests of elements begin with.
#![allow(dead_code, reason = "every test file uses its own part")]

#[path = "../../../tests/support/machine_code.rs"]
mod machine_code;

use linkwear_codegen::compile::{Compiled, Options, compile};
use linkwear_codegen::source::SourceFile;
use linkwear_runtime::{Run, Settings, Watch, simulate};

/// A file with its version and name put before the text.
pub fn source(text: &str) -> SourceFile {
    SourceFile { name: "m.toml".into(), text: format!("spec = 1\nname = \"m\"\n{text}") }
}

pub fn compiled(text: &str) -> Compiled {
    compile(&source(text), &Options::default()).unwrap_or_else(|errors| panic!("{errors}\n{text}"))
}

/// What is said of a text that is no mechanism.
pub fn refused(text: &str) -> String {
    match compile(&source(text), &Options::default()) {
        Ok(_) => panic!("taken:\n{text}"),
        Err(errors) => errors.to_string(),
    }
}

/// A run that goes on to its end.
pub fn run_with(text: &str, settings: &Settings) -> Run {
    let compiled = compiled(text);
    let system = machine_code::system(&compiled);
    let run = simulate(&*system, compiled.description(), &compiled.parameters(), settings, Watch::NONE)
        .expect("it starts");
    assert_eq!(run.stopped, None);
    run
}

pub fn at_end(run: &Run, column: &str) -> f64 {
    *run.column(column).expect(column).last().expect("rows")
}
