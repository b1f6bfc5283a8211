//! The JSON Schema for editors agrees with the parser: every shipped file passes, every file whose form is wrong does not.

#[path = "../../tests/outputs/schema.rs"]
mod validator;

use serde_json::Value;
use validator::faults;

/// As shipped; a test beside the parser's types says that it is theirs.
fn json_schema() -> Value {
    serde_json::from_str(include_str!("../../docs/linkwear.schema.json")).unwrap()
}

/// All TOML files of a folder beside this crate's manifest, as JSON; files that are not TOML are left out.
fn files(folder: &str) -> Vec<(String, Value)> {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let mut files: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .filter_map(|path| {
            let value: Value = toml::from_str(&std::fs::read_to_string(&path).unwrap()).ok()?;
            Some((path.file_stem().unwrap().to_string_lossy().into_owned(), value))
        })
        .collect();
    files.sort_by(|a, b| a.0.cmp(&b.0));
    files
}

#[test]
fn every_shipped_mechanism_fits_the_schema() {
    let schema = json_schema();
    let files = files("../mechanisms");
    assert!(files.len() >= 4);
    for (name, value) in files {
        assert_eq!(faults(&schema, &value), Vec::<String>::new(), "{name}");
    }
}

#[test]
fn files_of_wrong_form_do_not_fit_the_schema_and_others_do() {
    let schema = json_schema();
    for (name, value) in files("tests/spec_fail") {
        // E0103 to E0109 are about form, and so are the presence of the version and of a unit (E0304) the rows of a matrix (E0419)
        // and the states of a controller (E0420); NaN (E0308) is no JSON.
        let form = [
            "E0102_no",
            "E0103",
            "E0104",
            "E0105",
            "E0106",
            "E0107",
            "E0108",
            "E0109",
            "E0304",
            "E0308_not",
            "E0419",
            "E0420",
        ];
        // A mechanism name, a number of cells and the like are checked beyond the form; these files are well-formed.
        // So are keys that have no effect beside others.
        let is_of_keys_beside = name.starts_with("E0107_beside");
        let wrong = form.iter().any(|code| name.starts_with(code)) && !is_of_keys_beside;
        assert_eq!(!faults(&schema, &value).is_empty(), wrong, "{name}");
    }
}

/// Validators that are strict stop at a null where a schema should be.
#[test]
fn nothing_in_the_schema_is_null() {
    fn nulls(value: &Value) -> usize {
        match value {
            Value::Null => 1,
            Value::Array(items) => items.iter().map(nulls).sum(),
            // A default of null is one.
            Value::Object(fields) => {
                fields.iter().filter(|(key, _)| *key != "default").map(|(_, value)| nulls(value)).sum()
            }
            _ => 0,
        }
    }
    assert_eq!(nulls(&json_schema()), 0);
}

#[test]
fn schema_documents_every_table() {
    let schema = json_schema();
    let tables = schema["properties"].as_object().unwrap();
    for (name, table) in tables {
        assert!(table.get("description").is_some() || table.get("$ref").is_some(), "{name}");
    }
    assert!(tables.contains_key("joints") && tables.contains_key("repeat"));
}
