//! A sentence about a thing in the file, read and left alone.

#[cfg(test)]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::texts::without_texts;

/// What a thing is, in a sentence.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(transparent)]
#[cfg_attr(test, schemars(inline))]
pub struct Doc(String);

without_texts!(Doc);
