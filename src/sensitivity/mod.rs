//! How wear and life vary with the parameters of a mechanism: derivatives by tangents through the motion, the wear law and the
//! draws. In: a file. Out: [`SensitivityResult`]. Never knows terminals.

mod chosen;
mod closing;
mod doubts;
mod error;
mod function;
mod measured;
mod neighbours;
mod paths;
mod random;
mod result;
mod roots;
mod settled;
mod stages;
mod study;
mod tangents;
mod turn;
mod varied;
mod wide;
mod worn;

pub use error::SensitivityError;
pub use result::{Derived, JointSensitivity, LeftOut, LifeSensitivity, RandomSensitivity, SensitivityResult};
pub use study::SensitivityStudy;
pub use varied::Varying;
