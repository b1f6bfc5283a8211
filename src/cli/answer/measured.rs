//! Schemas of quantities of contacts: keys, units and meanings by the columns that tables and text have too.

use linkwear_runtime::Column;
use linkwear_runtime::life::CycleJoint;
use linkwear_runtime::wear::ContactMeasure;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde_json::{Map, Value, json};

use crate::study::turn_key;

/// Numbers of a contact in a turn.
pub struct TurnColumns;

impl JsonSchema for TurnColumns {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "TurnColumns".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let own = ContactMeasure::COLUMNS.iter().map(|(column, _)| (turn_key(column), *column));
        let journal = ContactMeasure::JOURNAL.iter().map(|(column, _)| (turn_key(column), *column));
        numbers(own, journal)
    }
}

/// Numbers of a joint in a cycle.
pub struct CycleColumns;

impl JsonSchema for CycleColumns {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "CycleColumns".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        numbers(CycleJoint::columns().map(|column| (column.key(), column)), std::iter::empty())
    }
}

/// Numbers that are always there, then those that only a journal that wears has.
fn numbers(
    columns: impl Iterator<Item = (String, Column)>,
    of_journal: impl Iterator<Item = (String, Column)>,
) -> Schema {
    let described = |(key, Column { meaning, unit, .. }): (String, Column)| {
        let unit = if unit == "1" { String::new() } else { format!(" [{unit}]") };
        (key, json!({ "description": format!("{meaning}{unit}."), "type": "number" }))
    };
    let mut properties: Map<String, Value> = columns.map(described).collect();
    let required: Vec<Value> = properties.keys().map(|key| json!(key)).collect();
    properties.extend(of_journal.map(described));
    json_schema!({ "type": "object", "properties": properties, "required": required })
}
