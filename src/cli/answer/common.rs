//! What several answers have: faults and remarks, operations, intervals.

use linkwear_codegen::tape::Operations;
#[cfg(test)]
use schemars::JsonSchema;
use serde::Serialize;

/// A fault, or a remark on the file, with its place.
#[cfg(test)]
#[derive(JsonSchema)]
#[expect(dead_code, reason = "diagnostics write it; here are its keys")]
pub struct Fault {
    /// Code, such as `E0204`; codes never change their meaning.
    code: String,
    /// The file.
    file: Option<String>,
    /// Line from 1.
    line: Option<usize>,
    /// Column from 1, in characters.
    column: Option<usize>,
    /// What is wrong.
    message: String,
    /// What to do about it.
    help: String,
}

/// A remark: on the file, with its place, or on what was done with it.
#[cfg(test)]
#[derive(JsonSchema)]
#[serde(untagged)]
#[expect(dead_code, reason = "diagnostics write it; here are its keys")]
pub enum Remark {
    /// On the file.
    OfFile(Fault),
    /// On what was done with it.
    Later {
        /// Code: `run`, `life`.
        code: String,
        /// What is doubtful.
        message: String,
    },
}

/// Numbers of operations.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct OperationsAnswer {
    /// Multiplications.
    mul: u64,
    /// Additions, subtractions and changes of sign.
    add: u64,
    /// Divisions.
    div: u64,
    /// Square roots.
    sqrt: u64,
    /// Sine-cosine pairs.
    sincos: u64,
    /// All of these, and exponentials, logarithms, angles.
    total: u64,
}

impl From<&Operations> for OperationsAnswer {
    fn from(count: &Operations) -> Self {
        let Operations { mul, add, div, sqrt, sincos, total, .. } = *count;
        Self { mul, add, div, sqrt, sincos, total }
    }
}

/// The ends of an interval, in the unit of what it is of; null where it is open.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct Ends {
    /// Lower end.
    pub lower: Option<f64>,
    /// Upper end.
    pub upper: Option<f64>,
}

/// Something of 10 %, 50 % and 90 % of the lives, the part that has failed before.
#[derive(Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub struct Quantiles<T> {
    /// Of 10 % (B10).
    pub p10: T,
    /// Of 50 % (B50), the median.
    pub p50: T,
    /// Of 90 % (B90).
    pub p90: T,
}

impl<T> From<[T; 3]> for Quantiles<T> {
    fn from([p10, p50, p90]: [T; 3]) -> Self {
        Self { p10, p50, p90 }
    }
}

/// A map from names to numbers, of which some may be null.
#[cfg(test)]
pub type Numbers = std::collections::BTreeMap<String, Option<f64>>;
