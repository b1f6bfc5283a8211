//! Holds JSON against a JSON Schema: the keywords that the shipped schemas have, and no others, so that none is passed over.

use serde_json::Value;

/// What is wrong, each with its place.
pub fn faults(schema: &Value, value: &Value) -> Vec<String> {
    let mut found = Vec::new();
    check(schema, schema, value, "$", &mut found);
    found
}

fn check(root: &Value, schema: &Value, value: &Value, at: &str, found: &mut Vec<String>) {
    let Some(schema) = schema.as_object() else {
        assert_eq!(*schema, Value::Bool(true), "{at}");
        return;
    };
    let mut fault = |what: String| found.push(format!("{at}: {what}"));
    for (keyword, told) in schema {
        match (keyword.as_str(), value) {
            ("type", _) => {
                let names = told.as_array().cloned().unwrap_or_else(|| vec![told.clone()]);
                if !names.iter().any(|name| is_of(name.as_str().expect("a type"), value)) {
                    fault(format!("{value} is not {told}"));
                }
            }
            ("const", _) if told != value => fault(format!("{value} is not {told}")),
            ("enum", _) if !told.as_array().expect("a list").contains(value) => {
                fault(format!("{value} is not of {told}"))
            }
            ("minimum", Value::Number(number)) if number.as_f64() < told.as_f64() => {
                fault(format!("{number} < {told}"))
            }
            ("minItems", Value::Array(list)) if (list.len() as u64) < told.as_u64().expect("a count") => {
                fault("too short".into())
            }
            ("maxItems", Value::Array(list)) if (list.len() as u64) > told.as_u64().expect("a count") => {
                fault("too long".into())
            }
            ("required", Value::Object(object)) => {
                for key in told.as_array().expect("a list").iter().filter_map(Value::as_str) {
                    if !object.contains_key(key) {
                        fault(format!("`{key}` is missing"));
                    }
                }
            }
            ("minProperties", Value::Object(fields))
                if (fields.len() as u64) < told.as_u64().expect("a count") =>
            {
                fault("too few keys".into())
            }
            ("pattern", Value::String(text)) if !fits(told.as_str().expect("a pattern"), text) => {
                fault(format!("`{text}` does not fit {told}"))
            }
            (
                "pattern" | "const" | "enum" | "minimum" | "minItems" | "maxItems" | "minProperties"
                | "required",
                _,
            ) => {}
            ("title" | "description" | "format" | "default" | "$schema" | "$defs", _) => {}
            ("$ref" | "anyOf" | "oneOf" | "allOf" | "not" | "if" | "then" | "else", _) => {}
            ("properties" | "additionalProperties" | "propertyNames" | "items" | "prefixItems", _) => {}
            (other, _) => panic!("{at}: the keyword `{other}` is not known here"),
        }
    }
    if let Some(name) = schema.get("$ref").and_then(Value::as_str) {
        let target = root.pointer(name.strip_prefix('#').expect("within the file"));
        check(root, target.unwrap_or_else(|| panic!("{name} is not there")), value, at, found);
    }
    for keyword in ["anyOf", "oneOf"] {
        let Some(variants) = schema.get(keyword).and_then(Value::as_array) else { continue };
        let of_each = variants.iter().map(|variant| {
            let mut own = Vec::new();
            check(root, variant, value, at, &mut own);
            own
        });
        let of_each: Vec<Vec<String>> = of_each.collect();
        if of_each.iter().all(|own| !own.is_empty()) {
            found.push(format!("{at}: none of the variants: {}", of_each.concat().join("; ")));
        } else if keyword == "oneOf" && of_each.iter().filter(|own| own.is_empty()).count() > 1 {
            found.push(format!("{at}: several of the variants"));
        }
    }
    let is_right = |schema: &Value| {
        let mut own = Vec::new();
        check(root, schema, value, at, &mut own);
        own.is_empty()
    };
    if schema.get("not").is_some_and(is_right) {
        found.push(format!("{at}: what must not be"));
    }
    let branch = schema.get("if").and_then(|of| schema.get(if is_right(of) { "then" } else { "else" }));
    let all = schema.get("allOf").and_then(Value::as_array);
    for own in branch.into_iter().chain(all.into_iter().flatten()) {
        check(root, own, value, at, found);
    }
    if let Value::Object(object) = value {
        for (key, value) in object {
            if let Some(names) = schema.get("propertyNames") {
                check(root, names, &Value::from(key.as_str()), at, found);
            }
            let at = format!("{at}.{key}");
            match (
                schema.get("properties").and_then(|known| known.get(key)),
                schema.get("additionalProperties"),
            ) {
                (Some(own), _) => check(root, own, value, &at, found),
                (None, Some(Value::Bool(false))) => found.push(format!("{at}: no such key")),
                (None, Some(others)) => check(root, others, value, &at, found),
                (None, None) => {}
            }
        }
    }
    if let Value::Array(list) = value {
        let first = schema.get("prefixItems").and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
        for (index, value) in list.iter().enumerate() {
            let at = format!("{at}[{index}]");
            if let Some(own) = first.get(index).or_else(|| schema.get("items")) {
                check(root, own, value, &at, found);
            }
        }
    }
}

/// The patterns that there are: a quantity in a mechanism file is not blank; it has a unit, which has a letter, or is zero.
fn fits(pattern: &str, text: &str) -> bool {
    match pattern {
        "[^ ]" => text.contains(|letter| letter != ' '),
        "[A-Za-zµ%{]|^[ .+-]*0[ 0.+-]*$" => {
            let is_with_unit =
                text.contains(|letter: char| letter.is_ascii_alphabetic() || "µ%{".contains(letter));
            is_with_unit || text.contains('0') && !text.contains(|letter| !" 0.+-".contains(letter))
        }
        other => panic!("the pattern `{other}` is not known here"),
    }
}

fn is_of(name: &str, value: &Value) -> bool {
    match name {
        "null" => value.is_null(),
        "boolean" => value.is_boolean(),
        "integer" => value.is_i64() || value.is_u64(),
        "number" => value.is_number(),
        "string" => value.is_string(),
        "array" => value.is_array(),
        "object" => value.is_object(),
        other => panic!("there is no type `{other}`"),
    }
}

#[test]
fn what_is_wrong_is_found() {
    let schema: Value = serde_json::from_str(
        r##"{"type": "object", "required": ["a"], "additionalProperties": false, "$defs": {"n": {"type": ["number", "null"]}},
            "properties": {"a": {"$ref": "#/$defs/n"}, "b": {"type": "array", "items": {"const": 1}, "maxItems": 2},
            "c": {"anyOf": [{"type": "integer", "minimum": 0}, {"type": "string"}]}}}"##,
    )
    .expect("JSON");
    let count = |text: &str| faults(&schema, &serde_json::from_str(text).expect("JSON")).len();
    for good in [r#"{"a": 1.5}"#, r#"{"a": null, "b": [1, 1], "c": 3}"#, r#"{"a": 0, "c": "x"}"#] {
        assert_eq!(count(good), 0, "{good}");
    }
    for bad in [
        "3",
        "{}",
        r#"{"a": "1"}"#,
        r#"{"a": 1, "d": 2}"#,
        r#"{"a": 1, "b": [2]}"#,
        r#"{"a": 1, "b": [1, 1, 1]}"#,
        r#"{"a": 1, "c": -1}"#,
        r#"{"a": 1, "c": 1.5}"#,
    ] {
        assert_eq!(count(bad), 1, "{bad}");
    }
}

#[test]
fn what_depends_on_other_keys_is_found() {
    let schema: Value = serde_json::from_str(
        r#"{"if": {"required": ["a"]}, "then": {"required": ["b"]}, "else": {"minProperties": 1},
            "allOf": [{"not": {"required": ["c", "d"]}}], "not": {"propertyNames": {"enum": ["e"]}, "minProperties": 1}}"#,
    )
    .expect("JSON");
    let fits = |text: &str| faults(&schema, &serde_json::from_str(text).expect("JSON")).is_empty();
    for good in [r#"{"a": 1, "b": 1}"#, r#"{"b": 1}"#, r#"{"c": 1, "e": 1}"#] {
        assert!(fits(good), "{good}");
    }
    for bad in ["{}", r#"{"a": 1}"#, r#"{"c": 1, "d": 1}"#, r#"{"e": 1}"#] {
        assert!(!fits(bad), "{bad}");
    }
}
