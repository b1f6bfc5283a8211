//! Joints with clearance of one mechanism: from what generated code says about their motion to the wrenches it
//! wants back. In: the answer of [`crate::Entry::Contacts`], constants of the joints. Out: wrenches, powers, what a
//! contact remembers. Never knows equations of motion, integrators or files.
//!
//! All branches of the laws live in [`crate::contact`] and [`crate::wear`]; here they are only fed.

mod channels;
mod joint;
mod joints;

pub use crate::joint_laws::{JointLaws, Response};
pub(crate) use channels::Channels;
pub use channels::{channels, contact_columns};
pub use joint::{Clearance, ContactState};
pub use joints::{ClearanceState, Clearances};
