//! Laws that are picked by a word: one list of words for files, JSON Schema and messages.

/// Declares an enumeration whose every variant has one word (`name`, also in serialised form) and a title for people.
macro_rules! named {
    ($(#[$about:meta])* pub enum $Name:ident { $($(#[$doc:meta])* $Variant:ident = $word:literal, $title:literal;)+ }) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        #[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
        pub enum $Name {
            $($(#[$doc])* #[cfg_attr(feature = "serde", serde(rename = $word))] $Variant,)+
        }

        impl $Name {
            /// Every one of them.
            pub const ALL: &[Self] = &[$(Self::$Variant),+];

            /// Their words, in the same order.
            pub const NAMES: &[&str] = &[$($word),+];

            /// Its word in files.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$Variant => $word),+ }
            }
        }

        impl core::fmt::Display for $Name {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                f.write_str(match self { $(Self::$Variant => $title),+ })
            }
        }
    };
}
pub(crate) use named;
