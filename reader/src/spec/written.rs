//! Values of the file with their places: the small types that all tables are made of.
//! In: any serde deserializer that answers the two private requests below (only [`super::read`] does).

#[cfg(test)]
use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;

#[cfg(test)]
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use serde::de::{Deserializer, Error, MapAccess, SeqAccess, Visitor};

use crate::source::Span;

/// Name of a tuple struct by which the reader is asked for (start, end, value).
const WITH_SPAN: &str = "$linkwear::At";
/// Name of an enum by which the reader is asked for a value as the variant `scalar`, `list` or `table`, by its form.
pub(super) const BY_FORM: &str = "$linkwear::ByForm";

/// A value and where it is written.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct At<T> {
    /// Where.
    pub span: Span,
    /// What.
    pub value: T,
}

// By hand: what a derive writes for a hundred types takes a sixth of reading to compile.
impl<'de, T: Deserialize<'de>> Deserialize<'de> for At<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Parts<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for Parts<T> {
            type Value = At<T>;
            fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.write_str("a value with its place")
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut parts: A) -> Result<At<T>, A::Error> {
                if let (Some(start), Some(end)) = (parts.next_element()?, parts.next_element()?)
                    && let Some(value) = parts.next_element()?
                {
                    return Ok(At { span: Span { start, end }, value });
                }
                Err(A::Error::custom("a value without its place"))
            }
        }
        deserializer.deserialize_tuple_struct(WITH_SPAN, 3, Parts(PhantomData))
    }
}

#[cfg(test)]
impl<T: JsonSchema> JsonSchema for At<T> {
    fn schema_name() -> Cow<'static, str> {
        T::schema_name()
    }
    fn inline_schema() -> bool {
        T::inline_schema()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        T::json_schema(generator)
    }
}

/// A number or a text such as `"120 mm"` or `"L1 + L2"`, unread.
#[derive(Clone, Debug, PartialEq)]
pub enum Literal {
    /// A bare number.
    Number(f64),
    /// A quantity or formula.
    Text(String),
}

impl<'de> Deserialize<'de> for Literal {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NumberOrText;
        impl Visitor<'_> for NumberOrText {
            type Value = Literal;
            fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.write_str("a quantity such as \"120 mm\", a formula in quotes, or a number")
            }
            fn visit_f64<E: Error>(self, value: f64) -> Result<Literal, E> {
                Ok(Literal::Number(value))
            }
            #[allow(clippy::cast_precision_loss, reason = "numbers of a mechanism are far below 2^53")]
            fn visit_i64<E: Error>(self, value: i64) -> Result<Literal, E> {
                Ok(Literal::Number(value as f64))
            }
            fn visit_str<E: Error>(self, value: &str) -> Result<Literal, E> {
                Ok(Literal::Text(value.to_owned()))
            }
        }
        deserializer.deserialize_any(NumberOrText)
    }
}

#[cfg(test)]
impl JsonSchema for Literal {
    fn schema_name() -> Cow<'static, str> {
        "Quantity".into()
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "A number, a quantity with its unit (\"120 mm\") or a formula (\"L1 + L2\").",
            "type": ["number", "string"],
            "pattern": "[^ ]",
        })
    }
}

/// A quantity or formula and where it is written.
pub type Quantity = At<Literal>;
/// A name and where it is written.
pub type Name = At<String>;

/// Entries of a table in file order: name and value, each with its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Table<T>(pub Vec<(Name, At<T>)>);

impl<T> Default for Table<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Table<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Entries<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for Entries<T> {
            type Value = Table<T>;
            fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.write_str("a table")
            }
            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Table<T>, A::Error> {
                let (mut entries, mut first) = (Vec::new(), None);
                while let Some(name) = map.next_key()? {
                    match map.next_value() {
                        Ok(value) => entries.push((name, value)),
                        Err(error) => first = first.or(Some(error)),
                    }
                }
                first.map_or(Ok(Table(entries)), Err)
            }
        }
        deserializer.deserialize_map(Entries(PhantomData))
    }
}

#[cfg(test)]
impl<T: JsonSchema> JsonSchema for Table<T> {
    fn schema_name() -> Cow<'static, str> {
        format!("TableOf{}", T::schema_name()).into()
    }
    fn inline_schema() -> bool {
        true
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "object", "additionalProperties": generator.subschema_for::<T>() })
    }
}

/// Three components x, y, z in the ground frame.
// The count is checked later, so that the message can teach. So is that of a pair.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[cfg_attr(test, derive(JsonSchema), schemars(extend("minItems" = 3, "maxItems" = 3)))]
pub struct Triple(pub At<Vec<Quantity>>);

/// One triple for everybody, or one for each body by name.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename = "$linkwear::ByForm")]
#[cfg_attr(test, derive(JsonSchema), schemars(rename = "PerBody", untagged))]
pub enum PerBody {
    /// The same for all.
    #[serde(rename = "list", alias = "scalar")]
    Shared(Triple),
    /// By body.
    #[serde(rename = "table", deserialize_with = "of_bodies")]
    #[cfg_attr(test, schemars(extend("minProperties" = 1)))]
    Each(Table<Triple>),
}

/// Triples of one body or more: an empty table says nothing of any.
fn of_bodies<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Table<Triple>, D::Error> {
    let table = Table::deserialize(deserializer)?;
    if table.0.is_empty() {
        Err(D::Error::invalid_length(0, &"a list of three or one for each body"))
    } else {
        Ok(table)
    }
}

impl PerBody {
    /// Where it is written, or begins.
    pub fn span(&self) -> Span {
        match self {
            Self::Shared(triple) => triple.0.span,
            Self::Each(table) => table.0.first().map_or(Span::default(), |(name, _)| name.span),
        }
    }
}

/// Two names.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[cfg_attr(test, derive(JsonSchema), schemars(extend("minItems" = 2, "maxItems" = 2)))]
pub struct Pair(pub At<Vec<Name>>);
