//! The laws of one contact, together, and what they give.

use super::friction::Friction;
use super::normal::{Normal, NormalForce};

/// The laws of one contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Laws {
    /// Normal force.
    pub normal: Normal,
    /// Friction.
    pub friction: Friction,
}

/// Forces of a contact at one instant and where their power goes; components in the frame of the bearing or socket.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactForce<T> {
    /// Normal force with its energies.
    pub normal: NormalForce<T>,
    /// Force on the journal or ball, at its centre [N].
    pub force: [T; 3],
    /// Moment on the journal or ball about its centre [N m].
    pub moment: [T; 3],
    /// Power lost in friction [W].
    pub friction_loss: T,
}
