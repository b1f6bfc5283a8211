//! docs/spec-reference.md tells the truth: its files work, and it mentions every key there is.

use std::collections::BTreeSet;

use linkwear_codegen::input::Reach;
use linkwear_codegen::model::topology::spanning_tree;
use linkwear_codegen::model::{Overrides, resolve};
use linkwear_codegen::source::SourceFile;
use linkwear_codegen::spec;
use serde_json::Value;

fn reference() -> String {
    std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/spec-reference.md")).unwrap()
}

#[test]
fn every_file_in_the_reference_resolves_without_warnings() {
    let text = reference();
    let files: Vec<_> =
        text.split("```toml\n").skip(1).map(|rest| rest.split("```").next().unwrap()).collect();
    assert_eq!(files.len(), 5);
    for file in files {
        let source = SourceFile { name: "spec-reference.md".into(), text: file.into() };
        let spec = spec::parse(&source).unwrap_or_else(|errors| panic!("{errors}"));
        let (mechanism, warnings) =
            resolve(&spec, &Overrides::default(), Reach::Below).unwrap_or_else(|errors| panic!("{errors}"));
        assert_eq!(warnings, []);
        assert!(spanning_tree(&mechanism).is_ok());
    }
}

fn keys(schema: &Value, found: &mut BTreeSet<String>) {
    match schema {
        Value::Object(object) => {
            if let Some(Value::Object(properties)) = object.get("properties") {
                found.extend(properties.keys().cloned());
            }
            object.values().for_each(|inner| keys(inner, found));
        }
        Value::Array(items) => items.iter().for_each(|inner| keys(inner, found)),
        _ => {}
    }
}

#[test]
fn every_key_is_in_the_reference() {
    let text = reference();
    let mut found = BTreeSet::new();
    let schema = include_str!("../../docs/linkwear.schema.json");
    keys(&serde_json::from_str(schema).expect("JSON"), &mut found);
    assert!(found.len() > 60);
    let numbered = |key: &str| key.len() == 2 && key.starts_with(['q', 'v']);
    for key in found.iter().filter(|key| !numbered(key)) {
        let mentioned = [
            format!("`{key}`"),
            format!("`{key} = "),
            format!("[{key}"),
            format!("{{ {key} = "),
            format!(", {key} = "),
        ];
        assert!(mentioned.iter().any(|form| text.contains(form)), "`{key}` is not explained");
    }
}
