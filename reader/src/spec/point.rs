//! Points as written: three coordinates, or a table in which positions may stand by body.

#[cfg(test)]
use std::borrow::Cow;
use std::fmt;

#[cfg(test)]
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use serde::de::{DeserializeSeed, Deserializer, Error, IgnoredAny, MapAccess, Visitor};
#[cfg(test)]
use serde_json::json;

use super::texts::texts_of;
use super::written::{At, Name, PerBody, Table, Triple};

/// Keys of a point's table; all others are names of bodies.
pub const POINT_KEYS: &[&str] = &["at", "on", "assumed", "doc"];

/// Where a point is.
#[derive(Clone, Debug, Default)]
pub struct PointSpec {
    /// Coordinates, for all or by body.
    pub at: Option<PerBody>,
    /// Coordinates by body, written without `at`.
    pub by_body: Table<Triple>,
    /// Body that carries the point.
    pub on: Option<Name>,
    /// Our own assumption.
    pub assumed: bool,
}

texts_of! { struct PointSpec { at, by_body, on } }

#[derive(Deserialize)]
#[serde(rename = "$linkwear::ByForm")]
enum PointForm {
    #[serde(rename = "list", alias = "scalar")]
    Coordinates(Triple),
    #[serde(rename = "table")]
    Table(PointTable),
}

impl<'de> Deserialize<'de> for PointSpec {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Ok(match PointForm::deserialize(deserializer)? {
            PointForm::Coordinates(at) => Self { at: Some(PerBody::Shared(at)), ..Self::default() },
            PointForm::Table(PointTable(point)) => point,
        })
    }
}

/// The coordinates that a point has on the body of this name. What is no list makes the name a key, which is none.
struct OfBody<'a>(&'a str);

#[derive(Deserialize)]
#[serde(rename = "$linkwear::ByForm")]
enum OfBodyForm {
    #[serde(rename = "list")]
    Coordinates(At<Triple>),
    #[serde(rename = "scalar", alias = "table")]
    Other(IgnoredAny),
}

impl<'de> DeserializeSeed<'de> for OfBody<'_> {
    type Value = At<Triple>;
    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<At<Triple>, D::Error> {
        match OfBodyForm::deserialize(deserializer)? {
            OfBodyForm::Coordinates(at) => Ok(at),
            OfBodyForm::Other(_) => Err(Error::unknown_field(self.0, POINT_KEYS)),
        }
    }
}

struct PointTable(PointSpec);

impl<'de> Deserialize<'de> for PointTable {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Keys;
        impl<'de> Visitor<'de> for Keys {
            type Value = PointTable;
            fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.write_str("three coordinates or a table of them")
            }
            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<PointTable, A::Error> {
                let mut point = PointSpec::default();
                while let Some(key) = map.next_key::<Name>()? {
                    match key.value.as_str() {
                        "at" => point.at = Some(map.next_value()?),
                        "on" => point.on = Some(map.next_value()?),
                        "assumed" => point.assumed = map.next_value()?,
                        "doc" => drop(map.next_value::<String>()?),
                        _ => {
                            let at = map.next_value_seed(OfBody(&key.value))?;
                            point.by_body.0.push((key, at));
                        }
                    }
                }
                Ok(PointTable(point))
            }
        }
        deserializer.deserialize_map(Keys)
    }
}

#[cfg(test)]
impl JsonSchema for PointSpec {
    fn schema_name() -> Cow<'static, str> {
        "PointSpec".into()
    }
    fn json_schema(g: &mut SchemaGenerator) -> Schema {
        let position = g.subschema_for::<PerBody>();
        let triple = g.subschema_for::<Triple>();
        let on = json!({ "type": "string", "description": "Body that carries the point. [body; default the first described with it; e.g. \"crank\"]" });
        let assumed = json!({ "type": "boolean", "description": "Our own assumption. [mark]" });
        let doc = json!({ "type": "string", "description": "What it is. [text]" });
        json_schema!({ "anyOf": [triple, {
            "type": "object",
            "properties": {
                "at": { "anyOf": [position], "description": "Coordinates, for all or by body. [m; any; required; e.g. [\"L1\", \"0 mm\", 0]]" },
                "on": on, "assumed": assumed, "doc": doc,
            },
            "additionalProperties": false,
            "required": ["at"],
        }, {
            "type": "object",
            "properties": { "on": on, "assumed": assumed, "doc": doc },
            "additionalProperties": triple,
            // Some body's position.
            "not": { "propertyNames": { "enum": ["on", "assumed", "doc"] } },
        }]})
    }
}
