//! Keys that may be written in several forms (a list or a table, a number or a list): how each form is read, and
//! the schema that allows them.

#[cfg(test)]
use std::borrow::Cow;
use std::fmt;

#[cfg(test)]
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use serde::de::{Deserializer, MapAccess, SeqAccess, Visitor};

use super::body::{Centre, Widths};
use super::file::{Parameter, ParameterTable, PointSpec};
use super::force::Places;
use super::joint::ByCoordinate;
use super::start::StartSpec;
use super::written::{At, ByForm, Form, Name, PerBody, read_by_form, value_of};
#[cfg(test)]
use super::{
    joint::EachCoordinate,
    start::StartTable,
    written::{Literal, Triple},
};

impl<'de> ByForm<'de> for Parameter {
    fn read<A: SeqAccess<'de>>(form: Form, value: &mut A) -> Result<Self, A::Error> {
        if form == Form::Table {
            let ParameterTable { value, tunable, assumed, doc: _ } = value_of(value)?;
            return Ok(Self { value, tunable, assumed });
        }
        Ok(Self { value: Some(value_of(value)?), tunable: false, assumed: false })
    }
}

impl<'de> ByForm<'de> for PointSpec {
    fn read<A: SeqAccess<'de>>(form: Form, value: &mut A) -> Result<Self, A::Error> {
        if form == Form::Table {
            return Ok(value_of::<PointTable, _>(value)?.0);
        }
        Ok(Self { at: Some(PerBody::Shared(value_of(value)?)), ..Self::default() })
    }
}

impl<'de> ByForm<'de> for Centre {
    fn read<A: SeqAccess<'de>>(form: Form, value: &mut A) -> Result<Self, A::Error> {
        Ok(if form == Form::List { Self::At(value_of(value)?) } else { Self::Point(value_of(value)?) })
    }
}

impl<'de> ByForm<'de> for Widths {
    fn read<A: SeqAccess<'de>>(form: Form, value: &mut A) -> Result<Self, A::Error> {
        Ok(if form == Form::List {
            Self::Rectangle(value_of(value)?)
        } else {
            Self::Square(value_of(value)?)
        })
    }
}

impl<'de> ByForm<'de> for ByCoordinate {
    fn read<A: SeqAccess<'de>>(form: Form, value: &mut A) -> Result<Self, A::Error> {
        Ok(if form == Form::Table {
            Self::Each(Box::new(value_of(value)?))
        } else {
            Self::One(value_of(value)?)
        })
    }
}

impl<'de> ByForm<'de> for Places {
    fn read<A: SeqAccess<'de>>(form: Form, value: &mut A) -> Result<Self, A::Error> {
        if form == Form::List {
            return Ok(Self(value_of(value)?));
        }
        let name: Name = value_of(value)?;
        Ok(Self(At { span: name.span, value: vec![name] }))
    }
}

impl<'de> ByForm<'de> for StartSpec {
    fn read<A: SeqAccess<'de>>(form: Form, value: &mut A) -> Result<Self, A::Error> {
        Ok(match form {
            Form::Scalar => Self::One(value_of(value)?),
            Form::List => Self::List(value_of(value)?),
            Form::Table => Self::Table(Box::new(value_of(value)?)),
        })
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
                        _ => point.by_body.0.push((key, map.next_value()?)),
                    }
                }
                Ok(PointTable(point))
            }
        }
        deserializer.deserialize_map(Keys)
    }
}

/// `Deserialize` by form, and a schema that allows the listed forms.
macro_rules! written_in_forms {
    ($($type:ident: $generator:ident => $schema:expr;)*) => {$(
        impl<'de> Deserialize<'de> for $type {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                read_by_form(deserializer)
            }
        }
        #[cfg(test)]
        impl JsonSchema for $type {
            fn schema_name() -> Cow<'static, str> {
                stringify!($type).into()
            }
            fn json_schema($generator: &mut SchemaGenerator) -> Schema {
                $schema
            }
        }
    )*};
}

written_in_forms! {
    Parameter: g => {
        json_schema!({ "anyOf": [g.subschema_for::<Literal>(), g.subschema_for::<ParameterTable>()] })
    };
    PointSpec: g => {
        let position = g.subschema_for::<PerBody>();
        let triple = g.subschema_for::<Triple>();
        json_schema!({ "anyOf": [triple, {
            "type": "object",
            "properties": {
                "at": position,
                "on": { "type": "string", "description": "Body that carries the point." },
                "assumed": { "type": "boolean", "description": "Our own assumption." },
                "doc": { "type": "string" },
            },
            "additionalProperties": triple,
        }]})
    };
    Centre: g => json_schema!({ "anyOf": [{ "type": "string" }, g.subschema_for::<Triple>()] });
    Widths: g => {
        let quantity = g.subschema_for::<Literal>();
        json_schema!({ "anyOf": [quantity, { "type": "array", "items": quantity, "minItems": 2, "maxItems": 2 }] })
    };
    ByCoordinate: g => {
        json_schema!({ "anyOf": [g.subschema_for::<Literal>(), g.subschema_for::<EachCoordinate>()] })
    };
    Places: _g => json_schema!({ "anyOf": [{ "type": "string" }, { "type": "array", "items": { "type": "string" } }] });
    StartSpec: g => {
        let quantity = g.subschema_for::<Literal>();
        json_schema!({ "anyOf": [quantity, { "type": "array", "items": quantity }, g.subschema_for::<StartTable>()] })
    };
}
