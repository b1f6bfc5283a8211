//! A fit as its file has it. In: a fit and the names of its data, or the text of a file. Out: JSON, an estimate at given
//! covariates, or what is wrong with the file, where, and what to do. Never knows how parameters are estimated, nor paths.

mod at_covariates;
mod columns;
mod definition;
mod error;
mod once;
mod reader;

pub use definition::{Covariate, FitFile};
pub use error::FitFileError;

#[cfg(test)]
mod tests;
