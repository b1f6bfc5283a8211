//! Examples of `explain`, compiled: every code has lines that show it and a cure that does not.

use std::collections::BTreeSet;

use linkwear_codegen::diagnostic::{Code, Explanation};
use linkwear_codegen::{Options, SourceFile, compile};

/// Codes of all that is said of some lines of an example, and whether it compiles.
fn told(explanation: &Explanation, lines: &str) -> (Vec<Code>, bool, String) {
    let set = lines.strip_prefix("--set ").and_then(|set| set.split_once('='));
    let overrides = set.into_iter().map(|(name, value)| (name.to_owned(), value.to_owned())).collect();
    // Where the files beside an example are.
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../reader/src/diagnostic/explanation");
    let source = SourceFile { name: format!("{folder}/example.toml"), text: explanation.file(lines) };
    let (said, compiles) = match compile(&source, &Options { overrides, ..Options::default() }) {
        Ok(compiled) => (compiled.warnings, true),
        Err(errors) => (errors.list().to_vec(), false),
    };
    let texts: Vec<_> = said.iter().map(|one| one.message.clone()).collect();
    (said.iter().map(|one| one.code).collect(), compiles, texts.join("\n"))
}

#[test]
fn every_code_has_an_example_that_shows_it_and_a_cure_that_does_not() {
    let mut wrong = String::new();
    for &code in Code::ALL {
        let Some(explanation) = code.explanation() else {
            wrong.push_str(&format!("{code:?}: no explanation\n"));
            continue;
        };
        let (codes, _, texts) = told(explanation, explanation.wrong);
        if !codes.contains(&code) {
            wrong.push_str(&format!("{} is not shown, but {codes:?} {texts}\n", code.as_str()));
        }
        let (codes, compiles, texts) = told(explanation, explanation.right);
        if !compiles || codes.iter().any(|code| *code != Code::UnusedParameter) {
            wrong.push_str(&format!("{} is not cured: {codes:?} {texts}\n", code.as_str()));
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

#[test]
fn examples_alone_are_right() {
    let explanations = Code::ALL.iter().filter_map(|code| code.explanation());
    let alone: BTreeSet<String> = explanations.map(|explanation| explanation.file("")).collect();
    assert!(alone.len() > 1, "examples stand on files of their own");
    for text in alone {
        let source = SourceFile { name: "example.toml".into(), text: text.clone() };
        let compiled = compile(&source, &Options::default());
        assert!(compiled.is_ok_and(|compiled| compiled.warnings.is_empty()), "{text}");
    }
}
