//! `schema`: the JSON Schema of mechanism files, so that editors complete and check while one types.

use super::failure::Failure;
use super::file::print;

/// Answers `schema`; the answer is JSON whatever the format.
pub fn run() -> Result<(), Failure> {
    print(&include_str!("../../docs/linkwear.schema.json").trim_end())
}
