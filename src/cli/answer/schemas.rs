//! JSON Schemas and the page of outputs, made from the types of the answers and kept in `docs/`: `docs/schemas`, `docs/outputs.md`.

use std::fmt::Write as _;
use std::fs;

use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, SchemaGenerator};
use serde_json::{Map, Value, json};

use super::super::shipped_schemas::SCHEMAS;
use super::{
    check, diff, equations, errors, explain, fit, identify, life, plan, predict, sensitivity, simulate, study,
};
use crate::provenance::{FORMAT, Provenance};
use crate::table::{about, tables};

/// A life, and which shard it is of.
#[derive(JsonSchema)]
#[expect(dead_code, reason = "here are its keys")]
struct LifeOrShard<'a> {
    #[serde(flatten)]
    life: life::LifeAnswer<'a>,
    /// Which shard of the study this is of; absent where it is of all.
    #[serde(skip_serializing_if = "Option::is_none")]
    shard: Option<life::ShardAnswer>,
}

/// Every output with its schema; whether it tells what it is of.
fn outputs() -> Vec<(&'static str, Value)> {
    vec![
        ("check", schema::<check::CheckAnswer<'_>>("check", true)),
        ("equations", schema::<equations::EquationsAnswer<'_>>("equations", false)),
        ("cost", schema::<equations::CostAnswer<'_>>("cost", false)),
        ("generate", schema::<equations::GenerateAnswer<'_>>("generate", false)),
        ("fmu", schema::<equations::FmuAnswer<'_>>("fmu", false)),
        ("report", schema::<equations::PageAnswer>("report", false)),
        ("view", schema::<equations::PageAnswer>("view", false)),
        ("draw", schema::<equations::PageAnswer>("draw", false)),
        ("simulate", schema::<simulate::SimulateAnswer<'_>>("simulate", true)),
        ("life", life_schema("life")),
        ("study", schema::<study::StudyAnswer<'_>>("study", true)),
        ("fit", schema::<fit::FitAnswer<'_>>("fit", true)),
        ("fit-file", schema::<fit::FittedProcess>("fit-file", true)),
        ("identify", schema::<identify::IdentifyAnswer<'_>>("identify", true)),
        ("sensitivity", schema::<sensitivity::SensitivityAnswer<'_>>("sensitivity", true)),
        ("plan", schema::<plan::PlanAnswer>("plan", true)),
        ("predict", schema::<predict::PredictAnswer<'_>>("predict", true)),
        ("diff", schema::<diff::DiffAnswer>("diff", false)),
        ("explain", schema::<explain::ExplainAnswer>("explain", false)),
        ("import", schema::<equations::ImportAnswer>("import", false)),
        ("new", schema::<equations::NewAnswer>("new", false)),
        ("completions", schema::<equations::TextAnswer>("completions", false)),
        ("man", schema::<equations::PagesAnswer>("man", false)),
        ("errors", schema::<errors::Errors>("errors", false)),
        ("table", plain::<about::TableBeside>("table")),
        ("parquet", schema::<about::TableWithin>("parquet", true)),
    ]
}

fn life_schema(name: &str) -> Value {
    let mut schema = schema::<LifeOrShard<'_>>(name, true);
    schema["description"] = json!("A life of joints that wear, to the failure threshold.");
    schema
}

/// Of what is written, with the keys that every answer has, and no others than it has.
fn schema<T: JsonSchema>(name: &str, is_of_something: bool) -> Value {
    let mut generator = SchemaGenerator::new(SchemaSettings::draft2020_12().for_serialize());
    let provenance = generator.subschema_for::<Provenance>();
    let mut schema = generator.into_root_schema_for::<T>().to_value();
    schema["title"] = json!(format!("linkwear {name}"));
    let root = schema.as_object_mut().expect("an object");
    let own = root.remove("properties").expect("properties");
    let mut properties = Map::new();
    let format = "Version of the form of all JSON; it rises when a key changes its meaning or goes.";
    properties.insert("format".to_owned(), json!({ "description": format, "const": FORMAT }));
    properties.extend(own.as_object().cloned().expect("properties"));
    let mut required = vec![json!("format")];
    required.extend(root.remove("required").and_then(|list| list.as_array().cloned()).unwrap_or_default());
    if is_of_something {
        let mut provenance = provenance.to_value();
        provenance["description"] = json!("What the result is of: what decides its numbers.");
        properties.insert("provenance".to_owned(), provenance);
        required.push(json!("provenance"));
    } else if let Some(kept) = root.get_mut("$defs").and_then(Value::as_object_mut) {
        kept.remove("Provenance");
        if kept.is_empty() {
            root.remove("$defs");
        }
    }
    root.insert("properties".to_owned(), properties.into());
    root.insert("required".to_owned(), required.into());
    close(&mut schema);
    schema
}

/// Of what is written, as it stands.
fn plain<T: JsonSchema>(name: &str) -> Value {
    let generator = SchemaGenerator::new(SchemaSettings::draft2020_12().for_serialize());
    let mut schema = generator.into_root_schema_for::<T>().to_value();
    schema["title"] = json!(format!("linkwear {name}"));
    close(&mut schema);
    schema
}

/// An object whose keys are told has no others.
fn close(schema: &mut Value) {
    match schema {
        Value::Object(map) => {
            if map.contains_key("properties") && !map.contains_key("additionalProperties") {
                map.insert("additionalProperties".to_owned(), json!(false));
            }
            map.values_mut().for_each(close);
        }
        Value::Array(list) => list.iter_mut().for_each(close),
        _ => {}
    }
}

/// The file is what is made; `LINKWEAR_WRITE_SCHEMA=1` writes it.
fn held(path: &str, made: &str) {
    if std::env::var_os("LINKWEAR_WRITE_SCHEMA").is_some() {
        fs::write(path, made).expect("the file is written");
    }
    let shipped = fs::read_to_string(path).unwrap_or_default();
    assert!(shipped == made, "{path} is stale: LINKWEAR_WRITE_SCHEMA=1 cargo test -p linkwear --lib schemas");
}

#[test]
fn the_shipped_schemas_are_those_of_the_types() {
    let names: Vec<&str> = outputs().iter().map(|(name, _)| *name).collect();
    assert_eq!(names, SCHEMAS.map(|(name, _)| name));
    for (name, schema) in outputs() {
        held(&format!("docs/schemas/{name}.schema.json"), &format!("{schema:#}\n"));
    }
}

#[test]
fn the_page_of_outputs_has_every_key_and_column_with_its_meaning() {
    let mut page = include_str!("outputs_head.md").to_owned();
    for (name, schema) in outputs() {
        let heading = match name {
            "errors" => "Failure of any subcommand".to_owned(),
            "table" => "`FILE-metadata.json` beside a table".to_owned(),
            "parquet" => "Metadata `linkwear` of a Parquet file".to_owned(),
            "life" => "`life --format json`, and `merge` of its shards".to_owned(),
            "study" => "`study --format json`, and `merge` of its shards".to_owned(),
            "fit-file" => "File of `fit --out`".to_owned(),
            name => format!("`{name} --format json`"),
        };
        let _ = write!(
            page,
            "\n### {heading}\n\n{}\n\n",
            schema["description"].as_str().unwrap_or_default().replace('\n', " ")
        );
        page.push_str("| key | value | meaning |\n|---|---|---|\n");
        rows(&mut page, &schema, &schema, "");
    }
    page.push_str("\n## Columns of tables\n");
    for (table, forms) in tables() {
        let heading =
            if table.ends_with(".csv") { format!("{table} of `life --out`") } else { table.to_owned() };
        let _ = write!(page, "\n### {heading}\n\n| column | unit | meaning |\n|---|---|---|\n");
        for form in forms {
            // What stands for a unit, `<unit>`, is no tag.
            let units = form.units.join(" or ").replace('<', "\\<");
            let _ = writeln!(page, "| `{}` | {units} | {} |", form.name, form.meaning);
        }
    }
    held("docs/outputs.md", &page);
}

/// A row for each key, keys of objects within after it.
fn rows(page: &mut String, root: &Value, schema: &Value, path: &str) {
    let Some(properties) = schema["properties"].as_object() else { return };
    for (key, entry) in properties {
        let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
        let optional = !schema["required"].as_array().is_some_and(|all| all.contains(&json!(key)));
        row(page, root, entry, &path, optional);
    }
}

fn row(page: &mut String, root: &Value, entry: &Value, path: &str, optional: bool) {
    let (kind, inner, suffix) = kind(root, entry);
    let told = entry["description"].as_str().or_else(|| inner["description"].as_str());
    let meaning = told.unwrap_or_else(|| panic!("`{path}` has no description")).replace('\n', " ");
    let absent = if optional { ", may be absent" } else { "" };
    let _ = writeln!(page, "| `{path}` | {kind}{absent} | {meaning} |");
    if !path.ends_with("provenance.options") {
        rows(page, root, &inner, &format!("{path}{suffix}"));
    }
}

/// The kind of a value in words, the schema of the object within, and what follows the key on the way to it.
fn kind(root: &Value, entry: &Value) -> (String, Value, &'static str) {
    if let Some(name) = entry["$ref"].as_str().and_then(|path| path.strip_prefix("#/$defs/")) {
        return kind(root, &root["$defs"][name]);
    }
    if let Some(variants) = entry["anyOf"].as_array() {
        let (nulls, others): (Vec<_>, Vec<_>) = variants.iter().partition(|one| one["type"] == "null");
        let (mut word, mut inner, suffix) = kind(root, others[0]);
        for other in &others[1..] {
            // Keys that one of them lacks may be absent.
            let (_, more, _) = kind(root, other);
            let both = more["required"].as_array().cloned().unwrap_or_default();
            let kept = inner["required"].as_array().cloned().unwrap_or_default();
            inner["required"] = kept.into_iter().filter(|key| both.contains(key)).collect();
        }
        if !nulls.is_empty() {
            word.push_str(" or null");
        }
        return (word, inner, suffix);
    }
    let types: Vec<&str> = match &entry["type"] {
        Value::String(one) => vec![one],
        Value::Array(several) => several.iter().filter_map(Value::as_str).collect(),
        _ => Vec::new(),
    };
    let nullable = if types.contains(&"null") { " or null" } else { "" };
    let (word, inner, suffix) = match types.first() {
        Some(&"array") => {
            let of = if entry["items"].is_object() { &entry["items"] } else { &entry["prefixItems"][0] };
            let (word, inner, suffix) = kind(root, of);
            (format!("list of {word}"), inner, if suffix.is_empty() { "[]" } else { "[].<name>" })
        }
        Some(&"object") if entry["properties"].is_object() => ("object".to_owned(), entry.clone(), ""),
        Some(&"object") => {
            let (word, inner, _) = kind(root, &entry["additionalProperties"]);
            (format!("{word} by name"), inner, ".<name>")
        }
        Some(&"integer") => ("whole number".to_owned(), Value::Null, ""),
        Some(&"boolean") => ("true or false".to_owned(), Value::Null, ""),
        Some(&"string") => ("text".to_owned(), Value::Null, ""),
        Some(other) => ((*other).to_owned(), Value::Null, ""),
        None if entry["const"].is_u64() => (entry["const"].to_string(), Value::Null, ""),
        None => ("any".to_owned(), Value::Null, ""),
    };
    (format!("{word}{nullable}"), inner, suffix)
}
