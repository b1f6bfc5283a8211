//! Values of the file with their places: the small types that all tables are made of.
//! In: any serde deserializer that answers the two private requests below (only [`super::read`] does).

#[cfg(test)]
use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;

#[cfg(test)]
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Deserialize, Deserializer, Error, MapAccess, SeqAccess, Visitor};

use crate::source::Span;

/// Asks the reader for (start, end, value).
pub(super) const WITH_SPAN: &str = "$linkwear::At";
/// Asks the reader for (form, value).
pub(super) const WITH_FORM: &str = "$linkwear::Form";

/// A value and where it is written.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct At<T> {
    /// Where.
    pub span: Span,
    /// What.
    pub value: T,
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for At<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Parts<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for Parts<T> {
            type Value = At<T>;
            fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.write_str("a value with its place")
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut parts: A) -> Result<At<T>, A::Error> {
                let missing = || A::Error::custom("the deserializer does not tell places");
                let start = parts.next_element::<usize>()?.ok_or_else(missing)?;
                let end = parts.next_element::<usize>()?.ok_or_else(missing)?;
                let value = parts.next_element()?.ok_or_else(missing)?;
                Ok(At { span: Span { start, end }, value })
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
                let mut entries = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    entries.push(entry);
                }
                Ok(Table(entries))
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

/// The form in which a value is written, for keys that allow several.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    Scalar,
    List,
    Table,
}

/// A value whose form decides how it is read.
pub(super) trait ByForm<'de>: Sized {
    /// Reads the value, `form` known.
    fn read<A: SeqAccess<'de>>(form: Form, value: &mut A) -> Result<Self, A::Error>;
}

/// Reads `T` after asking the reader for the form of the value.
pub(super) fn read_by_form<'de, T: ByForm<'de>, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<T, D::Error> {
    struct Forms<T>(PhantomData<T>);
    impl<'de, T: ByForm<'de>> Visitor<'de> for Forms<T> {
        type Value = T;
        fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
            formatter.write_str("a value with its form")
        }
        fn visit_seq<A: SeqAccess<'de>>(self, mut parts: A) -> Result<T, A::Error> {
            let form = match parts.next_element::<usize>()? {
                Some(1) => Form::List,
                Some(2) => Form::Table,
                _ => Form::Scalar,
            };
            T::read(form, &mut parts)
        }
    }
    deserializer.deserialize_tuple_struct(WITH_FORM, 2, Forms(PhantomData))
}

/// The value behind its form.
pub(super) fn value_of<'de, T: Deserialize<'de>, A: SeqAccess<'de>>(parts: &mut A) -> Result<T, A::Error> {
    parts.next_element()?.ok_or_else(|| A::Error::custom("the deserializer does not tell forms"))
}

/// A list of three, as the schema says; the count is checked later, so that the message can teach.
#[derive(Clone, Debug, PartialEq)]
pub struct Triple(pub At<Vec<Quantity>>);

impl<'de> Deserialize<'de> for Triple {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        At::deserialize(deserializer).map(Self)
    }
}

#[cfg(test)]
impl JsonSchema for Triple {
    fn schema_name() -> Cow<'static, str> {
        "Triple".into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "Three components x, y, z in the ground frame.",
            "type": "array", "items": generator.subschema_for::<Literal>(), "minItems": 3, "maxItems": 3,
        })
    }
}

/// One triple for everybody, or one for each body by name.
#[derive(Clone, Debug, PartialEq)]
pub enum PerBody {
    /// The same for all.
    Shared(Triple),
    /// By body.
    Each(Table<Triple>),
}

impl<'de> ByForm<'de> for PerBody {
    fn read<A: SeqAccess<'de>>(form: Form, value: &mut A) -> Result<Self, A::Error> {
        Ok(match form {
            Form::Table => Self::Each(value_of(value)?),
            _ => Self::Shared(value_of(value)?),
        })
    }
}

impl<'de> Deserialize<'de> for PerBody {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        read_by_form(deserializer)
    }
}

#[cfg(test)]
impl JsonSchema for PerBody {
    fn schema_name() -> Cow<'static, str> {
        "PerBody".into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let triple = generator.subschema_for::<Triple>();
        json_schema!({ "anyOf": [triple, { "type": "object", "additionalProperties": triple }] })
    }
}

/// Two names, the first the parent.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair(pub At<Vec<Name>>);

impl<'de> Deserialize<'de> for Pair {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        At::deserialize(deserializer).map(Self)
    }
}

#[cfg(test)]
impl JsonSchema for Pair {
    fn schema_name() -> Cow<'static, str> {
        "Pair".into()
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "Two names.",
            "type": "array", "items": { "type": "string" }, "minItems": 2, "maxItems": 2,
        })
    }
}
