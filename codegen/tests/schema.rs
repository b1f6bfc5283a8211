//! The JSON Schema for editors agrees with the parser: every shipped file passes, every file whose form is wrong does not.
//! The validator below knows just the keywords that the schema uses, and fails on any other.

use serde_json::{Map, Value};

/// As shipped; a test beside the parser's types says that it is theirs.
fn json_schema() -> Value {
    serde_json::from_str(include_str!("../../docs/linkwear.schema.json")).unwrap()
}

/// Whether `value` fits `schema`.
fn fits(value: &Value, schema: &Value, root: &Value) -> bool {
    let Some(keywords) = schema.as_object() else { return schema != &Value::Bool(false) };
    keywords.iter().all(|(keyword, argument)| fits_keyword(value, keyword, argument, keywords, root))
}

fn fits_keyword(
    value: &Value,
    keyword: &str,
    argument: &Value,
    all: &Map<String, Value>,
    root: &Value,
) -> bool {
    let list = || argument.as_array().unwrap();
    let count = || usize::try_from(argument.as_u64().unwrap()).unwrap();
    match keyword {
        "$schema" | "$defs" | "title" | "description" | "default" | "format" => true,
        "$ref" => {
            fits(value, root.pointer(argument.as_str().unwrap().strip_prefix('#').unwrap()).unwrap(), root)
        }
        "type" => argument.as_str().map_or_else(
            || list().iter().any(|name| has_type(value, name.as_str().unwrap())),
            |name| has_type(value, name),
        ),
        "const" => value == argument,
        "enum" => list().contains(value),
        "anyOf" => list().iter().any(|option| fits(value, option, root)),
        "oneOf" => list().iter().filter(|option| fits(value, option, root)).count() == 1,
        "required" => value
            .as_object()
            .is_none_or(|object| list().iter().all(|key| object.contains_key(key.as_str().unwrap()))),
        "minItems" => value.as_array().is_none_or(|items| items.len() >= count()),
        "maxItems" => value.as_array().is_none_or(|items| items.len() <= count()),
        "items" => value.as_array().is_none_or(|items| items.iter().all(|item| fits(item, argument, root))),
        "properties" => value.as_object().is_none_or(|object| {
            object.iter().all(|(key, inner)| argument.get(key).is_none_or(|schema| fits(inner, schema, root)))
        }),
        "additionalProperties" => value.as_object().is_none_or(|object| {
            let known =
                |key: &str| all.get("properties").is_some_and(|properties| properties.get(key).is_some());
            object.iter().all(|(key, inner)| known(key) || fits(inner, argument, root))
        }),
        other => panic!("the validator of this test does not know `{other}`"),
    }
}

fn has_type(value: &Value, name: &str) -> bool {
    match name {
        "null" => value.is_null(),
        "boolean" => value.is_boolean(),
        "integer" => value.is_i64() || value.is_u64(),
        "number" => value.is_number(),
        "string" => value.is_string(),
        "array" => value.is_array(),
        "object" => value.is_object(),
        other => panic!("no type `{other}`"),
    }
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
        assert!(fits(&value, &schema, &schema), "{name}");
    }
}

#[test]
fn files_of_wrong_form_do_not_fit_the_schema_and_others_do() {
    let schema = json_schema();
    for (name, value) in files("tests/spec_fail") {
        // E0103 to E0109 are about form, and so is the presence of the version; NaN (E0308) is no JSON.
        let form = ["E0102_no", "E0103", "E0104", "E0105", "E0106", "E0107", "E0108", "E0109", "E0308_not"];
        // A mechanism name, a number of cells and the like are checked beyond the form; these files are well-formed.
        let wrong = form.iter().any(|code| name.starts_with(code));
        assert_eq!(fits(&value, &schema, &schema), !wrong, "{name}");
    }
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
