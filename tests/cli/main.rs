//! The command line, by running the program: one file for each subcommand or what several have in common.
//!
//! One program of tests: two dozen took as many links, and each waited for its slowest test alone.

#[path = "../command/mod.rs"]
mod command;
#[path = "../truth/mod.rs"]
mod truth;

mod c;
#[cfg(unix)]
mod data;
mod diff;
mod explain;
mod fit;
mod fit_errors;
mod identify;
mod import;
mod include;
mod life;
mod life_bins;
mod life_errors;
mod life_missions;
#[cfg(feature = "page")]
mod life_report;
mod life_resume;
mod life_shards;
mod mechanism;
mod new;
#[cfg(unix)]
mod out;
mod plan;
mod predict;
mod predict_questions;
mod simulate;
mod study;
mod units;
mod usage;
