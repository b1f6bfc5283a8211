//! linkwear compiles a linkage into its life: a TOML file describes a mechanism, a generator derives
//! its equations and writes specialised Rust, a runtime integrates it.
//!
//! This package is the façade: the generator as [`codegen`], the runtime as [`runtime`], the shipped
//! mechanisms compiled in as [`mechanisms`], and, by features that are on by default, the command line (`cli`) and
//! the case study of the paper (`case-study`).
//! A program with a mechanism of its own needs only `linkwear-codegen` as build-dependency and
//! `linkwear-runtime` as dependency; see the README, "Embedding".

#[cfg(feature = "case-study")]
pub mod case_study;
pub mod mechanisms;
#[cfg(feature = "case-study")]
mod plot;

pub use linkwear_codegen as codegen;
pub use linkwear_runtime as runtime;
