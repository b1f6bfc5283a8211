//! Keys that need others beside them, which a list of what is required cannot say.

use serde_json::{Value, json};

use super::super::joint::NEEDS_OF_KINDS;

/// A type, a key of it, and the keys that this one needs.
const NEEDS: [(&str, &str, &[&str]); 9] = [
    ("BodySpec", "rod", &["radius"]),
    ("BodySpec", "tube", &["radius", "inner_radius"]),
    ("BodySpec", "box", &["width"]),
    ("CouplingSpec", "worm", &["module"]),
    ("DryFrictionSpec", "at_rest", &["stribeck_speed"]),
    ("DryFrictionSpec", "stribeck_speed", &["at_rest"]),
    ("FlexibleSpec", "data", &["origin"]),
    ("MissionSpec", "bins", &["series"]),
    ("StopSpec", "law", &["impact_speed"]),
];

/// Puts them into a type of the schema.
pub(super) fn add_needs(name: &str, of: &mut Value) {
    let needs = NEEDS.iter().filter(|(of, ..)| *of == name).map(|(_, key, others)| (key, others));
    let of_kinds = NEEDS_OF_KINDS.iter().filter(|_| name == "JointSpec").map(|(key, others)| (key, others));
    let each = needs.chain(of_kinds).map(|(key, others)| {
        let known = &of["properties"];
        let is_key = |key: &str| known.get(key).is_some();
        assert!(is_key(key) && others.iter().all(|other| is_key(other)), "{name}.{key}");
        json!({ "if": { "required": [key] }, "then": { "required": others } })
    });
    let each: Vec<Value> = each.collect();
    if each.is_empty() {
        return;
    }
    let fields = of.as_object_mut().expect("a type");
    let all = fields.entry("allOf").or_insert_with(|| json!([]));
    all.as_array_mut().expect("a list").extend(each);
}
