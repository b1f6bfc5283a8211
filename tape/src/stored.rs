//! Values as bytes and back, exactly. In: anything [`Stored`]. Out: bytes; from bytes the value, or [`Damage`].
//!
//! Whole numbers are written seven bits at a time, lowest first; numbers by their bits, lowest byte first; texts and
//! lists with their length before them. [`sealed`] puts a mark, a version and a check sum around them.

mod description;
mod parts;
mod state;
mod tape;
#[cfg(test)]
mod tests;

use linkwear_runtime::Text;
use thiserror::Error;

/// Why bytes are not what was written.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum Damage {
    /// They are something else altogether.
    #[error("this is no file of linkwear")]
    Mark,
    /// Another linkwear wrote them.
    #[error("written in form {found}, this linkwear reads form {expected}: make the file again")]
    Version {
        /// The form they are in.
        found: u32,
        /// The form that is read here.
        expected: u32,
    },
    /// They end too early.
    #[error("the file is cut short")]
    Short,
    /// Their check sum is another, or bytes are left over.
    #[error("the file is damaged: its check sum does not fit")]
    Sum,
    /// A value that cannot be.
    #[error("the file is damaged: {what}")]
    Value {
        /// What is wrong.
        what: String,
    },
}

impl Damage {
    pub(crate) fn value(what: impl Into<String>) -> Self {
        Self::Value { what: what.into() }
    }
}

/// A value that is written to bytes and comes back from them as it was.
pub trait Stored: Sized {
    /// Appends it.
    fn write(&self, to: &mut Vec<u8>);

    /// Takes it off the front.
    ///
    /// # Errors
    /// If the bytes cannot be such a value.
    fn read(from: &mut &[u8]) -> Result<Self, Damage>;
}

/// [`Stored`] for a structure, field by field, and for an enumeration, variant by variant.
#[macro_export]
macro_rules! stored {
    (struct $Type:path { $($field:ident),+ $(,)? }) => {
        impl $crate::stored::Stored for $Type {
            fn write(&self, to: &mut Vec<u8>) {
                $($crate::stored::Stored::write(&self.$field, to);)+
            }

            fn read(from: &mut &[u8]) -> Result<Self, $crate::stored::Damage> {
                Ok(Self { $($field: $crate::stored::Stored::read(from)?),+ })
            }
        }
    };
    (enum $Type:path { $($tag:literal: $Variant:ident $({ $($field:ident),+ })? $(($($item:ident),+))?),+ $(,)? }) => {
        impl $crate::stored::Stored for $Type {
            fn write(&self, to: &mut Vec<u8>) {
                match self {
                    $(Self::$Variant $({ $($field),+ })? $(($($item),+))? => {
                        to.push($tag);
                        $($($crate::stored::Stored::write($field, to);)+)?
                        $($($crate::stored::Stored::write($item, to);)+)?
                    })+
                }
            }

            fn read(from: &mut &[u8]) -> Result<Self, $crate::stored::Damage> {
                match <u8 as $crate::stored::Stored>::read(from)? {
                    $($tag => {
                        $($(let $field = $crate::stored::Stored::read(from)?;)+)?
                        $($(let $item = $crate::stored::Stored::read(from)?;)+)?
                        Ok(Self::$Variant $({ $($field),+ })? $(($($item),+))?)
                    })+
                    _ => Err($crate::stored::Damage::Value { what: format!("no {} is written so", stringify!($Type)) }),
                }
            }
        }
    };
}

const MARK: [u8; 8] = *b"linkwear";
const VERSION: u32 = 5;

/// Bytes of a value with mark, version and check sum.
pub fn sealed(value: &impl Stored) -> Vec<u8> {
    let mut bytes = MARK.to_vec();
    bytes.extend(VERSION.to_le_bytes());
    value.write(&mut bytes);
    bytes.extend(sum(&bytes).to_le_bytes());
    bytes
}

/// The value whose [`sealed`] bytes these are.
///
/// # Errors
/// If they are not such bytes.
pub fn unsealed<T: Stored>(bytes: &[u8]) -> Result<T, Damage> {
    let rest = bytes.strip_prefix(&MARK).ok_or(Damage::Mark)?;
    let (version, rest) = rest.split_first_chunk().ok_or(Damage::Short)?;
    let found = u32::from_le_bytes(*version);
    if found != VERSION {
        return Err(Damage::Version { found, expected: VERSION });
    }
    let (mut body, written) = rest.split_last_chunk().ok_or(Damage::Short)?;
    if u64::from_le_bytes(*written) != sum(&bytes[..bytes.len() - written.len()]) {
        return Err(Damage::Sum);
    }
    let value = T::read(&mut body)?;
    if body.is_empty() { Ok(value) } else { Err(Damage::Sum) }
}

/// FNV-1a of 64 bits.
fn sum(bytes: &[u8]) -> u64 {
    bytes
        .iter()
        .fold(0xcbf2_9ce4_8422_2325, |sum, byte| (sum ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3))
}

/// Takes so many bytes off the front.
fn take<'a>(from: &mut &'a [u8], count: usize) -> Result<&'a [u8], Damage> {
    let (taken, rest) = from.split_at_checked(count).ok_or(Damage::Short)?;
    *from = rest;
    Ok(taken)
}

impl Stored for Text {
    fn write(&self, to: &mut Vec<u8>) {
        self.len().write(to);
        to.extend(self.as_bytes());
    }

    fn read(from: &mut &[u8]) -> Result<Self, Damage> {
        String::read(from).map(Self::from)
    }
}

impl Stored for String {
    fn write(&self, to: &mut Vec<u8>) {
        self.len().write(to);
        to.extend(self.as_bytes());
    }

    fn read(from: &mut &[u8]) -> Result<Self, Damage> {
        let length = usize::read(from)?;
        let text = str::from_utf8(take(from, length)?).map_err(|_| Damage::value("a text is none"))?;
        Ok(text.to_owned())
    }
}
