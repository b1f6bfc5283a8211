//! `--set name=value`.

use thiserror::Error;

/// Parameters given on the command line instead of in the file, as text with units.
#[derive(Clone, Debug, Default)]
pub struct Overrides(pub(super) Vec<(String, String)>);

/// An override that is no `name=value`.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("`{text}` is not of the form name=value, for example speed=\"2 Hz\"")]
pub struct OverrideError {
    /// As given.
    pub text: String,
}

impl Overrides {
    /// Adds `name=value`; the last one for a name counts.
    ///
    /// # Errors
    /// Without `=`.
    pub fn push(&mut self, text: &str) -> Result<(), OverrideError> {
        let Some((name, value)) = text.split_once('=') else {
            return Err(OverrideError { text: text.to_owned() });
        };
        self.0.push((name.trim().to_owned(), value.trim().to_owned()));
        Ok(())
    }

    /// The overrides `name=value` of a list.
    ///
    /// # Errors
    /// At the first without `=`.
    pub fn parse<S: AsRef<str>>(list: impl IntoIterator<Item = S>) -> Result<Self, OverrideError> {
        let mut overrides = Self::default();
        for text in list {
            overrides.push(text.as_ref())?;
        }
        Ok(overrides)
    }

    /// Names with their values.
    pub fn from_pairs(pairs: &[(String, String)]) -> Self {
        Self(pairs.to_vec())
    }

    /// Names that are overridden, in the order given.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.0.iter().map(|(name, _)| name.as_str())
    }
}
