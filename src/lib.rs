//! linkwear compiles a linkage into its life: a TOML file describes a mechanism, a generator derives
//! its equations and writes specialised Rust, a runtime integrates it.
//!
//! This package is the façade: the generator as [`codegen`], the runtime as [`runtime`], machine code at run time as
//! [`native`], the shipped mechanisms compiled in as [`mechanisms`], and, by features that are on by default, the command line (`cli`) and units of FMI (`fmu`).
//! A program with a mechanism of its own needs only `linkwear-codegen` as build-dependency and
//! `linkwear-runtime` as dependency; see the README, "Embedding".

// Stderr that cannot be written ends no program: `remark::remark`.
#![cfg_attr(not(test), warn(clippy::print_stderr))]
#![deny(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::todo,
    clippy::unimplemented,
    clippy::unreachable
)]

pub mod backend;
pub mod batch;
mod checksum;
#[cfg(feature = "cli")]
pub mod cli;
pub mod cost;
#[cfg(feature = "cli")]
pub mod csv_table;
pub mod files;
#[cfg(feature = "fmu")]
pub mod fmu;
pub mod identify;
#[cfg(feature = "cli")]
pub mod inputs;
pub mod journal;
pub mod life;
pub mod mechanism;
pub mod number;
#[cfg(feature = "page")]
mod page;
mod parts;
#[cfg(feature = "cli")]
pub mod progress;
pub mod provenance;
#[cfg(feature = "cli")]
mod remark;
pub mod sensitivity;
pub mod shard;
pub mod study;
pub mod table;
pub mod wear_measure;

pub use linkwear_codegen as codegen;
#[cfg(feature = "cli")]
pub use linkwear_import as import;
pub use linkwear_native as native;
pub use linkwear_runtime as runtime;
pub use linkwear_shipped as mechanisms;
