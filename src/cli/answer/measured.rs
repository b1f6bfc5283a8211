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
        numbers(ContactMeasure::COLUMNS.iter().map(|(column, _)| (turn_key(column), *column)))
    }
}

/// Numbers of a joint in a cycle.
pub struct CycleColumns;

impl JsonSchema for CycleColumns {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "CycleColumns".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        numbers(CycleJoint::columns().map(|column| (column.key(), column)))
    }
}

fn numbers(columns: impl Iterator<Item = (String, Column)>) -> Schema {
    let mut properties = Map::new();
    for (key, Column { meaning, unit, .. }) in columns {
        let unit = if unit == "1" { String::new() } else { format!(" [{unit}]") };
        properties.insert(key, json!({ "description": format!("{meaning}{unit}."), "type": "number" }));
    }
    let required: Vec<Value> = properties.keys().map(|key| json!(key)).collect();
    json_schema!({ "type": "object", "properties": properties, "required": required })
}
