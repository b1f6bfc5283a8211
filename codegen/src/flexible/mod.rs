//! Constants of one flexible body in its floating frame, computed once, in numbers.
//!
//! In: a beam (sections, steps, concentrated masses, how it is held) or a modal data file. Out: [`ModalData`],
//! every number the equations of motion need. SI units throughout.
//! Must never know mechanisms, TOML of mechanisms, expressions, ids: it is plain `f64` numerics.
//!
//! A beam runs through `beam` (checked input) -> `mesh` (elements of `element` in a `line`) -> `shapes` (by `eigen`) ->
//! `motion` (sections in all modes) -> `integrals` -> `solved`. Modal data files run through `file` and `check`. Of either,
//! `basis` and `reduced` find what the equations of motion can do without.

pub mod data;

mod basis;
mod beam;
mod check;
mod eigen;
mod element;
mod equal;
mod error;
mod exact;
mod file;
mod integrals;
mod legendre;
mod line;
mod mesh;
mod motion;
mod natural;
mod one_body;
mod reduced;
mod section;
mod shapes;
mod solved;

pub use basis::Basis;
pub use beam::{Attachment, BeamInput, ConcentratedMass, Counts, Hold, MODE_LIMIT, Segment, Theory};
pub use check::DataError;
pub use data::{ModalData, Mode, Node, Outline, SecondOrder, Strain};
pub use error::BeamError;
pub use file::FileError;
pub use reduced::Reduced;
pub use section::{Material, Properties, Section};
pub use shapes::Truncated;
pub use solved::{Beam, Resolution};

#[cfg(test)]
pub(crate) mod cloud;
#[cfg(test)]
mod tests;
