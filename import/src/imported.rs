//! What an import makes. Never knows of what.

/// A mechanism file made from another format.
#[derive(Clone, Debug, PartialEq)]
pub struct Imported {
    /// Name of the mechanism.
    pub name: String,
    /// The mechanism file (TOML).
    pub text: String,
    /// Its bodies.
    pub bodies: usize,
    /// Its joints.
    pub joints: usize,
    /// What was not carried over, or was changed on the way; a sentence each.
    pub left_out: Vec<String>,
}
