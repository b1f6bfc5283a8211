//! The laws of one contact, together.

use super::friction::Friction;
use super::normal::Normal;

/// The laws of one contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Laws {
    /// Normal force.
    pub normal: Normal,
    /// Friction.
    pub friction: Friction,
}
