//! What `diff` can be asked.

use std::path::PathBuf;

use clap::Args;

use super::super::value::from_zero;

#[derive(Debug, Args)]
pub struct DiffArguments {
    /// The one: JSON, a table (CSV, .npy, .parquet), a mechanism file, or the folder of a life.
    pub a: PathBuf,
    /// The other, of the same kind.
    pub b: PathBuf,
    /// Exit with 1 unless all agree within this part of a column's range; what they are of may differ.
    #[arg(long, value_name = "R", value_parser = from_zero, allow_negative_numbers = true)]
    pub tolerance: Option<f64>,
}
