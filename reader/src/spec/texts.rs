//! Everything with texts in it, so that the copies of a group can put the index into them.
//! [`tables!`] declares tables of the file and [`texts_of!`] lists the parts of other types; whatever is declared
//! by the former cannot be forgotten.

use crate::source::Span;

use super::written::{At, Literal, Pair, PerBody, Table, Triple};

pub(super) type Change<'a> = &'a mut dyn FnMut(&mut String, Span);

/// Everything with texts in it.
pub(super) trait Texts {
    /// Calls `change` for every text with its place.
    fn each(&mut self, span: Span, change: Change<'_>);

    /// Where it is written, or begins; marks and sentences do not know.
    fn place(&self) -> Option<Span> {
        None
    }
}

impl Texts for String {
    fn each(&mut self, span: Span, change: Change<'_>) {
        change(self, span);
    }
}

impl Texts for Literal {
    fn each(&mut self, span: Span, change: Change<'_>) {
        if let Self::Text(text) = self {
            change(text, span);
        }
    }
}

impl<T: Texts> Texts for At<T> {
    fn each(&mut self, _: Span, change: Change<'_>) {
        self.value.each(self.span, change);
    }
    fn place(&self) -> Option<Span> {
        Some(self.span)
    }
}

impl<T: Texts> Texts for Option<T> {
    fn each(&mut self, span: Span, change: Change<'_>) {
        self.iter_mut().for_each(|value| value.each(span, change));
    }
    fn place(&self) -> Option<Span> {
        self.as_ref()?.place()
    }
}

impl<T: Texts> Texts for Vec<T> {
    fn each(&mut self, span: Span, change: Change<'_>) {
        self.iter_mut().for_each(|value| value.each(span, change));
    }
}

impl<T: Texts> Texts for Box<T> {
    fn each(&mut self, span: Span, change: Change<'_>) {
        self.as_mut().each(span, change);
    }
    fn place(&self) -> Option<Span> {
        self.as_ref().place()
    }
}

impl<T: Texts> Texts for Table<T> {
    fn each(&mut self, span: Span, change: Change<'_>) {
        for (name, value) in &mut self.0 {
            name.each(span, change);
            value.each(span, change);
        }
    }
    fn place(&self) -> Option<Span> {
        Some(self.0.first().map_or(Span::default(), |(name, _)| name.span))
    }
}

/// Types whose values are never copied with an index.
macro_rules! without_texts {
    ($($type:ty),*) => {
        $(impl $crate::spec::texts::Texts for $type {
            fn each(&mut self, _: $crate::source::Span, _: $crate::spec::texts::Change<'_>) {}
        })*
    };
}
pub(super) use without_texts;

without_texts!(bool, i64);

/// Parts with texts, of structs and of enums whose variants hold one value.
macro_rules! texts_of {
    ($(struct $type:ident { $($field:tt),* })* $(enum $choice:ident { $($variant:ident),* })*) => {
        $(impl $crate::spec::texts::Texts for $type {
            fn each(&mut self, span: $crate::source::Span, change: $crate::spec::texts::Change<'_>) {
                $(self.$field.each(span, change);)*
            }
            fn place(&self) -> Option<$crate::source::Span> {
                [$(self.$field.place()),*].into_iter().flatten().next()
            }
        })*
        $(impl $crate::spec::texts::Texts for $choice {
            fn each(&mut self, span: $crate::source::Span, change: $crate::spec::texts::Change<'_>) {
                match self {
                    $(Self::$variant(value) => value.each(span, change),)*
                }
            }
            fn place(&self) -> Option<$crate::source::Span> {
                match self {
                    $(Self::$variant(value) => value.place(),)*
                }
            }
        })*
    };
}
pub(super) use texts_of;

/// Tables of the file: parser, JSON Schema, [`Texts`] and the keys that are written of each.
macro_rules! tables {
    ($($(#[$about:meta])* pub struct $name:ident { $($(#[$of:meta])* pub $field:ident: $type:ty,)* })*) => {
        $(
            #[derive(Clone, Debug, Default, Deserialize)]
            #[cfg_attr(test, derive(JsonSchema))]
            #[serde(default, deny_unknown_fields)]
            $(#[$about])*
            pub struct $name { $($(#[$of])* pub $field: $type,)* }
            texts_of! { struct $name { $($field),* } }
            impl $name {
                /// Fields that are written, each with its place; marks and sentences have none.
                pub fn written(&self) -> Vec<(&'static str, $crate::source::Span)> {
                    use $crate::spec::texts::Texts as _;
                    let fields = [$((stringify!($field), self.$field.place())),*];
                    fields.into_iter().filter_map(|(field, place)| Some((field, place?))).collect()
                }
            }
        )*
    };
}
pub(super) use tables;

texts_of! {
    struct Triple { 0 }
    struct Pair { 0 }
    enum PerBody { Shared, Each }
}
