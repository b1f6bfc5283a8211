//! A serde deserializer over spanned TOML that reports every wrong value and unknown key of a file, not
//! only the first. In: a spanned TOML value. Out: the value as a type, and diagnostics.
//!
//! A derived `Deserialize` gives up at the first error. So a map entry that fails is reported, put on the
//! list of entries to skip, and the whole is read again without it; every field of the file is optional.

use std::cell::RefCell;

use serde::de::value::StrDeserializer;
use serde::de::{
    DeserializeSeed, Deserializer, Error, IntoDeserializer, MapAccess, SeqAccess, Unexpected, Visitor,
};
use serde::{Deserialize, forward_to_deserialize_any};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::failure::Failure;
use super::written::{WITH_FORM, WITH_SPAN};
use crate::diagnostic::{Code, Diagnostic};
use crate::source::Span;

/// What came up while reading.
#[derive(Default)]
pub(super) struct Notes {
    /// Found faults.
    pub diagnostics: Vec<Diagnostic>,
    /// Values that were left out because of them.
    pub skipped: Vec<Span>,
    /// Their keys, and the keys in tables that were left out: things that the user did write.
    pub lost: Vec<String>,
}

/// Reads `T` from a whole document.
pub(super) fn read<T: for<'de> Deserialize<'de> + Default>(document: &Spanned<DeTable<'_>>) -> (T, Notes) {
    let notes = RefCell::new(Notes::default());
    loop {
        let root =
            Reader { value: Value::Table(document.get_ref()), span: document.span().into(), notes: &notes };
        match T::deserialize(root) {
            Ok(value) => return (value, notes.into_inner()),
            Err(failure) if failure.reported => {}
            Err(failure) => {
                notes.borrow_mut().diagnostics.push(failure.diagnostic(document.span().into()));
                return (T::default(), notes.into_inner());
            }
        }
    }
}

#[derive(Clone, Copy)]
enum Value<'a, 'i> {
    Table(&'a DeTable<'i>),
    Other(&'a DeValue<'i>),
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
    value: Value<'a, 'i>,
    span: Span,
    notes: &'a RefCell<Notes>,
}

impl<'a, 'i> Reader<'a, 'i> {
    fn new(value: &'a Spanned<DeValue<'i>>, notes: &'a RefCell<Notes>) -> Self {
        let span = extent(value);
        let value = match value.get_ref() {
            DeValue::Table(table) => Value::Table(table),
            other => Value::Other(other),
        };
        Self { value, span, notes }
    }

    fn form(&self) -> usize {
        match self.value {
            Value::Table(_) => 2,
            Value::Other(DeValue::Array(_)) => 1,
            Value::Other(_) => 0,
        }
    }

    fn visit<'de, V: Visitor<'de>>(
        self,
        fields: Option<&'static [&'static str]>,
        visitor: V,
    ) -> Result<V::Value, Failure> {
        let span = self.span;
        let result = match self.value {
            Value::Table(table) => visitor.visit_map(Entries::new(table, fields, self.notes)),
            Value::Other(DeValue::Array(items)) => {
                visitor.visit_seq(Items { items: items.iter(), notes: self.notes })
            }
            Value::Other(DeValue::String(text)) => visitor.visit_str(text),
            Value::Other(DeValue::Boolean(value)) => visitor.visit_bool(*value),
            Value::Other(DeValue::Integer(number)) => {
                match i64::from_str_radix(number.as_str(), number.radix()) {
                    Ok(value) => visitor.visit_i64(value),
                    Err(_) => Err(Failure::custom("an integer that does not fit into 64 bits")),
                }
            }
            Value::Other(DeValue::Float(number)) => match number.as_str().parse() {
                Ok(value) => visitor.visit_f64(value),
                Err(_) => Err(Failure::custom("a number that cannot be read")),
            },
            Value::Other(_) => Err(Failure::invalid_type(Unexpected::Other("a date or time"), &visitor)),
        };
        result.map_err(|failure| failure.or_at(span))
    }
}

impl<'de> Deserializer<'de> for Reader<'_, '_> {
    type Error = Failure;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Failure> {
        self.visit(None, visitor)
    }
    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Failure> {
        visitor.visit_some(self)
    }
    fn deserialize_newtype_struct<V: Visitor<'de>>(self, _: &str, visitor: V) -> Result<V::Value, Failure> {
        visitor.visit_newtype_struct(self)
    }
    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Failure> {
        self.visit(Some(fields), visitor)
    }
    fn deserialize_tuple_struct<V: Visitor<'de>>(
        self,
        name: &str,
        _: usize,
        visitor: V,
    ) -> Result<V::Value, Failure> {
        match name {
            WITH_SPAN => {
                visitor.visit_seq(Parts { head: vec![self.span.end, self.span.start], value: Some(self) })
            }
            WITH_FORM => visitor.visit_seq(Parts { head: vec![self.form()], value: Some(self) }),
            _ => self.visit(None, visitor),
        }
    }
    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Failure> {
        let span = self.span;
        let Value::Other(DeValue::String(text)) = self.value else {
            return Err(Failure::invalid_type(Unexpected::Other(self.what()), &visitor).or_at(span));
        };
        let text: StrDeserializer<'_, Failure> = text.as_ref().into_deserializer();
        visitor.visit_enum(text).map_err(|failure| failure.or_at(span))
    }
    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 u8 u16 u32 u64 f32 f64 char str string bytes byte_buf unit unit_struct seq tuple
        map identifier ignored_any
    }
}

impl Reader<'_, '_> {
    fn what(&self) -> &'static str {
        match self.value {
            Value::Table(_) => "a table",
            Value::Other(DeValue::Array(_)) => "a list",
            Value::Other(DeValue::String(_)) => "a text",
            Value::Other(DeValue::Boolean(_)) => "true or false",
            Value::Other(_) => "a number",
        }
    }
}

/// The few facts that go before a value on the requests of [`super::written`], last first.
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
        self.value.take().map(|value| seed.deserialize(value)).transpose()
    }
}

struct Items<'a, 'i, I: Iterator<Item = &'a Spanned<DeValue<'i>>>>
where
    'i: 'a,
{
    items: I,
    notes: &'a RefCell<Notes>,
}

impl<'de, 'a, 'i, I: Iterator<Item = &'a Spanned<DeValue<'i>>>> SeqAccess<'de> for Items<'a, 'i, I> {
    type Error = Failure;
    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Failure> {
        self.items.next().map(|value| seed.deserialize(Reader::new(value, self.notes))).transpose()
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
    value: Option<(&'a str, &'a Spanned<DeValue<'i>>)>,
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
                notes.skipped.push(span);
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
    let listed = || fields.iter().map(|field| format!("`{field}`")).collect::<Vec<_>>().join(", ");
    let diagnostic = Diagnostic::new(Code::UnknownKey, format!("the key `{}` means nothing here", entry.key))
        .at(entry.key_span, "unknown key")
        .did_you_mean(entry.key, fields.iter().copied());
    if diagnostic.help.is_empty() {
        diagnostic.help(format!("known keys here: {}", listed()))
    } else {
        diagnostic
    }
}

impl<'de> MapAccess<'de> for Entries<'_, '_> {
    type Error = Failure;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Failure> {
        let Some(entry) = self.rest.pop() else { return Ok(None) };
        self.value = Some((entry.key, entry.value));
        seed.deserialize(Key { text: entry.key, span: entry.key_span }).map(Some)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Failure> {
        let Some((key, value)) = self.value.take() else {
            return Err(Failure::custom("a key without a value"));
        };
        let span = value.span().into();
        seed.deserialize(Reader::new(value, self.notes)).map_err(|failure| {
            if failure.reported {
                return failure;
            }
            let mut notes = self.notes.borrow_mut();
            notes.diagnostics.push(failure.diagnostic(span));
            notes.skipped.push(span);
            notes.lost.push(key.to_owned());
            Failure::already_reported()
        })
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
