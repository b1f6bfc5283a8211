//! `--format json` of any subcommand that failed.

use schemars::JsonSchema;

use super::common::Fault;
use super::life::CycleAnswer;

/// What did not work: the answer in place of every other.
#[derive(JsonSchema)]
#[expect(dead_code, reason = "failures write it; here are its keys")]
pub struct Errors {
    /// All that is wrong.
    errors: Vec<Fault>,
    /// Cycles of a life that stopped, where they are in no file.
    #[serde(skip_serializing_if = "Option::is_none")]
    cycles: Option<Vec<CycleAnswer>>,
}
