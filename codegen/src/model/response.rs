//! What only the solution of an instant tells: accelerations, and forces of joints.
//! Out: [`Response`]. Never knows how it is solved for.

use crate::id::{BodyId, JointId, PointId};

/// A value that the forces of the same instant decide.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Response {
    /// Second derivative of a joint coordinate [rad/s² or m/s²].
    JointAcceleration(JointId, usize),
    /// Component (0, 1, 2) of a point's acceleration in W [m/s²].
    PointAcceleration(PointId, usize),
    /// Component of a body's angular acceleration in W [rad/s²].
    BodyAcceleration(BodyId, usize),
    /// Component in W of the force of the parent on the child in a joint, as its column says [N].
    JointForce(JointId, usize),
    /// Component in W of the moment of the parent on the child about the joint's point [N m].
    JointMoment(JointId, usize),
    /// Force of the drive of a joint coordinate [N m or N].
    Drive(JointId, usize),
}

impl Response {
    /// The joint whose coordinate it is of.
    pub const fn coordinate_of(self) -> Option<JointId> {
        match self {
            Self::JointAcceleration(joint, _) => Some(joint),
            _ => None,
        }
    }
}
