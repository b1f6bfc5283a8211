//! Words for laws of the runtime. In: a word. Out: the law. Whoever embeds a mechanism has the runtime for the generator and for the
//! program; read here, without the runtime's own feature for it, both are one and compiled once.

use std::fmt;
use std::marker::PhantomData;

use linkwear_runtime::contact::Restitution;
use linkwear_runtime::wear::{Area, Measure};
#[cfg(test)]
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::{Deserialize, Deserializer, EnumAccess, Error as _, VariantAccess as _, Visitor};

use super::texts::without_texts;

/// A law by its word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Word<T>(pub T);

impl<T: fmt::Display> fmt::Display for Word<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// Laws with words.
pub(super) trait Words: Copy + 'static {
    const TYPE: &'static str;
    const NAMES: &'static [&'static str];
    const ALL: &'static [Self];
}

macro_rules! words {
    ($($Law:ident),*) => {
        $(impl Words for $Law {
            const TYPE: &'static str = stringify!($Law);
            const NAMES: &'static [&'static str] = $Law::NAMES;
            const ALL: &'static [Self] = $Law::ALL;
        })*
        without_texts!($(Word<$Law>),*);
    };
}

words!(Restitution, Area, Measure);

impl<'de, T: Words> Deserialize<'de> for Word<T> {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_enum(T::TYPE, T::NAMES, Reader(PhantomData))
    }
}

struct Reader<T>(PhantomData<T>);

impl<'de, T: Words> Visitor<'de> for Reader<T> {
    type Value = Word<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "enum {}", T::TYPE)
    }

    fn visit_enum<A: EnumAccess<'de>>(self, data: A) -> Result<Word<T>, A::Error> {
        let (word, rest): (String, _) = data.variant()?;
        rest.unit_variant()?;
        let found = T::NAMES.iter().position(|known| *known == word).and_then(|at| T::ALL.get(at));
        found.map(|law| Word(*law)).ok_or_else(|| A::Error::unknown_variant(&word, T::NAMES))
    }
}

#[cfg(test)]
impl<T: JsonSchema> JsonSchema for Word<T> {
    fn inline_schema() -> bool {
        T::inline_schema()
    }

    fn schema_name() -> std::borrow::Cow<'static, str> {
        T::schema_name()
    }

    fn schema_id() -> std::borrow::Cow<'static, str> {
        T::schema_id()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        T::json_schema(generator)
    }
}
