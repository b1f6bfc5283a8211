//! What can be asked of a study: the definitions that clap reads. Never knows who answers.

use std::num::NonZero;
use std::path::PathBuf;

use clap::Args;

use super::super::options::{EquationsChoice, Input, LivesArguments, MotionArguments, Replace, rows_help};
use super::super::value::{axis, sample, threads};
use crate::shard::Shard;
use crate::study::Axis;

#[derive(Debug, Args)]
pub struct StudyArguments {
    #[command(flatten)]
    pub input: Input,
    /// A parameter and its values: N from A to B, or a list; units as in the file. Repeatable: every value of each with every value
    /// of the others, the last one varying fastest.
    #[arg(long, value_name = "NAME=A..B:N|NAME=a,b,c", value_parser = axis, required = true)]
    pub vary: Vec<Axis>,
    /// Instead of the grid N points that fill the ranges NAME=A..B evenly: a Sobol sequence scrambled by --seed.
    #[arg(long, value_name = "sobol:N", value_parser = sample)]
    pub sample: Option<u64>,
    /// Results, separated by commas: life.mean, life.p10, peak.R1.F, peak.R1.drive, R1.wear_integral_J, max.R4.q, steps, ..; a
    /// wrong one is answered with those that there are.
    #[arg(long, value_name = "LIST", value_delimiter = ',', required = true)]
    pub of: Vec<String>,
    #[arg(long, value_name = "FILE", help = rows_help())]
    pub out: Option<PathBuf>,
    /// Go on with the study that was interrupted, by the journal beside --out, to the same bytes as if it had not been.
    #[arg(long, requires = "out")]
    pub resume: bool,
    /// Run the I-th of N nearly equal parts of the points, I from 1, on a machine of its own; --out is then a part, and `merge` puts
    /// the parts together.
    #[arg(long, value_name = "I/N", requires = "out")]
    pub shard: Option<Shard>,
    /// Threads that share the points [default: one per core].
    #[arg(long, value_name = "T", value_parser = threads)]
    pub threads: Option<NonZero<usize>>,
    #[command(flatten)]
    pub motion: MotionArguments,
    #[command(flatten)]
    pub lives: LivesArguments,
    #[command(flatten)]
    pub equations: EquationsChoice,
    #[command(flatten)]
    pub replace: Replace,
}
