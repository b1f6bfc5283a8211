//! The JSON Schema of the file, for editors, and the page of all its keys are made from the types of the parser.
//!
//! The sentence about a field ends with what it takes, in brackets: `[unit; range; default X; e.g. Y]`, the last three where there are any;
//! `required` stands for a default. Where the unit is one, a number without a unit is wrong in the schema too.

mod beside;
mod keys;

use std::fs;

use serde_json::{Map, Value, json};

use super::file::File;
use super::{Dimension, parse_expression};

/// What the brackets behind a sentence say.
struct Takes {
    sentence: String,
    unit: String,
    range: String,
    default: String,
    example: String,
}

impl Takes {
    fn of(description: &str) -> Option<Self> {
        let text = description.split_whitespace().collect::<Vec<_>>().join(" ");
        let body = text.strip_suffix(']')?;
        // Examples have brackets themselves: the first one that opens behind a sentence counts.
        let (sentence, inside) = match body.strip_prefix('[') {
            Some(inside) => ("", inside),
            None => body.split_once(". [")?,
        };
        let mut takes = Self {
            sentence: if sentence.is_empty() { String::new() } else { format!("{sentence}.") },
            unit: String::new(),
            range: String::new(),
            default: String::new(),
            example: String::new(),
        };
        for (place, item) in inside.split("; ").enumerate() {
            if place == 0 {
                item.clone_into(&mut takes.unit);
            } else if let Some(example) = item.strip_prefix("e.g. ") {
                example.clone_into(&mut takes.example);
            } else if let Some(default) = item.strip_prefix("default ") {
                default.clone_into(&mut takes.default);
            } else if item.starts_with("required") {
                item.clone_into(&mut takes.default);
            } else {
                item.clone_into(&mut takes.range);
            }
        }
        Some(takes)
    }

    /// Dimensions of the units, if all of them are units: `N m or N`.
    fn dimensions(&self) -> Option<Vec<Dimension>> {
        let dimension = |unit: &str| {
            let read = parse_expression(&format!("1 {unit}"), &|_| false).ok()?;
            read.quantity().map(|(_, dimension)| dimension)
        };
        self.unit.split(" or ").map(dimension).collect()
    }

    /// Whether a number alone is always wrong.
    fn needs_a_unit(&self) -> bool {
        let needs =
            |dimensions: Vec<Dimension>| dimensions.iter().all(|dimension| *dimension != Dimension::NONE);
        self.dimensions().is_some_and(needs)
    }
}

/// A text with a letter, which a unit or a name has, or zero.
const WITH_UNIT: &str = "[A-Za-zµ%{]|^[ .+-]*0[ 0.+-]*$";

/// A schema in which quantities have their unit; types it refers to are doubled under a name of their own.
fn with_units(schema: &Value, types: &Map<String, Value>, more: &mut Map<String, Value>) -> Value {
    match schema {
        Value::Object(object) => {
            let mut changed = Map::new();
            for (key, value) in object {
                let name = value.as_str().and_then(|text| text.strip_prefix("#/$defs/"));
                if let (true, Some(name)) = (key == "$ref", name) {
                    let double = format!("{name}WithUnit");
                    if !more.contains_key(&double) {
                        more.insert(double.clone(), Value::Null);
                        let own = match name {
                            "Quantity" => json!({
                                "description": "A quantity with its unit (\"120 mm\") or a formula (\"L1 + L2\"); of numbers alone only 0.",
                                "anyOf": [{ "type": "string", "pattern": WITH_UNIT }, { "const": 0 }],
                            }),
                            other => with_units(&types[other], types, more),
                        };
                        more.insert(double.clone(), own);
                    }
                    changed.insert(key.clone(), json!(format!("#/$defs/{double}")));
                } else {
                    changed.insert(key.clone(), with_units(value, types, more));
                }
            }
            Value::Object(changed)
        }
        Value::Array(list) => list.iter().map(|item| with_units(item, types, more)).collect(),
        other => other.clone(),
    }
}

/// The schema of the file.
fn schema() -> Value {
    let mut schema = schemars::schema_for!(File).to_value();
    schema.as_object_mut().expect("an object").insert("title".into(), "linkwear mechanism".into());
    let types = schema["$defs"].as_object().expect("types").clone();
    let mut more = Map::new();
    let mut change = |fields: &mut Value| {
        for (_, field) in fields.as_object_mut().into_iter().flatten() {
            let takes = field["description"].as_str().and_then(Takes::of);
            if takes.is_some_and(|takes| takes.needs_a_unit()) {
                *field = with_units(field, &types, &mut more);
            }
        }
    };
    change(&mut schema["properties"]);
    for name in types.keys() {
        beside::add_needs(name, &mut schema["$defs"][name]);
        // Types of several forms have no fields of their own.
        if let Some(fields) = schema["$defs"][name].get_mut("properties") {
            change(fields);
        }
    }
    // A point is written in several forms, of which one is a table with its keys.
    let point = with_units(&schema["$defs"]["PointSpec"], &types, &mut more);
    schema["$defs"]["PointSpec"] = point;
    schema["$defs"].as_object_mut().expect("types").extend(more);
    schema
}

/// Writes what is made if it is asked to; else compares.
fn held(path: &str, current: &str) {
    if std::env::var_os("LINKWEAR_WRITE_SCHEMA").is_some() {
        fs::write(path, current).expect("the file is written");
    }
    let shipped = fs::read_to_string(path).unwrap_or_default();
    assert!(
        shipped == current,
        "{path} is stale: LINKWEAR_WRITE_SCHEMA=1 cargo test -p linkwear-reader schema"
    );
}

#[test]
fn the_shipped_schema_is_that_of_the_parser() {
    held("../docs/linkwear.schema.json", &format!("{:#}\n", schema()));
}

#[test]
fn brackets_behind_a_sentence_are_read() {
    let takes = Takes::of("Speeds.\n[m/s; above 0; default 1 mm/s; e.g. [\"1 mm/s\"]]").expect("brackets");
    assert_eq!(
        (takes.sentence.as_str(), takes.unit.as_str(), takes.range.as_str()),
        ("Speeds.", "m/s", "above 0")
    );
    assert_eq!((takes.default.as_str(), takes.example.as_str()), ("1 mm/s", "[\"1 mm/s\"]"));
    assert!(takes.needs_a_unit());
    assert!(!Takes::of("It. [rad or m; any]").expect("brackets").needs_a_unit());
    assert!(!Takes::of("It. [a word]").expect("brackets").needs_a_unit());
    assert!(Takes::of("Without.").is_none());
}
