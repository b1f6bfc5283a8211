//! The JSON Schema of the file, for editors; made from the same types as the parser.

use super::file::File;

/// JSON Schema (draft 2020-12) of a mechanism file.
#[must_use]
pub fn json_schema() -> serde_json::Value {
    let mut schema = schemars::schema_for!(File).to_value();
    if let Some(root) = schema.as_object_mut() {
        root.insert("title".into(), "linkwear mechanism".into());
    }
    schema
}
