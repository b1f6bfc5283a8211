//! Lists of a known length as files have them. A serde array takes the first entries of a longer list without a word; these
//! refuse it.

use serde::de::Error as _;
use serde::{Deserialize, Deserializer};

/// What is read with exactly as many entries as it has.
pub trait Exact<'de>: Sized {
    /// Reads it.
    ///
    /// # Errors
    /// A list that is longer or shorter.
    fn exact<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error>;
}

/// For `deserialize_with`.
///
/// # Errors
/// Those of [`Exact::exact`].
pub fn whole_list<'de, T: Exact<'de>, D: Deserializer<'de>>(from: D) -> Result<T, D::Error> {
    T::exact(from)
}

fn list<'de, T: Deserialize<'de>, const N: usize, D: Deserializer<'de>>(from: D) -> Result<[T; N], D::Error> {
    let given = Vec::<T>::deserialize(from)?;
    let count = given.len();
    given.try_into().map_err(|_| D::Error::custom(format_args!("a list of {count} where {N} are needed")))
}

impl<'de> Exact<'de> for [f64; 3] {
    fn exact<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        list(from)
    }
}

impl<'de> Exact<'de> for [String; 2] {
    fn exact<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        list(from)
    }
}

#[derive(Deserialize)]
struct Row(#[serde(deserialize_with = "whole_list")] [f64; 3]);

impl<'de> Exact<'de> for [[f64; 3]; 3] {
    fn exact<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        list(from).map(|rows: [Row; 3]| rows.map(|row| row.0))
    }
}

impl<'de> Exact<'de> for Vec<[f64; 3]> {
    fn exact<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        Vec::<Row>::deserialize(from).map(|rows| rows.into_iter().map(|row| row.0).collect())
    }
}
