//! Processes by which wear grows: independent increments whose law depends on the exposure dLambda alone. In: logarithms
//! of two positive parameters, exposure, wear. Out: densities with derivatives, draws, first passages. Never knows data
//! sets, priors, clocks.
//!
//! A process is a file of this folder and its entry in [`PROCESSES`]; estimation, prediction and the command line find it
//! there.

mod definition;
mod gamma;
mod inverse_gaussian;
mod random_effect;
mod reference;
mod wiener;

pub(crate) use definition::scatters;
pub use definition::{Process, Slice, Term};
pub use gamma::Gamma;
pub use inverse_gaussian::InverseGaussian;
pub use random_effect::{RandomEffect, RandomLaw};
pub(crate) use reference::{Reference, sheared};
pub use wiener::Wiener;

/// All processes that can be fitted and predicted from; the first is the default.
pub static PROCESSES: [&dyn Process; 3] = [&Gamma, &Wiener, &InverseGaussian];

/// The process of this name; see [`Process::name`].
pub fn named(name: &str) -> Option<&'static dyn Process> {
    PROCESSES.into_iter().find(|process| process.name() == name)
}

#[cfg(test)]
mod tests;
