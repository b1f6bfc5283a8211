//! Constants of one flexible body in its floating frame, computed once, in numbers.
//!
//! In: a beam (sections, steps, concentrated masses, how it is held) or a modal data file. Out: [`ModalData`],
//! every number the equations of motion need. SI units throughout.
//! Must never know mechanisms, TOML of mechanisms, expressions, ids: it is plain `f64` numerics.

pub mod data;

pub use data::{ModalData, Mode, Node, Outline, SecondOrder, Strain};
