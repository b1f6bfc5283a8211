//! What a contact does to a journal, as it is handed in from outside. Never knows laws of contact.

use crate::expr::Vec3;
use crate::id::JointId;

/// A wrench on a journal, handed in: force and moment about its centre, in the bearing's frame.
#[derive(Clone, Copy, Debug)]
pub struct ContactWrench<'g> {
    /// The joint.
    pub joint: JointId,
    /// How far along the joint's axis [m].
    pub along: f64,
    /// [N].
    pub force: Vec3<'g>,
    /// [N m].
    pub moment: Vec3<'g>,
}
