//! A sentence about a thing in the file, read and left alone.

use schemars::JsonSchema;
use serde::Deserialize;

use super::texts::without_texts;

/// What a thing is, in a sentence.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(transparent)]
#[schemars(inline)]
pub struct Doc(#[expect(dead_code, reason = "for readers of the file")] String);

without_texts!(Doc);
