//! What can be asked of derivatives: the definitions that clap reads. Never knows who answers.

use std::num::NonZero;

use clap::Args;

use super::super::options::Input;
use super::super::value::{positive, threads};

#[derive(Debug, Args)]
pub struct SensitivityArguments {
    #[command(flatten)]
    pub input: Input,
    /// Parameters, separated by commas [default: all that are numbers].
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    pub by: Vec<String>,
    /// Random lives, whose mean is differentiated too.
    #[arg(long, value_name = "N", default_value_t = 0, allow_negative_numbers = true)]
    pub trajectories: u64,
    /// Seed of the random lives.
    #[arg(long, value_name = "N", default_value_t = 1, allow_negative_numbers = true)]
    pub seed: u64,
    /// Length of the steps of a turn [s] [default: as short as its wear needs].
    #[arg(long, value_name = "S", value_parser = positive, allow_negative_numbers = true)]
    pub step: Option<f64>,
    /// Clearances at which turns are run, from that of the unworn mechanism to that of the failed one.
    #[arg(long, value_name = "N", default_value_t = 9, value_parser = clap::value_parser!(u16).range(3..=257))]
    pub points: u16,
    /// Threads [default: one per core].
    #[arg(long, value_name = "N", value_parser = threads)]
    pub threads: Option<NonZero<usize>>,
}
