//! Contact laws of joints with clearance: stiffness, normal force, friction, and their sum on a journal in
//! its bearing (revolute), a ball in its socket (spherical) or a rod in its bush (guide).
//! In: relative position and motion of the two centres, clearance, material. Out: forces on the journal or
//! ball, sliding speed, and where the power goes. Never knows mechanisms, states or integrators.
//!
//! Laws are generic over [`crate::Scalar`] and choose by `select` alone, so that trajectories can run side by side in
//! lanes. What is decided once, before a run (which law, which exponent), is an ordinary `match`.
//!
//! Signs, checked against energy: `offset` is journal centre MINUS bearing centre, the normal points from
//! the bearing's centre to the contact, and the forces act ON the journal. The bearing gets their
//! opposite at the same point. Components are in the bearing's frame.

#[cfg(feature = "std")]
mod course;
mod friction;
mod guide;
mod laws;
mod memory;
mod normal;
mod range;
mod restitution;
mod revolute;
mod spherical;
mod stiffness;

#[cfg(feature = "std")]
pub(crate) use course::Course;
pub use friction::{Friction, Onset, Strength};
pub use guide::{GuideContact, GuideMotion};
pub use laws::{ContactForce, Laws};
pub use memory::{ImpactMemory, crossing_speed};
pub use normal::{IMPACT_SPEED_FLOOR, Normal, NormalForce};
pub use range::OutOfRange;
#[cfg(feature = "std")]
pub(crate) use range::checked;
pub(crate) use range::{not_negative, positive};
pub use restitution::Restitution;
pub use revolute::{RevoluteContact, RevoluteMotion, Support, bearing_angle};
pub use spherical::{SphericalContact, SphericalMotion};
pub use stiffness::{Stiffness, effective_radius, equivalent_modulus};
