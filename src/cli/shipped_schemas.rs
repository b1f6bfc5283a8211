//! The JSON Schemas of all outputs, by name, as `answer/schemas.rs` makes them. Never knows what is in them.

/// A schema by its name, from the file that has it.
macro_rules! schemas {
    ($($name:literal),+) => {
        [$(($name, include_str!(concat!("../../docs/schemas/", $name, ".schema.json")))),+]
    };
}

/// The schemas of all outputs.
pub const SCHEMAS: [(&str, &str); 26] = schemas![
    "check",
    "equations",
    "cost",
    "generate",
    "fmu",
    "report",
    "view",
    "draw",
    "simulate",
    "life",
    "study",
    "fit",
    "fit-file",
    "identify",
    "sensitivity",
    "plan",
    "predict",
    "diff",
    "explain",
    "import",
    "new",
    "completions",
    "man",
    "errors",
    "table",
    "parquet"
];
