//! The error corpus: one file per mistake in `spec_fail/`, named after the code it is about, and what a user sees.
//! To refresh after a change of wording: `INSTA_UPDATE=always cargo test -p linkwear-codegen --test spec_fail`, then read the diff.

use std::collections::BTreeSet;
use std::path::Path;

use linkwear_codegen::compile::{Options, compile};
use linkwear_codegen::diagnostic::{Code, Diagnostics};
use linkwear_codegen::input::Reach;
use linkwear_codegen::model::topology::spanning_tree;
use linkwear_codegen::model::{Overrides, resolve};
use linkwear_codegen::source::SourceFile;
use linkwear_codegen::spec;

fn folder() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/spec_fail")
}

/// All files of the corpus, by name.
fn cases() -> BTreeSet<String> {
    let names =
        std::fs::read_dir(folder()).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    names.filter_map(|name| name.strip_suffix(".toml").map(str::to_owned)).collect()
}

/// The only place in this suite that runs the front end; returns what the user would see.
fn diagnostics_of(case: &str) -> Diagnostics {
    let text = std::fs::read_to_string(folder().join(format!("{case}.toml"))).unwrap();
    // A comment in the first line may stand for the command line.
    let arguments =
        text.lines().next().unwrap_or_default().strip_prefix("# tested with --set ").unwrap_or_default();
    let overrides = Overrides::parse(arguments.split(" --set ").filter(|text| !text.is_empty())).unwrap();
    let source = SourceFile { name: format!("{case}.toml"), text };
    let front_end = || {
        let spec = spec::parse(&source)?;
        let (mechanism, warnings) = resolve(&spec, &overrides, Reach::Below)?;
        spanning_tree(&mechanism)?;
        // Files about assembly and rank are well-formed; those about warnings need not be assembled.
        if case.starts_with("E06")
            || [
                "E0418_starts",
                "W0107",
                "W0108",
                "W0109",
                "W0110",
                "W0112",
                "W0113",
                "W0116",
                "W0117",
                "W0118",
                "W0119",
                "W0121",
                "W0124",
                "W0126",
                "W0127",
            ]
            .iter()
            .any(|code| case.starts_with(code))
        {
            return Ok(Diagnostics::from_list(compile(&source, &Options::default())?.warnings));
        }
        Ok(Diagnostics::from_list(warnings))
    };
    front_end().unwrap_or_else(|errors: Diagnostics| errors).located(&source)
}

#[test]
fn every_mistake_is_shown_where_it_is_with_a_cure() {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(folder());
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| {
        for case in cases() {
            insta::assert_snapshot!(case.as_str(), diagnostics_of(&case));
        }
    });
}

#[test]
fn every_file_shows_the_code_it_is_named_after() {
    for case in cases() {
        let code = case.split('_').next().unwrap();
        let found: Vec<_> = diagnostics_of(&case).list().iter().map(|d| d.code.as_str()).collect();
        assert!(found.contains(&code), "{case}: {found:?}");
    }
}

#[test]
fn every_code_has_a_file() {
    let mut missing: Vec<Code> = Code::ALL.to_vec();
    for case in cases() {
        let found = diagnostics_of(&case);
        missing.retain(|code| !found.list().iter().any(|diagnostic| diagnostic.code == *code));
    }
    assert!(missing.is_empty(), "no file for {missing:?}");
}

#[test]
fn every_diagnostic_of_the_corpus_has_a_place_in_the_file() {
    for case in cases() {
        for entry in diagnostics_of(&case).list() {
            let placeless = matches!(entry.code, Code::UnknownOverride | Code::NoGravity);
            assert!(placeless || entry.span().is_some(), "{case}: {}", entry.message);
        }
    }
}
