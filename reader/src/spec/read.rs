//! A serde deserializer over spanned TOML that reports every wrong value and unknown key of a file, not
//! only the first. In: a spanned TOML value. Out: the value as a type, and diagnostics.
//!
//! A derived `Deserialize` gives up at the first error. So a map entry that fails is reported, put on the
//! list of entries to skip, and the whole is read again without it; every field of the file is optional.
//! Tables of named things are read to their end first, so that a thousand faults do not take a thousand readings.

use std::cell::RefCell;
use std::collections::HashSet;
use std::slice;

use serde::de::value::StrDeserializer;
use serde::de::{
    DeserializeSeed, Deserializer, EnumAccess, Error, Expected, IntoDeserializer, MapAccess, SeqAccess,
    Unexpected, VariantAccess, Visitor,
};
use serde::{Deserialize, forward_to_deserialize_any};
use toml::Spanned;
use toml::de::{DeFloat, DeInteger, DeTable, DeValue};

use super::failure::{self, Failure};
use super::written::BY_FORM;
use crate::diagnostic::{Code, Diagnostic};
use crate::source::Span;

/// For numbers that do not fit.
const LARGE: &str = "write it with a point or an exponent, as `1e20`";

/// What came up while reading.
#[derive(Default)]
pub(super) struct Notes {
    /// Found faults.
    pub diagnostics: Vec<Diagnostic>,
    /// Values that were left out because of them.
    pub skipped: HashSet<Span>,
    /// Their keys, and the keys in tables that were left out: things that the user did write.
    pub lost: Vec<String>,
}

/// Reads `T` from a whole document.
pub(super) fn read<T: for<'de> Deserialize<'de> + Default>(document: Spanned<DeTable<'_>>) -> (T, Notes) {
    let notes = RefCell::new(Notes::default());
    let root = Spanned::new(document.span(), DeValue::Table(document.into_inner()));
    loop {
        match T::deserialize(Reader { value: &root, notes: &notes }) {
            Ok(value) => return (value, notes.into_inner()),
            Err(failure) if failure.reported => {}
            Err(failure) => {
                notes.borrow_mut().diagnostics.push(failure.diagnostic(root.span().into()));
                return (T::default(), notes.into_inner());
            }
        }
    }
}

/// The place of a value. A table under a header `[joints.R1]` has only the header as its place: its entries belong to it too.
fn extent(value: &Spanned<DeValue<'_>>) -> Span {
    let whole: Span = value.span().into();
    let DeValue::Table(table) = value.get_ref() else { return whole };
    table.iter().fold(whole, |whole, (key, inner)| {
        let inner = extent(inner);
        Span { start: whole.start.min(key.span().start), end: whole.end.max(inner.end) }
    })
}

#[derive(Clone, Copy)]
struct Reader<'a, 'i> {
    value: &'a Spanned<DeValue<'i>>,
    notes: &'a RefCell<Notes>,
}

impl<'a, 'i> Reader<'a, 'i> {
    fn visit<'de, V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Failure> {
        let result = match self.value.get_ref() {
            DeValue::Table(table) => visitor.visit_map(self.entries(table, None)),
            DeValue::Array(items) => visitor.visit_seq(self.items(items)),
            DeValue::String(text) => visitor.visit_str(text),
            DeValue::Boolean(value) => visitor.visit_bool(*value),
            DeValue::Integer(number) => integer(number).and_then(|value| visitor.visit_i64(value)),
            DeValue::Float(number) => float(number).and_then(|value| visitor.visit_f64(value)),
            DeValue::Datetime(_) => return Err(self.not(&visitor)),
        };
        self.placed(result)
    }

    /// A result whose error knows its place.
    fn placed<T>(self, result: Result<T, Failure>) -> Result<T, Failure> {
        match result {
            Err(failure) => Err(self.place(failure)),
            right => right,
        }
    }

    fn place(self, failure: Failure) -> Failure {
        failure.or_at(extent(self.value))
    }

    /// The value is not what is needed.
    fn not(self, needed: &dyn Expected) -> Failure {
        self.place(Failure::invalid_type(unexpected(self.value.get_ref()), needed))
    }

    fn items(self, items: &'a [Spanned<DeValue<'i>>]) -> Items<'a, 'i> {
        Items { rest: items.iter(), notes: self.notes }
    }

    fn entries(self, table: &'a DeTable<'i>, fields: Option<&[&str]>) -> Entries<'a, 'i> {
        Entries::new(table, fields, self.notes)
    }
}

fn integer(number: &DeInteger<'_>) -> Result<i64, Failure> {
    i64::from_str_radix(number.as_str(), number.radix())
        .map_err(|_| Failure::custom("an integer that does not fit into 64 bits").advise(LARGE))
}

fn float(number: &DeFloat<'_>) -> Result<f64, Failure> {
    number.as_str().parse().map_err(|_| Failure::custom("a number that cannot be read").advise(LARGE))
}

/// What was found where something else is needed.
fn unexpected<'v>(value: &'v DeValue<'_>) -> Unexpected<'v> {
    match value {
        DeValue::Table(_) => Unexpected::Map,
        DeValue::Array(_) => Unexpected::Seq,
        DeValue::String(text) => Unexpected::Str(text),
        DeValue::Boolean(value) => Unexpected::Bool(*value),
        DeValue::Integer(number) => i64::from_str_radix(number.as_str(), number.radix())
            .map_or(Unexpected::Other("an integer"), Unexpected::Signed),
        DeValue::Float(number) => {
            number.as_str().parse().map_or(Unexpected::Other("a number"), Unexpected::Float)
        }
        DeValue::Datetime(_) => Unexpected::Other("a date or time"),
    }
}

impl<'de> Deserializer<'de> for Reader<'_, '_> {
    type Error = Failure;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Failure> {
        self.visit(visitor)
    }
    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Failure> {
        visitor.visit_some(self)
    }
    fn deserialize_newtype_struct<V: Visitor<'de>>(self, _: &str, visitor: V) -> Result<V::Value, Failure> {
        visitor.visit_newtype_struct(self)
    }
    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Failure> {
        match self.value.get_ref() {
            DeValue::Array(items) => self.placed(visitor.visit_seq(self.items(items))),
            _ => Err(self.not(&visitor)),
        }
    }
    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Failure> {
        match self.value.get_ref() {
            DeValue::Table(table) => self.placed(visitor.visit_map(self.entries(table, None))),
            _ => Err(self.not(&visitor)),
        }
    }
    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Failure> {
        match self.value.get_ref() {
            DeValue::Table(table) => self.placed(visitor.visit_map(self.entries(table, Some(fields)))),
            // A list would be read by the order of the fields in our source, which is nobody's business.
            _ => Err(self.not(&visitor)),
        }
    }
    /// The value with its place: the only such struct is [`super::written::At`].
    fn deserialize_tuple_struct<V: Visitor<'de>>(self, _: &str, _: usize, v: V) -> Result<V::Value, Failure> {
        let span = extent(self.value);
        v.visit_seq(Parts { head: vec![span.end, span.start], value: Some(self) })
    }
    fn deserialize_enum<V: Visitor<'de>>(
        self,
        name: &str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Failure> {
        let form = match self.value.get_ref() {
            DeValue::String(text) if name != BY_FORM => {
                let text: StrDeserializer<'_, Failure> = text.as_ref().into_deserializer();
                return self.placed(visitor.visit_enum(text));
            }
            _ if name != BY_FORM => return Err(self.not(&visitor)),
            DeValue::Table(_) => "table",
            DeValue::Array(_) => "list",
            _ => "scalar",
        };
        visitor.visit_enum(ByForm { form, value: self })
    }
    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 u8 u16 u32 u64 f32 f64 char str string bytes byte_buf unit unit_struct tuple
        identifier ignored_any
    }
}

/// A value as the variant that its form names.
struct ByForm<'a, 'i> {
    form: &'static str,
    value: Reader<'a, 'i>,
}

impl<'de, 'a, 'i> EnumAccess<'de> for ByForm<'a, 'i> {
    type Error = Failure;
    type Variant = Reader<'a, 'i>;
    fn variant_seed<V: DeserializeSeed<'de>>(self, seed: V) -> Result<(V::Value, Reader<'a, 'i>), Failure> {
        let form: StrDeserializer<'_, Failure> = self.form.into_deserializer();
        Ok((seed.deserialize(form)?, self.value))
    }
}

impl<'de> VariantAccess<'de> for Reader<'_, '_> {
    type Error = Failure;
    fn unit_variant(self) -> Result<(), Failure> {
        Err(self.not(&"a value"))
    }
    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, Failure> {
        seed.deserialize(self)
    }
    fn tuple_variant<V: Visitor<'de>>(self, _: usize, visitor: V) -> Result<V::Value, Failure> {
        self.deserialize_seq(visitor)
    }
    fn struct_variant<V: Visitor<'de>>(
        self,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Failure> {
        self.deserialize_struct("", fields, visitor)
    }
}

/// The values of a list.
struct Items<'a, 'i> {
    rest: slice::Iter<'a, Spanned<DeValue<'i>>>,
    notes: &'a RefCell<Notes>,
}

impl<'de> SeqAccess<'de> for Items<'_, '_> {
    type Error = Failure;
    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Failure> {
        match self.rest.next() {
            Some(value) => seed.deserialize(Reader { value, notes: self.notes }).map(Some),
            None => Ok(None),
        }
    }
}

/// What goes before a value that is asked for with its place, last first.
struct Parts<R> {
    head: Vec<usize>,
    value: Option<R>,
}

impl<'de, R: Deserializer<'de, Error = Failure>> SeqAccess<'de> for Parts<R> {
    type Error = Failure;
    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Failure> {
        if let Some(fact) = self.head.pop() {
            return seed.deserialize(fact.into_deserializer()).map(Some);
        }
        match self.value.take() {
            Some(value) => seed.deserialize(value).map(Some),
            None => Ok(None),
        }
    }
}

struct Entry<'a, 'i> {
    key: &'a str,
    key_span: Span,
    value: &'a Spanned<DeValue<'i>>,
}

struct Entries<'a, 'i> {
    /// In reverse, so that the next one is popped.
    rest: Vec<Entry<'a, 'i>>,
    value: Option<Entry<'a, 'i>>,
    notes: &'a RefCell<Notes>,
}

impl<'a, 'i> Entries<'a, 'i> {
    fn new(table: &'a DeTable<'i>, fields: Option<&[&str]>, notes: &'a RefCell<Notes>) -> Self {
        let mut rest = Vec::with_capacity(table.len());
        for (key, value) in table {
            let entry = Entry { key: key.get_ref(), key_span: key.span().into(), value };
            let span = value.span().into();
            if notes.borrow().skipped.contains(&span) {
                continue;
            }
            if fields.is_some_and(|fields| !fields.contains(&entry.key)) {
                let mut notes = notes.borrow_mut();
                notes.diagnostics.push(unknown_key(&entry, fields.unwrap_or_default()));
                notes.skipped.insert(span);
                if let DeValue::Table(inner) = value.get_ref() {
                    notes.lost.extend(inner.keys().map(|key| key.get_ref().to_string()));
                }
                continue;
            }
            rest.push(entry);
        }
        rest.sort_by_key(|entry| std::cmp::Reverse(entry.key_span.start));
        Self { rest, value: None, notes }
    }
}

fn unknown_key(entry: &Entry<'_, '_>, fields: &[&str]) -> Diagnostic {
    Diagnostic::new(Code::UnknownKey, failure::unknown_key(entry.key))
        .at(entry.key_span, "unknown key")
        .help(failure::known_keys(entry.key, fields))
}

impl<'de> MapAccess<'de> for Entries<'_, '_> {
    type Error = Failure;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Failure> {
        let Some(entry) = self.rest.pop() else { return Ok(None) };
        let key = Key { text: entry.key, span: entry.key_span };
        self.value = Some(entry);
        seed.deserialize(key).map(Some)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Failure> {
        let Some(Entry { key, key_span, value }) = self.value.take() else {
            return Err(Failure::custom("a key without a value"));
        };
        match seed.deserialize(Reader { value, notes: self.notes }) {
            Err(failure) if !failure.reported => Err(self.report(failure, key, key_span, value)),
            result => result,
        }
    }
}

impl Entries<'_, '_> {
    /// Puts a fault among the diagnostics and its value among those to skip.
    fn report(&self, failure: Failure, key: &str, key_span: Span, value: &Spanned<DeValue<'_>>) -> Failure {
        let span = value.span().into();
        let failure = failure.under(key).at_key(key_span);
        let mut notes = self.notes.borrow_mut();
        notes.diagnostics.push(failure.diagnostic(span));
        notes.skipped.insert(span);
        notes.lost.push(key.to_owned());
        Failure::already_reported()
    }
}

struct Key<'a> {
    text: &'a str,
    span: Span,
}

impl<'de> Deserializer<'de> for Key<'_> {
    type Error = Failure;
    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Failure> {
        visitor.visit_str(self.text)
    }
    fn deserialize_tuple_struct<V: Visitor<'de>>(self, _: &str, _: usize, v: V) -> Result<V::Value, Failure> {
        let head = vec![self.span.end, self.span.start];
        v.visit_seq(Parts { head, value: Some(self) })
    }
    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 u8 u16 u32 u64 f32 f64 char str string bytes byte_buf option unit unit_struct
        newtype_struct seq tuple map struct enum identifier ignored_any
    }
}
