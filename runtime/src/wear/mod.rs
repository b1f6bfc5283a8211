//! Archard wear of a contact and what it does to the clearance.
//! In: normal force, sliding speed, penetration, geometry, material. Out: rates to integrate with the state, depth by bearing
//! angle, the next clearance, warnings. Never knows mechanisms, integrators or random numbers.
//!
//! Two models of feedback that are not mixed silently: one number (`feedback`), or a depth per angle
//! (`profile`).

mod archard;
mod area;
mod coefficient;
mod feedback;
mod limits;
#[cfg(feature = "std")]
mod measure;
#[cfg(feature = "std")]
mod profile;
#[cfg(feature = "std")]
mod reach;
#[cfg(feature = "std")]
mod surfaces;
#[cfg(feature = "std")]
mod wear_in;

pub use archard::{Archard, WearRates};
pub use area::{Area, Load, Pair};
pub use coefficient::{MOST_LIVE, MOST_STEPS, Step, factor, is_sound};
pub use feedback::{Measure, ScalarFeedback};
pub use limits::{Extremes, Limits, Observed, Warning};
#[cfg(feature = "std")]
pub use measure::ContactMeasure;
#[cfg(feature = "std")]
pub use profile::{DEFAULT_BINS, Profile, ProfileError};
#[cfg(feature = "std")]
pub use reach::Grid;
#[cfg(feature = "std")]
pub use surfaces::{Extent, Surfaces};
