//! What a result is of. In: a mechanism or data, options. Out: [`Provenance`], and results sealed with it. Never knows results.
//!
//! There is nothing in it that changes no number: no thread, shard, back end, time or path, so that the same question has the same
//! bytes for an answer wherever it is asked.

use linkwear_gamma::FitFile;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// Version of the form of all JSON, fits among it; it rises when a key changes its meaning or goes.
pub const FORMAT: u64 = FitFile::FORMAT;

/// What decides the numbers of a result.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Provenance {
    /// Version of linkwear.
    pub version: String,
    /// SHA-256 of the mechanism's file, of the data, or of the fit.
    pub file_sha256: String,
    /// Seed of the random numbers, where there are any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,
    /// Options that decide numbers, SI where they have units.
    #[cfg_attr(test, schemars(with = "std::collections::BTreeMap<String, Value>"))]
    pub options: Map<String, Value>,
    /// Values of the tunable parameters and of those at generation, SI.
    #[cfg_attr(test, schemars(with = "std::collections::BTreeMap<String, f64>"))]
    #[serde(default, skip_serializing_if = "Map::is_empty")]
    pub parameters: Map<String, Value>,
}

impl Provenance {
    /// By this version, of a file.
    pub fn new(file_sha256: String, seed: Option<u64>, options: Value) -> Self {
        let options = match options {
            Value::Object(options) => options.into_iter().filter(|(_, value)| !value.is_null()).collect(),
            _ => Map::new(),
        };
        Self {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            file_sha256,
            seed,
            options,
            parameters: Map::new(),
        }
    }
}

/// A result with its format first, and what it is of last.
pub fn sealed(result: Value, provenance: Option<&Provenance>) -> Value {
    let Value::Object(result) = result else { return result };
    let mut all = Map::new();
    all.insert("format".to_owned(), FORMAT.into());
    all.extend(result);
    if let Some(provenance) = provenance {
        all.insert("provenance".to_owned(), serde_json::json!(provenance));
    }
    Value::Object(all)
}
